#include "engine/scene/spelling.h"

#include <algorithm>
#include <cmath>

namespace cyanometer {
namespace {

class Number final : public Spelling<double> {
 public:
  Number(double minimum, double maximum) : minimum_(minimum), maximum_(maximum) {}
  double read(const Json& given, const At& at) const override {
    if (!given.is_number()) refuse(at, given, words());
    const double value = given.get<double>();
    if (!(value >= minimum_ && value <= maximum_)) refuse(at, given, words());
    return value + 0.0;  // -0 becomes 0
  }
  Json write(const double& value) const override { return canonical_number(value); }
  Json schema(const Surroundings&) const override {
    return {{"type", "number"},
            {"minimum", canonical_number(minimum_)},
            {"maximum", canonical_number(maximum_)}};
  }
  std::string words() const override { return "a number" + range_in_words(minimum_, maximum_); }
  bool takes(const Json& given) const override { return given.is_number(); }

 private:
  double minimum_, maximum_;
};

class Integer final : public Spelling<int> {
 public:
  Integer(int minimum, int maximum) : minimum_(minimum), maximum_(maximum) {}
  int read(const Json& given, const At& at) const override {
    if (!given.is_number()) refuse(at, given, words());
    const double value = given.get<double>();  // 64.0 and 1e3 are whole too
    if (!(value >= minimum_ && value <= maximum_ && value == std::trunc(value)))
      refuse(at, given, words());
    return static_cast<int>(value);
  }
  Json write(const int& value) const override { return value; }
  Json schema(const Surroundings&) const override {
    return {{"type", "integer"}, {"minimum", minimum_}, {"maximum", maximum_}};
  }
  std::string words() const override {
    return "a whole number" + range_in_words(minimum_, maximum_);
  }
  bool takes(const Json& given) const override { return given.is_number(); }

 private:
  int minimum_, maximum_;
};

class Boolean final : public Spelling<bool> {
 public:
  bool read(const Json& given, const At& at) const override {
    if (!given.is_boolean()) refuse(at, given, words());
    return given.get<bool>();
  }
  Json write(const bool& value) const override { return value; }
  Json schema(const Surroundings&) const override { return {{"type", "boolean"}}; }
  std::string words() const override { return "true or false"; }
  bool takes(const Json& given) const override { return given.is_boolean(); }
};

class Text final : public Spelling<std::string> {
 public:
  explicit Text(std::string what) : what_(std::move(what)) {}
  std::string read(const Json& given, const At& at) const override {
    if (!given.is_string()) refuse(at, given, words());
    return given.get<std::string>();
  }
  Json write(const std::string& value) const override { return value; }
  Json schema(const Surroundings&) const override { return {{"type", "string"}}; }
  std::string words() const override { return what_; }
  bool takes(const Json& given) const override { return given.is_string(); }

 private:
  std::string what_;
};

class Name final : public Spelling<std::string> {
 public:
  explicit Name(std::vector<std::string> names) : names_(std::move(names)) {}
  std::string read(const Json& given, const At& at) const override {
    check_name(given, names_, at);
    return given.get<std::string>();
  }
  Json write(const std::string& value) const override { return value; }
  Json schema(const Surroundings&) const override {
    return {{"type", "string"}, {"enum", names_}};
  }
  std::string words() const override { return names_in_words(names_); }
  bool takes(const Json& given) const override { return given.is_string(); }

 private:
  std::vector<std::string> names_;
};

class List final : public Spelling<std::vector<double>> {
 public:
  List(Spelled<double> element, std::size_t shortest, std::size_t longest, Order order)
      : element_(std::move(element)), shortest_(shortest), longest_(longest), order_(order) {}

  std::vector<double> read(const Json& given, const At& at) const override {
    if (!given.is_array() || given.size() < shortest_ || given.size() > longest_)
      refuse(at, given, words());
    std::vector<double> values;
    for (std::size_t i = 0; i < given.size(); ++i)
      values.push_back(element_->read(given[i], at / i));
    check_order(values, given, at);
    return values;
  }
  Json write(const std::vector<double>& values) const override {
    Json result = Json::array();
    for (const double value : values) result.push_back(element_->write(value));
    return result;
  }
  Json schema(const Surroundings& around) const override {
    Json schema{{"type", "array"},
                {"items", element_->schema(around)},
                {"minItems", shortest_},
                {"maxItems", longest_}};
    if (order_ != Order::any) schema["x-order"] = order_in_words();
    return schema;
  }
  std::string words() const override {
    return "a list of " + std::to_string(shortest_) + " to " + std::to_string(longest_) +
           " numbers, each " + element_->words() +
           (order_ == Order::any ? "" : ", strictly " + order_in_words());
  }
  bool takes(const Json& given) const override { return given.is_array(); }

 private:
  std::string order_in_words() const {
    return order_ == Order::ascending ? "ascending" : "ascending or descending";
  }
  void check_order(const std::vector<double>& values, const Json& given, const At& at) const {
    const bool may_descend =
        order_ == Order::monotonic && values.size() > 1 && values[1] < values[0];
    for (std::size_t i = 1; order_ != Order::any && i < values.size(); ++i)
      if (may_descend ? values[i] >= values[i - 1] : values[i] <= values[i - 1])
        refuse(at / i, given[i],
               (may_descend ? "less" : "greater") + std::string(" than the one before it"),
               "the list is strictly " + order_in_words());
  }

  Spelled<double> element_;
  std::size_t shortest_, longest_;
  Order order_;
};

class Pair final : public Spelling<std::array<double, 2>> {
 public:
  Pair(Spelled<double> first, Spelled<double> second)
      : elements_{std::move(first), std::move(second)} {}
  std::array<double, 2> read(const Json& given, const At& at) const override {
    if (!given.is_array() || given.size() != 2) refuse(at, given, words());
    return {elements_[0]->read(given[0], at / std::size_t{0}),
            elements_[1]->read(given[1], at / std::size_t{1})};
  }
  Json write(const std::array<double, 2>& value) const override {
    return Json::array({elements_[0]->write(value[0]), elements_[1]->write(value[1])});
  }
  Json schema(const Surroundings& around) const override {
    return {{"type", "array"},
            {"prefixItems", {elements_[0]->schema(around), elements_[1]->schema(around)}},
            {"minItems", 2},
            {"maxItems", 2}};
  }
  std::string words() const override {
    return "a pair of " + elements_[0]->words() + " and " + elements_[1]->words();
  }
  bool takes(const Json& given) const override { return given.is_array(); }

 private:
  std::array<Spelled<double>, 2> elements_;
};

}  // namespace

Spelled<double> number(double minimum, double maximum) {
  return std::make_shared<Number>(minimum, maximum);
}
Spelled<int> integer(int minimum, int maximum) {
  return std::make_shared<Integer>(minimum, maximum);
}
Spelled<bool> boolean() { return std::make_shared<Boolean>(); }
Spelled<std::string> text(std::string what) { return std::make_shared<Text>(std::move(what)); }
Spelled<std::string> one_name_of(std::vector<std::string> names) {
  return std::make_shared<Name>(std::move(names));
}
Spelled<std::vector<double>> list(Spelled<double> element, std::size_t shortest,
                                  std::size_t longest, Order order) {
  return std::make_shared<List>(std::move(element), shortest, longest, order);
}
Spelled<std::array<double, 2>> pair(Spelled<double> first, Spelled<double> second) {
  return std::make_shared<Pair>(std::move(first), std::move(second));
}

std::string names_in_words(const std::vector<std::string>& names) {
  std::vector<std::string> quoted;
  for (const std::string& name : names) quoted.push_back('"' + name + '"');
  return in_words(quoted);
}

void check_name(const Json& given, const std::vector<std::string>& names, const At& at) {
  const auto is_given = [&](const std::string& name) { return given == name; };
  if (!std::ranges::any_of(names, is_given)) refuse(at, given, names_in_words(names));
}

void add_alternative(Json& schema, const Json& alternative) {
  if (!schema.contains("anyOf")) {
    Json first = Json::object();
    for (const char* word : {"type", "const", "enum", "minimum", "maximum", "properties",
                             "items", "additionalProperties", "required"})
      if (schema.contains(word)) {
        first[word] = schema[word];
        schema.erase(word);
      }
    schema["anyOf"] = Json::array({first});
  }
  if (alternative.contains("anyOf"))
    for (const Json& one : alternative["anyOf"]) schema["anyOf"].push_back(one);
  else
    schema["anyOf"].push_back(alternative);
}

}  // namespace cyanometer
