#include "engine/scene/object.h"

namespace cyanometer {

namespace {

/// The suffix of a name is its unit.
std::string unit_of(const std::string& name) {
  static const std::vector<std::pair<std::string, std::string>> suffixes{
      {"_per_km", "1/km"}, {"_km", "km"}, {"_deg", "deg"}, {"_nm", "nm"}, {"_um", "um"},
      {"_pa", "Pa"},       {"_k", "K"},   {"_ms", "ms"},   {"_ev", "EV"}};
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

void refuse_unknown(const Json& object, const std::vector<std::string>& known, const At& at) {
  for (const auto& [name, value] : object.items())
    if (std::ranges::find(known, name) == known.end())
      throw SceneError(pointer_to(at.pointer, name), quote(value), in_words(known),
                       pointer_to(at.pointer, name) + " is not known; the members here are " +
                           in_words(known, " and ") + ".");
}

bool is_plain_name(std::string_view name, std::size_t longest) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  return !name.empty() && name.size() <= longest && is_letter(name.front()) &&
         std::ranges::all_of(
             name, [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

std::string plain_name_pattern(std::size_t longest) {
  return "^[a-z][a-z0-9_]{0," + std::to_string(longest - 1) + "}$";
}

std::vector<std::string> Alternatives::given(const Json& object) const {
  std::vector<std::string> names;
  for (const auto& group : groups)
    for (const auto& name : group)
      if (given_member(object, name) && std::ranges::find(names, name) == names.end())
        names.push_back(name);
  return names;
}

std::vector<std::size_t> Alternatives::fitting(const Json& object) const {
  const auto names = given(object);
  std::vector<std::size_t> fitting;
  for (std::size_t i = 0; i < groups.size(); ++i)
    if (std::ranges::all_of(names, [&](const auto& name) {
          return std::ranges::find(groups[i], name) != groups[i].end();
        }))
      fitting.push_back(i);
  return fitting;
}

bool Alternatives::any_given(const Json& object) const { return !given(object).empty(); }

void Alternatives::check(const Json& object, const At& at) const {
  if (!fitting(object).empty()) return;
  const auto names = given(object);
  throw SceneError(
      pointer_to(at.pointer, names.back()), quote(object[names.back()]), "one form alone",
      pointer_to(at.pointer, names.back()) + " is one of several alternative forms (" +
          in_words(names, " and ") + " are given); give one form alone.");
}

void Alternatives::drop_inherited(Json& inherited, const Json& patch) const {
  const auto kept = fitting(patch);
  for (const auto& group : groups)
    for (const auto& name : group)
      if (std::ranges::none_of(kept, [&](std::size_t i) {
            return std::ranges::find(groups[i], name) != groups[i].end();
          }))
        inherited.erase(name);
}

void Alternatives::describe(Json& schema) const { schema["x-alternatives"].push_back(groups); }

}  // namespace cyanometer
