// Seeded random scene documents, made from the schema alone, so that a new member is covered at
// once.
#pragma once

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

namespace cyanometer {

class RandomDocument {
 public:
  using Json = nlohmann::json;
  RandomDocument(Json schema, unsigned seed) : schema_(std::move(schema)), random_(seed) {}

  /// Mostly a valid document: rules between members are not in the schema.
  Json next() {
    wavelengths_ = chance(0.5) ? 0 : below(5) + 1;
    Json document = of(schema_);
    Json& spectrum = document["spectrum"];
    if (!spectrum.is_object()) spectrum = Json::object();
    spectrum.erase("wavelengths_nm");
    for (std::size_t i = 0; i < wavelengths_; ++i)
      spectrum["wavelengths_nm"].push_back(400 + 50 * static_cast<int>(i));
    return document;
  }

 private:
  bool chance(double p) { return std::bernoulli_distribution(p)(random_); }
  std::size_t below(std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_);
  }
  const Json& one_of(const Json& list) { return list[below(list.size())]; }

  Json of(const Json& schema) {
    if (schema.contains("const")) return schema["const"];
    if (schema.contains("enum")) return one_of(schema["enum"]);
    if (schema.contains("anyOf")) return of(alternative(schema["anyOf"]));
    const std::string type = schema["type"];
    if (type == "number" || type == "integer") return number(schema);
    if (type == "boolean") return chance(0.5);
    if (type == "array") return list(schema);
    if (type == "object") return object(schema);
    if (type == "null") return nullptr;
    if (schema.contains("pattern")) return "world.png";  // the only one
    return "2024-06-20T18:30:00+02:00";                  // the only free text is a time
  }
  const Json& alternative(const Json& alternatives) {
    const Json& one = one_of(alternatives);
    return is_per_wavelength(one) && wavelengths_ == 0 ? alternative(alternatives) : one;
  }
  static bool is_per_wavelength(const Json& schema) {
    return schema.value("title", "").starts_with("One for each");
  }

  Json number(const Json& schema) {
    const double low = schema["minimum"], high = schema["maximum"];
    double value = std::uniform_real_distribution(low, high)(random_);
    if (chance(0.1))
      value = low;
    else if (chance(0.1))
      value = high;
    else if (chance(0.6))
      value = std::clamp(std::pow(value / high, 3.0) * 10, low, high);
    if (schema["type"] == "integer") return static_cast<std::int64_t>(std::round(value));
    return value;
  }
  Json list(const Json& schema) {
    Json items = Json::array();
    if (schema.contains("prefixItems")) {
      for (const Json& item : schema["prefixItems"]) items.push_back(of(item));
    } else if (schema.contains("uniqueItems")) {
      for (const Json& name : schema["items"]["enum"])
        if (chance(0.5)) items.push_back(name);
    } else {
      const std::size_t size = is_per_wavelength(schema) ? wavelengths_ : 3;
      while (items.size() < size) items.push_back(of(schema["items"]));
      if (schema.contains("x-order")) std::sort(items.begin(), items.end());
    }
    return items;
  }
  Json object(const Json& schema) {
    Json object = Json::object();
    const auto left_out = names_left_out(schema);
    for (const auto& [name, property] : schema["properties"].items())
      if (!left_out.contains(name) && (always(name, schema) || chance(0.6)))
        object[name] = of(property);
    const Json named = schema.value("patternProperties", Json::object());
    for (const auto& [pattern, property] : named.items())
      for (const char* name : {"air", "aerosol", "ozone", "dust_2"})
        if (chance(0.5)) object[name] = of(property);
    if (object.contains("angle_deg")) {
      object["angle_deg"].front() = 0;
      object["angle_deg"].back() = 180;
    }
    return object;
  }
  static bool always(const std::string& name, const Json& schema) {
    static const std::vector<std::string> needed{"type",    "profile", "altitude_km",
                                                 "density", "values",  "angle_deg"};
    const Json required = schema.value("required", Json::array());
    return std::ranges::find(needed, name) != needed.end() ||
           std::find(required.begin(), required.end(), name) != required.end();
  }
  /// One form of each choice of alternative forms stays.
  Json names_left_out(const Json& schema) {
    Json left_out = Json::object();
    for (const Json& forms : schema.value("x-alternatives", Json::array())) {
      const Json& kept = one_of(forms);
      for (const Json& form : forms)
        for (const Json& name : form)
          if (std::find(kept.begin(), kept.end(), name) == kept.end())
            left_out[name.get<std::string>()] = true;
    }
    return left_out;
  }

  Json schema_;
  std::mt19937 random_;
  std::size_t wavelengths_ = 0;  ///< given in spectrum.wavelengths_nm; 0 is "auto"
};

}  // namespace cyanometer
