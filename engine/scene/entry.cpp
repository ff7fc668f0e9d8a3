#include "engine/scene/entry.h"

namespace cyanometer {
namespace {

/// The suffix of a name is its unit.
std::string unit_of(const std::string& name) {
  static const std::vector<std::pair<std::string, std::string>> suffixes{
      {"_per_km", "1/km"}, {"_km", "km"},       {"_deg", "deg"}, {"_nm", "nm"},
      {"_um", "um"},       {"_pa", "Pa"},       {"_k", "K"},     {"_ms", "ms"},
      {"_ev", "EV"},       {"_m_per_s", "m/s"}, {"_au", "au"}};
  for (const auto& [suffix, unit] : suffixes)
    if (name.ends_with(suffix)) return unit;
  return "";
}

}  // namespace

Label::Label(std::string name_, std::string title_, std::string help_)
    : name(std::move(name_)),
      title(std::move(title_)),
      help(std::move(help_)),
      unit(unit_of(name)) {}

void Label::add_to(Json& schema, const std::string& name_of_group) const {
  schema["title"] = title;
  schema["description"] = help;
  schema["x-group"] = name_of_group;
  if (!unit.empty()) schema["x-unit"] = unit;
  if (!default_words.empty()) schema["x-default"] = default_words;
  if (slider)
    schema["x-slider"] = {{"minimum", canonical_number(slider->minimum)},
                          {"maximum", canonical_number(slider->maximum)},
                          {"step", canonical_number(slider->step)},
                          {"scale", slider->logarithmic ? "log" : "linear"}};
}

void describe_member(Json& object_schema, const Label& label, Json schema,
                     const Surroundings& around) {
  label.add_to(schema, label.group.empty() ? around.group : label.group);
  object_schema["properties"][label.name] = std::move(schema);
  if (label.required && around.whole) object_schema["required"].push_back(label.name);
}

void replace_member(Json& inherited, const Json& patch, const std::string& name) {
  if (const auto over = patch.find(name); over != patch.end()) inherited[name] = *over;
}

void merge_member(Json& inherited, const Json& patch, const std::string& name,
                  const std::function<Json(const Json&, const Json&)>& merged) {
  const auto over = patch.find(name);
  if (over == patch.end()) return;
  const Json* base = given_member(inherited, name);
  inherited[name] = base ? merged(*base, *over) : *over;
}

}  // namespace cyanometer
