// JSON objects as lists of entries: members, alternative forms, rules. A member is one line,
// and reading, writing, merging and the schema follow from it. Internal to engine/scene.
#pragma once

#include <algorithm>
#include <map>
#include <type_traits>

#include "engine/scene/spelling.h"

namespace cyanometer {

/// What an object with the value Owner is made of. Entries are read in their order.
template <class Owner>
class Entry {
 public:
  virtual ~Entry() = default;
  virtual std::vector<std::string> names() const { return {}; }
  virtual void read(Owner& owner, const Json& object, const At& at) const = 0;
  virtual void write(const Owner& /*owner*/, Json& /*object*/) const {}
  virtual void describe(Json& /*schema*/, const Surroundings&) const {}
  virtual void merge(Json& /*inherited*/, const Json& /*patch*/) const {}
  /// Whether what the object has of these members is meant for this entry.
  virtual bool takes(const Json& /*object*/) const { return true; }
};

/// How a page's slider for a number may look. A step of a logarithmic one is in powers of ten.
struct Slider {
  double minimum, maximum, step;
  bool logarithmic = false;
};

/// Everything about a member that is told to people; the unit follows from the name.
struct Label {
  std::string name, title, help, unit, group, default_words;
  std::optional<Slider> slider;
  bool required = false;

  Label(std::string name_, std::string title_, std::string help_);
  void add_to(Json& schema, const std::string& name_of_group) const;
};
void describe_member(Json& object_schema, const Label& label, Json schema,
                     const Surroundings& around);
/// The patch's member where it has one.
void replace_member(Json& inherited, const Json& patch, const std::string& name);
/// The same, merged with the one inherited where there is one.
void merge_member(Json& inherited, const Json& patch, const std::string& name,
                  const std::function<Json(const Json&, const Json&)>& merged);

template <class Owner, class T>
class Member final : public Entry<Owner> {
 public:
  Member(std::string name, T Owner::*field, Spelled<T> spelling, std::string title,
         std::string help)
      : label_(std::move(name), std::move(title), std::move(help)),
        field_(field),
        spelling_(std::move(spelling)) {}

  Member unit(std::string unit) && { return label_.unit = std::move(unit), std::move(*this); }
  Member group(std::string group) && {
    return label_.group = std::move(group), std::move(*this);
  }
  Member slider(double minimum, double maximum, double step) && {
    return label_.slider = Slider{minimum, maximum, step}, std::move(*this);
  }
  Member log_slider(double minimum, double maximum) && {
    return label_.slider = Slider{minimum, maximum, 0.01, true}, std::move(*this);
  }
  Member required() && { return label_.required = true, std::move(*this); }

  /// The default where it is not that of Owner{} but follows from what has been read.
  using Otherwise = std::function<T(const Owner&, const Reading&)>;
  Member otherwise(std::string words, Otherwise value) && {
    label_.default_words = std::move(words);
    otherwise_ = std::move(value);
    return std::move(*this);
  }
  using Condition = std::function<bool(const Owner&)>;
  /// Validated, then ignored where the condition does not hold.
  Member idle_unless(Condition used) && { return used_ = std::move(used), std::move(*this); }
  /// Only its default is allowed where the condition does not hold.
  Member refused_unless(Condition used, std::string reason) && {
    refusal_ = std::move(reason);
    return std::move(*this).idle_unless(std::move(used));
  }

  std::vector<std::string> names() const override { return {label_.name}; }

  void read(Owner& owner, const Json& object, const At& at) const override {
    const Json* given = given_member(object, label_.name);
    if (given)
      owner.*field_ = spelling_->read(*given, at / label_.name);
    else if (label_.required)
      refuse_missing(at / label_.name, spelling_->words());
    else if (otherwise_)
      owner.*field_ = otherwise_(owner, at.reading);
    if (used_ && !used_(owner)) set_idle(owner, given, at);
  }
  void write(const Owner& owner, Json& object) const override {
    if (used_ && !used_(owner)) return;
    Json value = spelling_->write(owner.*field_);
    if (!value.is_null()) object[label_.name] = std::move(value);
  }
  void describe(Json& schema, const Surroundings& around) const override {
    const std::string group = label_.group.empty() ? around.group : label_.group;
    Json own = spelling_->schema({group, around.whole});
    if (!label_.required && !otherwise_ && !own.contains("properties"))
      if (Json value = spelling_->write(Owner{}.*field_); !value.is_null())
        own["default"] = std::move(value);
    describe_member(schema, label_, std::move(own), around);
  }
  void merge(Json& inherited, const Json& patch) const override {
    merge_member(inherited, patch, label_.name, [this](const Json& base, const Json& over) {
      return spelling_->merged(base, over);
    });
  }
  bool takes(const Json& object) const override {
    const Json* given = given_member(object, label_.name);
    return !given || spelling_->takes(*given);
  }

 private:
  void set_idle(Owner& owner, const Json* given, const At& at) const {
    const T idle = Owner{}.*field_;
    if (!refusal_.empty() && given && !(owner.*field_ == idle))
      refuse(at / label_.name, *given, spelling_->write(idle).dump(), refusal_);
    owner.*field_ = idle;
  }

  Label label_;
  T Owner::*field_;
  Spelled<T> spelling_;
  Otherwise otherwise_;
  Condition used_;
  std::string refusal_;
};

/// A member that is read and acted upon, but is no part of the value: it is never written.
template <class Owner, class T>
class Consumed final : public Entry<Owner> {
 public:
  using Action = std::function<void(Owner&, const T&, const At&)>;
  Consumed(std::string name, Spelled<T> spelling, std::string title, std::string help,
           Action action = nullptr)
      : label_(std::move(name), std::move(title), std::move(help)),
        spelling_(std::move(spelling)),
        action_(std::move(action)) {}
  std::vector<std::string> names() const override { return {label_.name}; }
  void read(Owner& owner, const Json& object, const At& at) const override {
    const Json* given = given_member(object, label_.name);
    if (!given) return;
    const At here = at / label_.name;
    const T value = spelling_->read(*given, here);
    if (action_) action_(owner, value, here);
  }
  void describe(Json& schema, const Surroundings& around) const override {
    describe_member(schema, label_, spelling_->schema(around), around);
  }
  void merge(Json& inherited, const Json& patch) const override {
    merge_member(inherited, patch, label_.name, [this](const Json& base, const Json& over) {
      return spelling_->merged(base, over);
    });
  }

 private:
  Label label_;
  Spelled<T> spelling_;
  Action action_;
};

/// The whole value as one member: {"name": {...}}.
template <class T>
class Wrapped final : public Entry<T> {
 public:
  Wrapped(std::string name, Spelled<T> spelling, std::string title, std::string help)
      : label_(std::move(name), std::move(title), std::move(help)),
        spelling_(std::move(spelling)) {
    label_.required = true;
  }
  std::vector<std::string> names() const override { return {label_.name}; }
  void read(T& value, const Json& object, const At& at) const override {
    const Json* given = given_member(object, label_.name);
    if (!given) refuse_missing(at / label_.name, spelling_->words());
    value = spelling_->read(*given, at / label_.name);
  }
  void write(const T& value, Json& object) const override {
    object[label_.name] = spelling_->write(value);
  }
  void describe(Json& schema, const Surroundings& around) const override {
    describe_member(schema, label_, spelling_->schema({around.group, true}), around);
  }
  void merge(Json& inherited, const Json& patch) const override {
    replace_member(inherited, patch, label_.name);
  }
  bool takes(const Json& object) const override {
    const Json* given = given_member(object, label_.name);
    return given && spelling_->takes(*given);
  }

 private:
  Label label_;
  Spelled<T> spelling_;
};

/// A member that can have but one value.
template <class Owner>
class Constant final : public Entry<Owner> {
 public:
  Constant(std::string name, std::string value, std::string title, std::string help)
      : label_(std::move(name), std::move(title), std::move(help)), value_(std::move(value)) {}
  std::vector<std::string> names() const override { return {label_.name}; }
  void read(Owner&, const Json& object, const At& at) const override {
    if (const Json* given = given_member(object, label_.name))
      check_name(*given, {value_}, {}, at / label_.name);
  }
  void write(const Owner&, Json& object) const override { object[label_.name] = value_; }
  void describe(Json& schema, const Surroundings& around) const override {
    describe_member(schema, label_, {{"const", value_}}, around);
  }
  void merge(Json& inherited, const Json& patch) const override {
    replace_member(inherited, patch, label_.name);
  }

 private:
  Label label_;
  std::string value_;
};

/// A rule between members.
template <class Owner>
class Rule final : public Entry<Owner> {
 public:
  using Check = std::function<void(const Owner&, const At&)>;
  explicit Rule(Check check) : check_(std::move(check)) {}
  void read(Owner& owner, const Json&, const At& at) const override { check_(owner, at); }

 private:
  Check check_;
};

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
  Tagged(std::vector<Case<Owner>> cases, ObjectOf<Owner> common, std::vector<std::string> later)
      : cases_(std::move(cases)), common_(std::move(common)), later_(std::move(later)) {
    for (const auto& one : cases_) types_.push_back(one.name);
  }
  Owner read(const Json& given, const At& at) const override {
    if (!given.is_object()) refuse(at, given, words());
    const Json* type = given_member(given, "type");
    if (!type) refuse_missing(at / "type", names_in_words(types_));
    check_name(*type, types_, later_, at / "type");
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
  std::vector<std::string> types_, later_;
};
template <class Owner>
Spelled<Owner> tagged(std::vector<Case<Owner>> cases, ObjectOf<Owner> common = object<Owner>(),
                      std::vector<std::string> later = {}) {
  return std::make_shared<Tagged<Owner>>(std::move(cases), std::move(common), std::move(later));
}

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
