// Objects whose members have names of the user's choice. Internal to engine/scene.
#pragma once

#include <map>

#include "engine/scene/entry.h"

namespace cyanometer {

/// Whether it is one to `longest` of a-z, 0-9 and _, beginning with a letter.
bool is_plain_name(std::string_view name, std::size_t longest);
/// The same as a regular expression.
std::string plain_name_pattern(std::size_t longest);

/// Values under names of the user's choice; null says that there is none of that name.
template <class T>
class NamedMap final : public Spelling<std::map<std::string, T>> {
 public:
  NamedMap(std::size_t longest_name, std::size_t most, Spelled<T> value)
      : longest_name_(longest_name), most_(most), value_(std::move(value)) {}

  std::map<std::string, T> read(const Json& given, const At& at) const override {
    if (!given.is_object()) refuse(at, given, words());
    std::map<std::string, T> values;
    for (const auto& [name, value] : given.items()) {
      if (!is_plain_name(name, longest_name_))
        refuse(at / name, name, "a name that matches " + plain_name_pattern(longest_name_));
      if (!value.is_null()) values.emplace(name, value_->read(value, at / name));
    }
    if (values.size() > most_) refuse(at, values.size(), "at most " + std::to_string(most_));
    return values;
  }
  Json write(const std::map<std::string, T>& values) const override {
    Json object = Json::object();
    for (const auto& [name, value] : values) object[name] = value_->write(value);
    return object;
  }
  Json schema(const Surroundings& around) const override {
    Json value = value_->schema(around);
    add_alternative(value, {{"type", "null"}});
    value.erase("type");
    return {{"type", "object"},
            {"patternProperties", {{plain_name_pattern(longest_name_), std::move(value)}}},
            {"additionalProperties", false},
            {"properties", Json::object()}};
  }
  std::string words() const override {
    return "an object of at most " + std::to_string(most_) + " members";
  }
  bool takes(const Json& given) const override { return given.is_object(); }
  Json merged(const Json& inherited, const Json& patch) const override {
    if (!inherited.is_object() || !patch.is_object()) return patch;
    Json result = inherited;
    for (const auto& [name, value] : patch.items())
      merge_member(result, patch, name, [this](const Json& base, const Json& over) {
        return value_->merged(base, over);
      });
    return result;
  }

 private:
  std::size_t longest_name_;
  std::size_t most_;
  Spelled<T> value_;
};
template <class T>
Spelled<std::map<std::string, T>> named_map(std::size_t longest_name, std::size_t most,
                                            Spelled<T> value) {
  return std::make_shared<NamedMap<T>>(longest_name, most, std::move(value));
}

}  // namespace cyanometer
