// What objects are made of: members, each one line from which reading, writing, merging and the
// schema follow, and rules between them. Internal to engine/scene.
#pragma once

#include <functional>
#include <memory>

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
      check_name(*given, {value_}, at / label_.name);
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

}  // namespace cyanometer
