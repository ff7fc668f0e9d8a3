#include "engine/scene/object.h"

namespace cyanometer {

void refuse_unknown(const Json& object, const std::vector<std::string>& known, const At& at) {
  for (const auto& [name, value] : object.items())
    if (std::ranges::find(known, name) == known.end())
      throw SceneError(pointer_to(at.pointer, name), quote(value), in_words(known),
                       pointer_to(at.pointer, name) + " is not known; the members here are " +
                           in_words(known, " and ") + ".");
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
