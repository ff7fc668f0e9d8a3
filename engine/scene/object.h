// JSON objects as lists of entries, and members that exclude each other. Internal to
// engine/scene.
#pragma once

#include <algorithm>

#include "engine/scene/entry.h"

namespace cyanometer {

/// Groups of members of which only one may be given; a name may be in several.
struct Alternatives {
  std::vector<std::vector<std::string>> groups;

  /// Those that have every one of these members that the object gives.
  std::vector<std::size_t> fitting(const Json& object) const;
  bool any_given(const Json& object) const;
  void check(const Json& object, const At& at) const;
  /// Giving one form drops the form that was inherited.
  void drop_inherited(Json& inherited, const Json& patch) const;
  void describe(Json& schema) const;

 private:
  std::vector<std::string> given(const Json& object) const;
};

template <class Owner>
class Exclusive final : public Entry<Owner> {
 public:
  explicit Exclusive(Alternatives alternatives) : alternatives_(std::move(alternatives)) {}
  void read(Owner&, const Json& object, const At& at) const override {
    alternatives_.check(object, at);
  }
  void describe(Json& schema, const Surroundings&) const override {
    alternatives_.describe(schema);
  }
  void merge(Json& inherited, const Json& patch) const override {
    alternatives_.drop_inherited(inherited, patch);
  }

 private:
  Alternatives alternatives_;
};

/// @throws SceneError where the object has a member that is not known
void refuse_unknown(const Json& object, const std::vector<std::string>& known, const At& at);

/// An object made of entries. It is an entry itself, where its members stand among others.
template <class T>
class Object final : public Spelling<T>, public Entry<T> {
 public:
  using Entries = std::vector<std::shared_ptr<const Entry<T>>>;
  explicit Object(Entries entries) : entries_(std::move(entries)) {}

  T read(const Json& given, const At& at) const override {
    T value{};
    read_whole(value, given, at);
    return value;
  }
  /// In place, so that an entry may see what was read before it.
  void read_whole(T& value, const Json& given, const At& at) const {
    if (!given.is_object()) refuse(at, given, words());
    refuse_unknown(given, names(), at);
    read(value, given, at);
  }
  Json write(const T& value) const override {
    Json object = Json::object();
    write(value, object);
    return object;
  }
  Json schema(const Surroundings& around) const override {
    Json schema{{"type", "object"}, {"properties", Json::object()}};
    schema["additionalProperties"] = false;
    describe(schema, around);
    return schema;
  }
  std::string words() const override {
    const auto known = names();
    return (known.size() == 1 ? "an object with the member " : "an object with the members ") +
           in_words(known);
  }
  bool takes(const Json& given) const override {
    if (!given.is_object()) return false;
    const auto known = names();
    return std::ranges::any_of(known, [&](const auto& name) { return given.contains(name); });
  }
  Json merged(const Json& inherited, const Json& patch) const override {
    if (!inherited.is_object() || !patch.is_object()) return patch;
    Json result = inherited;
    merge(result, patch);
    const auto known = names();
    for (const auto& [name, value] : patch.items())  // unknown ones too: reading refuses them
      if (std::ranges::find(known, name) == known.end()) result[name] = value;
    return result;
  }

  std::vector<std::string> names() const override {
    std::vector<std::string> all;
    for (const auto& entry : entries_)
      for (std::string& name : entry->names())
        if (std::ranges::find(all, name) == all.end()) all.push_back(std::move(name));
    return all;
  }
  void read(T& value, const Json& object, const At& at) const override {
    for (const auto& entry : entries_) entry->read(value, object, at);
  }
  void write(const T& value, Json& object) const override {
    for (const auto& entry : entries_) entry->write(value, object);
  }
  void describe(Json& schema, const Surroundings& around) const override {
    for (const auto& entry : entries_) entry->describe(schema, around);
  }
  void merge(Json& inherited, const Json& patch) const override {
    for (const auto& entry : entries_) entry->merge(inherited, patch);
  }
  bool takes_members(const Json& object) const {
    return std::ranges::all_of(entries_, [&](const auto& e) { return e->takes(object); });
  }

 private:
  Entries entries_;
};

template <class T>
using ObjectOf = std::shared_ptr<const Object<T>>;
template <class T, class... Es>
ObjectOf<T> object(Es... entries) {
  std::vector<std::shared_ptr<const Entry<T>>> list;
  (list.push_back(std::make_shared<const Es>(std::move(entries))), ...);
  return std::make_shared<Object<T>>(std::move(list));
}

}  // namespace cyanometer
