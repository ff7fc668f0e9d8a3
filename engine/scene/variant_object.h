// Objects that differ in their members: by their `type`, or by which alternative form is given.
// Internal to engine/scene.
#pragma once

#include "engine/scene/object.h"

namespace cyanometer {

/// One alternative of a variant within Owner: a type of a tagged object, or a form.
template <class Owner>
struct Case {
  std::string name, title, group;
  std::function<bool(const Owner&)> holds;
  std::function<bool(const Json&)> takes;
  std::shared_ptr<const Entry<Owner>> entry;
};

/// The members of an alternative T of the variant that `access` finds in Owner.
template <class Owner, class T, class Access>
class Lifted final : public Entry<Owner> {
 public:
  Lifted(Access access, ObjectOf<T> object) : access_(access), object_(std::move(object)) {}
  std::vector<std::string> names() const override { return object_->names(); }
  void read(Owner& owner, const Json& object, const At& at) const override {
    T value{};
    object_->read(value, object, at);
    std::invoke(access_, owner) = std::move(value);
  }
  void write(const Owner& owner, Json& object) const override {
    object_->write(std::get<T>(std::invoke(access_, owner)), object);
  }
  void describe(Json& schema, const Surroundings& around) const override {
    object_->describe(schema, around);
  }
  void merge(Json& inherited, const Json& patch) const override {
    object_->merge(inherited, patch);
  }

 private:
  Access access_;
  ObjectOf<T> object_;
};

/// Makes cases for the variant at `access` in Owner.
template <class Owner, class Access>
class Cases {
 public:
  explicit Cases(Access access) : access_(access) {}
  template <class T>
  Cases type(std::string name, std::string title, ObjectOf<T> object,
             std::string group = "") && {
    cases_.push_back({std::move(name), std::move(title), std::move(group),
                      [access = access_](const Owner& owner) {
                        return std::holds_alternative<T>(std::invoke(access, owner));
                      },
                      [object](const Json& given) { return object->takes_members(given); },
                      std::make_shared<Lifted<Owner, T, Access>>(access_, object)});
    return std::move(*this);
  }
  template <class T>
  Cases form(ObjectOf<T> object) && {
    return std::move(*this).template type<T>("", "", std::move(object));
  }
  operator std::vector<Case<Owner>>() && { return std::move(cases_); }

 private:
  Access access_;
  std::vector<Case<Owner>> cases_;
};
template <class Owner, class Access = std::identity>
Cases<Owner, Access> cases(Access access = {}) {
  return Cases<Owner, Access>(access);
}

/// Alternative forms whose members stand among the owner's other members.
template <class Owner>
class Forms final : public Entry<Owner> {
 public:
  explicit Forms(std::vector<Case<Owner>> cases, bool required = false)
      : cases_(std::move(cases)), required_(required) {
    for (const auto& one : cases_) alternatives_.groups.push_back(one.entry->names());
  }
  std::vector<std::string> names() const override {
    std::vector<std::string> all;
    for (const auto& group : alternatives_.groups)
      all.insert(all.end(), group.begin(), group.end());
    return all;
  }
  void read(Owner& owner, const Json& object, const At& at) const override {
    alternatives_.check(object, at);
    if (required_ && !alternatives_.any_given(object))
      refuse_missing(at / names().front(),
                     "given, or one of its alternatives " + in_words(names()));
    form_of(object).entry->read(owner, object, at);
  }
  void write(const Owner& owner, Json& object) const override {
    for (const auto& one : cases_)
      if (one.holds(owner)) one.entry->write(owner, object);
  }
  void describe(Json& schema, const Surroundings& around) const override {
    for (const auto& one : cases_) {
      Json form{{"properties", Json::object()}};
      one.entry->describe(form, around);
      for (const auto& [name, member] : form["properties"].items()) {
        Json& known = schema["properties"][name];
        if (known.is_null())
          known = member;
        else if (known != member)
          add_alternative(known, member);
      }
    }
    alternatives_.describe(schema);
  }
  void merge(Json& inherited, const Json& patch) const override {
    alternatives_.drop_inherited(inherited, patch);
    for (const auto& one : cases_) one.entry->merge(inherited, patch);
  }

 private:
  /// Of those that have the members given, the first whose spelling they are.
  const Case<Owner>& form_of(const Json& object) const {
    const auto fitting = alternatives_.fitting(object);
    for (const std::size_t i : fitting)
      if (cases_[i].takes(object)) return cases_[i];
    return cases_[fitting.front()];
  }

  std::vector<Case<Owner>> cases_;
  Alternatives alternatives_;
  bool required_;
};

/// An object whose `type` says which other members it has; all types have the `common` ones.
template <class Owner>
class Tagged final : public Spelling<Owner> {
 public:
  Tagged(std::vector<Case<Owner>> cases, ObjectOf<Owner> common)
      : cases_(std::move(cases)), common_(std::move(common)) {
    for (const auto& one : cases_) types_.push_back(one.name);
  }
  Owner read(const Json& given, const At& at) const override {
    if (!given.is_object()) refuse(at, given, words());
    const Json* type = given_member(given, "type");
    if (!type) refuse_missing(at / "type", names_in_words(types_));
    check_name(*type, types_, at / "type");
    const Case<Owner>& one = *find(*type);
    refuse_unknown(given, names_of(one), at);
    Owner value{};
    common_->read(value, given, at);
    one.entry->read(value, given, at);
    return value;
  }
  Json write(const Owner& value) const override {
    Json object = Json::object();
    for (const auto& one : cases_) {
      if (!one.holds(value)) continue;
      object["type"] = one.name;
      one.entry->write(value, object);
    }
    common_->write(value, object);
    return object;
  }
  Json schema(const Surroundings& around) const override {
    Json schema{{"type", "object"}, {"anyOf", Json::array()}};
    for (const auto& one : cases_) {
      const Surroundings within{one.group.empty() ? around.group : one.group, around.whole};
      Json type{{"const", one.name}, {"title", "Type"}, {"description", one.title + "."}};
      type["x-group"] = within.group;
      Json own{{"title", one.title}, {"type", "object"}, {"properties", {{"type", type}}}};
      own["additionalProperties"] = false;
      common_->describe(own, within);
      one.entry->describe(own, within);
      schema["anyOf"].push_back(std::move(own));
    }
    return schema;
  }
  std::string words() const override {
    return "an object whose type is " + names_in_words(types_);
  }
  bool takes(const Json& given) const override { return given.is_object(); }
  /// An object whose type changes is replaced whole.
  Json merged(const Json& inherited, const Json& patch) const override {
    if (!inherited.is_object() || !patch.is_object()) return patch;
    const Json* old_type = given_member(inherited, "type");
    const Json* new_type = given_member(patch, "type");
    if (new_type && (!old_type || *old_type != *new_type)) return patch;
    Json result = inherited;
    if (const Case<Owner>* one = old_type ? find(*old_type) : nullptr) {
      common_->merge(result, patch);
      one->entry->merge(result, patch);
      const auto known = names_of(*one);
      for (const auto& [name, value] : patch.items())
        if (std::ranges::find(known, name) == known.end()) result[name] = value;
      if (patch.contains("type")) result["type"] = patch["type"];
    } else {
      result.merge_patch(patch);
    }
    return result;
  }

 private:
  const Case<Owner>* find(const Json& type) const {
    const auto found =
        std::ranges::find_if(cases_, [&](const auto& one) { return type == one.name; });
    return found == cases_.end() ? nullptr : &*found;
  }
  std::vector<std::string> names_of(const Case<Owner>& one) const {
    std::vector<std::string> names{"type"};
    for (const auto& more : {common_->names(), one.entry->names()})
      names.insert(names.end(), more.begin(), more.end());
    return names;
  }

  std::vector<Case<Owner>> cases_;
  ObjectOf<Owner> common_;
  std::vector<std::string> types_;
};
template <class Owner>
Spelled<Owner> tagged(std::vector<Case<Owner>> cases,
                      ObjectOf<Owner> common = object<Owner>()) {
  return std::make_shared<Tagged<Owner>>(std::move(cases), std::move(common));
}

}  // namespace cyanometer
