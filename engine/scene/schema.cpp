#include "engine/scene/members.h"
#include "engine/scene/presets.h"

namespace cyanometer {

Json scene_schema() {
  Json schema = scene_members().schema({});
  std::vector<std::string> names, titles;
  for (const Preset& preset : presets()) {
    names.push_back(preset.name);
    titles.push_back(preset.title);
  }
  schema["properties"]["preset"] = {
      {"title", "Preset"},     {"description", "The named scene from which this one starts."},
      {"type", "string"},      {"enum", names},
      {"x-titles", titles},    {"x-group", "picture"},
      {"default", base_preset}};
  schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  schema["title"] = "Scene";
  schema["description"] =
      "A sky to be rendered. Every member is optional and merged over the preset; null "
      "restores a default, or removes a constituent. x-unit is the unit, x-group the group of "
      "controls, x-default the default where it follows from other members, x-alternatives "
      "lists groups of members of which only one may be given, and x-slider is a comfortable "
      "range: its step is in powers of ten where the scale is log, and for a spectrum it is "
      "that of a number and of a power law's value.";
  return schema;
}

}  // namespace cyanometer
