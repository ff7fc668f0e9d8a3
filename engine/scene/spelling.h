// How a value is spelled in JSON: one description from which it is read and validated, written
// canonically, described in the schema and merged. Internal to engine/scene.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "engine/scene/reading.h"

namespace cyanometer {

/// What a schema's part takes over from what is around it.
struct Surroundings {
  std::string group;   ///< of the page's controls
  bool whole = false;  ///< never merged with an inherited value: required members must be there
};

template <class T>
class Spelling {
 public:
  virtual ~Spelling() = default;

  /// @throws SceneError
  virtual T read(const Json& given, const At& at) const = 0;
  /// Null where there is nothing to write.
  virtual Json write(const T& value) const = 0;
  virtual Json schema(const Surroundings& around) const = 0;
  /// What is allowed, as in "a number from 0 to 1".
  virtual std::string words() const = 0;
  /// Whether the value given is meant to be of this kind, valid or not.
  virtual bool takes(const Json& given) const = 0;
  virtual Json merged(const Json& /*inherited*/, const Json& patch) const { return patch; }
};

template <class T>
using Spelled = std::shared_ptr<const Spelling<T>>;

Spelled<double> number(double minimum, double maximum);
Spelled<int> integer(int minimum, int maximum);
Spelled<bool> boolean();
Spelled<std::string> text(std::string what);
Spelled<std::string> one_name_of(std::vector<std::string> names);

enum class Order { any, ascending, monotonic };
Spelled<std::vector<double>> list(Spelled<double> element, std::size_t shortest,
                                  std::size_t longest, Order order = Order::any);
Spelled<std::array<double, 2>> pair(Spelled<double> first, Spelled<double> second);

/// Refuses unless the value is one of the names.
void check_name(const Json& given, const std::vector<std::string>& names, const At& at);
std::string names_in_words(const std::vector<std::string>& names);

template <class T>
class Optional final : public Spelling<std::optional<T>> {
 public:
  explicit Optional(Spelled<T> value) : value_(std::move(value)) {}
  std::optional<T> read(const Json& given, const At& at) const override {
    return value_->read(given, at);
  }
  Json write(const std::optional<T>& value) const override {
    return value ? value_->write(*value) : Json();
  }
  Json schema(const Surroundings& around) const override { return value_->schema(around); }
  std::string words() const override { return value_->words(); }
  bool takes(const Json& given) const override { return value_->takes(given); }

 private:
  Spelled<T> value_;
};
template <class T>
Spelled<std::optional<T>> optional(Spelled<T> value) {
  return std::make_shared<Optional<T>>(std::move(value));
}

/// A word that stands for the value T{}.
template <class T>
class Keyword final : public Spelling<T> {
 public:
  explicit Keyword(std::string word) : word_(std::move(word)) {}
  T read(const Json& given, const At& at) const override {
    if (given != word_) refuse(at, given, words());
    return T{};
  }
  Json write(const T&) const override { return word_; }
  Json schema(const Surroundings&) const override { return {{"const", word_}}; }
  std::string words() const override { return names_in_words({word_}); }
  bool takes(const Json& given) const override { return given == word_; }

 private:
  std::string word_;
};
template <class T>
Spelled<T> keyword(std::string word) {
  return std::make_shared<Keyword<T>>(std::move(word));
}

template <class E>
class Choice final : public Spelling<E> {
 public:
  explicit Choice(std::vector<std::pair<std::string, E>> choices)
      : choices_(std::move(choices)) {
    for (const auto& [name, value] : choices_) names_.push_back(name);
  }
  E read(const Json& given, const At& at) const override {
    check_name(given, names_, at);
    for (const auto& [name, value] : choices_)
      if (given == name) return value;
    throw std::logic_error("a name without a choice");
  }
  Json write(const E& value) const override {
    for (const auto& [name, named] : choices_)
      if (named == value) return name;
    throw std::logic_error("a choice without a name");
  }
  Json schema(const Surroundings&) const override {
    return {{"type", "string"}, {"enum", names_}};
  }
  std::string words() const override { return names_in_words(names_); }
  bool takes(const Json& given) const override { return given.is_string(); }

 private:
  std::vector<std::pair<std::string, E>> choices_;
  std::vector<std::string> names_;
};
template <class E>
Spelled<E> choice(std::vector<std::pair<std::string, E>> choices) {
  return std::make_shared<Choice<E>>(std::move(choices));
}

/// A struct of bools as the list of the names of those that are true.
template <class S>
class NameSet final : public Spelling<S> {
 public:
  using Flags = std::vector<std::pair<std::string, bool S::*>>;
  explicit NameSet(Flags flags) : flags_(std::move(flags)) {
    for (const auto& [name, flag] : flags_) names_.push_back(name);
  }
  S read(const Json& given, const At& at) const override {
    if (!given.is_array()) refuse(at, given, words());
    S set;
    for (const auto& [name, flag] : flags_) set.*flag = false;
    for (std::size_t i = 0; i < given.size(); ++i) {
      check_name(given[i], names_, at / i);
      for (const auto& [name, flag] : flags_) {
        if (given[i] != name) continue;
        if (set.*flag) refuse(at / i, given[i], "a name that is not in the list yet");
        set.*flag = true;
      }
    }
    return set;
  }
  Json write(const S& set) const override {
    Json result = Json::array();
    for (const auto& [name, flag] : flags_)
      if (set.*flag) result.push_back(name);
    return result;
  }
  Json schema(const Surroundings&) const override {
    return {{"type", "array"},
            {"uniqueItems", true},
            {"items", {{"type", "string"}, {"enum", names_}}}};
  }
  std::string words() const override { return "a list of any of " + names_in_words(names_); }
  bool takes(const Json& given) const override { return given.is_array(); }

 private:
  Flags flags_;
  std::vector<std::string> names_;
};
template <class S>
Spelled<S> name_set(typename NameSet<S>::Flags flags) {
  return std::make_shared<NameSet<S>>(std::move(flags));
}

/// Adds a way to spell a value to a schema that may have some already.
void add_alternative(Json& schema, const Json& alternative);

/// A variant, told apart by the JSON that spells it; the spellings are in the variant's order.
template <class Variant, class... Ts>
class OneOf final : public Spelling<Variant> {
 public:
  explicit OneOf(Spelled<Ts>... forms) : forms_(std::move(forms)...) {}

  Variant read(const Json& given, const At& at) const override {
    std::optional<Variant> value;
    each([&](const auto& form) {
      if (!value && form->takes(given)) value.emplace(form->read(given, at));
    });
    if (!value) refuse(at, given, words());
    return std::move(*value);
  }
  Json write(const Variant& value) const override {
    return write_at(value, std::index_sequence_for<Ts...>());
  }
  Json schema(const Surroundings& around) const override {
    Json schema{{"anyOf", Json::array()}};
    const Surroundings whole{around.group, true};
    each([&](const auto& form) { add_alternative(schema, form->schema(whole)); });
    return schema;
  }
  std::string words() const override {
    std::vector<std::string> items;
    each([&](const auto& form) { items.push_back(form->words()); });
    return in_words(items, ", or ");
  }
  bool takes(const Json& given) const override {
    bool any = false;
    each([&](const auto& form) { any = any || form->takes(given); });
    return any;
  }

 private:
  template <class F>
  void each(const F& f) const {
    std::apply([&](const auto&... form) { (f(form), ...); }, forms_);
  }
  template <std::size_t... I>
  Json write_at(const Variant& value, std::index_sequence<I...>) const {
    Json result;
    ((value.index() == I ? void(result = std::get<I>(forms_)->write(std::get<I>(value)))
                         : void()),
     ...);
    return result;
  }

  std::tuple<Spelled<Ts>...> forms_;
};
template <class Variant, class... Ts>
Spelled<Variant> one_of(Spelled<Ts>... forms) {
  return std::make_shared<OneOf<Variant, Ts...>>(std::move(forms)...);
}

/// A value, or the word that stands for T{} ("auto", "all").
template <class T>
class KeywordOr final : public Spelling<T> {
 public:
  KeywordOr(std::string word, Spelled<T> value)
      : keyword_(keyword<T>(std::move(word))), value_(std::move(value)) {}
  T read(const Json& given, const At& at) const override {
    if (keyword_->takes(given)) return T{};
    if (!value_->takes(given)) refuse(at, given, words());
    return value_->read(given, at);
  }
  Json write(const T& value) const override {
    return value == T{} ? keyword_->write(value) : value_->write(value);
  }
  Json schema(const Surroundings& around) const override {
    return {{"anyOf", {keyword_->schema(around), value_->schema(around)}}};
  }
  std::string words() const override { return keyword_->words() + " or " + value_->words(); }
  bool takes(const Json& given) const override {
    return keyword_->takes(given) || value_->takes(given);
  }

 private:
  Spelled<T> keyword_;
  Spelled<T> value_;
};
template <class T>
Spelled<T> keyword_or(std::string word, Spelled<T> value) {
  return std::make_shared<KeywordOr<T>>(std::move(word), std::move(value));
}

}  // namespace cyanometer
