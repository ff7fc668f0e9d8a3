// The method, how exact it should be, and the options that each method has.
#include <cmath>

#include "engine/engine.h"
#include "engine/scene/members.h"

namespace cyanometer {
namespace {

Spelled<std::string> method_name() {
  std::vector<std::string> there{"auto"};
  for (const MethodDescription& method : methods()) there.push_back(method.name);
  return one_name_of(there);
}

bool is_auto(const MethodChoice& method) { return method.name == "auto"; }

/// An option as the methods describe it. Several may have one of the same name.
class Option final : public Entry<MethodChoice> {
 public:
  explicit Option(std::string name) : name_(std::move(name)) {
    for (const MethodDescription& method : methods())
      for (const MethodOption& option : method.options)
        if (option.name == name_) of_method_.emplace_back(method.name, &option);
  }

  std::vector<std::string> names() const override { return {name_}; }

  void read(MethodChoice& choice, const Json& object, const At& at) const override {
    const auto chosen = std::ranges::find(of_method_, choice.name, &Of::first);
    const bool own = chosen != of_method_.end();
    const MethodOption& option = own ? *chosen->second : *of_method_.front().second;
    const Json* given = given_member(object, name_);
    const double value =
        given ? read_value(option, *given, at / std::string_view(name_)) : option.default_value;
    if (own) choice.options[name_] = value;
  }
  void write(const MethodChoice& choice, Json& object) const override {
    if (const auto found = choice.options.find(name_); found != choice.options.end())
      object[name_] = canonical_number(found->second);
  }
  void describe(Json& schema, const Surroundings& around) const override {
    Json own = described(*of_method_.front().second, around);
    for (const auto& [method, option] : of_method_) {
      own["minimum"] = std::min(own["minimum"], canonical_number(option->minimum));
      own["maximum"] = std::max(own["maximum"], canonical_number(option->maximum));
      own["x-methods"].push_back(method);
    }
    schema["properties"][name_] = std::move(own);
  }
  void merge(Json& inherited, const Json& patch) const override {
    replace_member(inherited, patch, name_);
  }

 private:
  using Of = std::pair<std::string, const MethodOption*>;

  static double read_value(const MethodOption& option, const Json& given, const At& at) {
    const std::string allowed = (option.integer ? "a whole number" : "a number") +
                                range_in_words(option.minimum, option.maximum);
    if (!given.is_number()) refuse(at, given, allowed);
    const double value = given.get<double>();
    if (!(value >= option.minimum && value <= option.maximum) ||
        (option.integer && value != std::trunc(value)))
      refuse(at, given, allowed);
    return value + 0.0;
  }
  static Json described(const MethodOption& option, const Surroundings& around) {
    Label label(option.name, option.title, option.description);
    label.unit = option.unit;
    label.slider = Slider{option.minimum, option.maximum, 1, option.logarithmic};
    if (option.logarithmic) {
      label.slider->minimum = std::max(option.minimum, 1e-6);
      label.slider->step = 0.01;
    }
    Json schema = number(option.minimum, option.maximum)->schema(around);
    if (option.integer) schema["type"] = "integer";
    schema["default"] = canonical_number(option.default_value);
    label.add_to(schema, around.group);
    return schema;
  }

  std::string name_;
  std::vector<Of> of_method_;  ///< never empty
};

ObjectOf<MethodChoice> options() {
  std::vector<std::string> names;
  Object<MethodChoice>::Entries entries;
  for (const MethodDescription& method : methods())
    for (const MethodOption& option : method.options)
      if (std::ranges::find(names, option.name) == names.end()) {
        names.push_back(option.name);
        entries.push_back(std::make_shared<Option>(option.name));
      }
  return std::make_shared<Object<MethodChoice>>(std::move(entries));
}

constexpr double usual_max_error = 0.02;

}  // namespace

ObjectOf<MethodChoice> method_members() {
  return object<MethodChoice>(
      Member("name", &MethodChoice::name, method_name(), "Method",
             "How the light is computed; auto takes the cheapest method that meets the error."),
      Member("max_ms", &MethodChoice::max_ms, optional(number(0.001, 1e7)), "Largest time",
             "For auto: a budget of device time.")
          .log_slider(1, 1e4)
          .idle_unless(is_auto),
      Member("max_error", &MethodChoice::max_error, optional(number(1e-6, 10)), "Largest error",
             "For auto: the largest error of the frame against the converged solution.")
          .otherwise(in_words(usual_max_error) + ", none where only max_ms is given",
                     [](const MethodChoice& choice, const Reading&) {
                       return choice.max_ms ? std::nullopt : std::optional(usual_max_error);
                     })
          .log_slider(1e-3, 1)
          .idle_unless(is_auto),
      Member("verify", &MethodChoice::verify, boolean(), "Verify",
             "Measure the error of this frame, and step up when it is missed."),
      Member("scattering_orders", &MethodChoice::scattering_orders,
             keyword_or("all", optional(integer(0, 1000))), "Scattering orders",
             "How many times light may have been scattered or reflected; 0 is the sun and the "
             "stars alone.")
          .slider(0, 20, 1),
      *options());
}

}  // namespace cyanometer
