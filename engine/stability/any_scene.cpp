#include "engine/stability/any_scene.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/accuracy/dice.h"
#include "engine/problem.h"
#include "engine/scene/document.h"
#include "engine/stability/trial.h"

namespace cyanometer {
namespace {

using nlohmann::json;

const json& schema() {
  static const json document = scene_schema();
  return document;
}

/// Draws values of a schema: what there is by one pair of dice, how large it is by the other.
class Draw {
 public:
  Draw(std::uint64_t form, std::uint64_t numbers) : form_(form), numbers_(numbers) {}

  json value(const json& node) {
    if (node.contains("anyOf")) {
      const json& variants = node["anyOf"];
      return value_of_variant(variants[form_.index(variants.size())], node);
    }
    return value_of_variant(node, node);
  }

 private:
  /// @param described  what holds the slider: the variant, or what it is one of
  json value_of_variant(const json& node, const json& described) {
    if (node.contains("const")) return node["const"];
    if (node.contains("enum")) return node["enum"][form_.index(node["enum"].size())];
    if (node.contains("anyOf")) return value(node);
    const std::string type = node.value("type", "");
    if (type == "object") return object(node);
    if (type == "array") return list(node, length());
    if (type == "boolean") return form_.chance(0.5);
    if (type == "integer") return std::llround(number(node, described));
    if (type == "number") return number(node, described);
    if (type == "string") return moment();
    return nullptr;
  }

  /// The one free text of the document; what else is asked for is a file's name, and there are
  /// no files.
  std::string moment() {
    char text[64];
    std::snprintf(
        text, sizeof text, "20%02d-%02d-%02dT%02d:30:00Z",
        static_cast<int>(numbers_.index(100)), static_cast<int>(numbers_.index(12)) + 1,
        static_cast<int>(numbers_.index(28)) + 1, static_cast<int>(numbers_.index(24)));
    return text;
  }

  json object(const json& node) {
    if (node.contains("patternProperties")) return named(*node["patternProperties"].begin());
    json drawn = json::object();
    const std::set<std::string> dropped = alternatives_not_taken(node);
    const auto required = node.value("required", std::set<std::string>());
    const std::size_t together = length();
    for (const auto& [name, member] : node.at("properties").items()) {
      const std::string type = member.value("type", "");
      const bool always = name == "type" || name == "profile" || required.contains(name) ||
                          type == "array" || (type == "object" && !member.contains("anyOf"));
      const bool wanted = form_.chance(0.6);
      if (dropped.contains(name) || !(always || wanted)) continue;
      // Lists beside each other are columns of one table.
      drawn[name] = type == "array" ? list(member, together) : value(member);
    }
    return drawn;
  }

  std::set<std::string> alternatives_not_taken(const json& node) {
    std::set<std::string> dropped, taken;
    for (const json& groups : node.value("x-alternatives", json::array())) {
      const std::size_t chosen = form_.index(groups.size());
      for (std::size_t i = 0; i < groups.size(); ++i) {
        for (const std::string name : groups[i]) (i == chosen ? taken : dropped).insert(name);
      }
    }
    for (const std::string& name : taken) dropped.erase(name);
    return dropped;
  }

  /// Constituents, some in the place of the Earth's, some of them taken out.
  json named(const json& member) {
    json drawn = json::object();
    for (const char* name : {"air", "aerosol", "ozone", "more"}) {
      if (form_.chance(0.4)) drawn[name] = value(member);
    }
    return drawn;
  }

  /// Three more often than not: the number of wavelengths that a scene has more often than not.
  std::size_t length() { return form_.chance(0.6) ? 3 : 1 + form_.index(6); }

  json list(const json& node, std::size_t length) {
    json items = json::array();
    for (const json& each : node.value("prefixItems", json::array()))
      items.push_back(value(each));
    if (!items.empty()) return items;
    length = std::clamp<std::size_t>(length, node.value("minItems", 0),
                                     node.value("maxItems", 4096));
    for (std::size_t i = 0; i < length; ++i) {
      json item = value(node["items"]);
      const bool again = std::ranges::find(items, item) != items.end();
      if (!(again && node.value("uniqueItems", false))) items.push_back(std::move(item));
    }
    const std::string order = node.value("x-order", "");
    if (order.empty()) return items;
    std::sort(items.begin(), items.end());
    if (form_.chance(0.5)) {
      items.front() = node["items"]["minimum"];
      items.back() = node["items"]["maximum"];
    }
    return items;
  }

  double number(const json& node, const json& described) {
    double from = node.at("minimum"), to = node.at("maximum");
    const double end = numbers_.uniform(0, 1);
    if (end < 0.01) return from;
    if (end < 0.02) return to;
    bool logarithmic = from >= 0 && to >= 1e4 * std::max(from, 1.0);
    if (described.contains("x-slider") && numbers_.chance(0.8)) {
      const json& slider = described["x-slider"];
      from = std::max<double>(from, slider.at("minimum"));
      to = std::min<double>(to, slider.at("maximum"));
      logarithmic = slider.at("scale") == "log";
    }
    if (logarithmic && to > 0)
      return std::clamp(numbers_.logarithmic(std::max(from, 1e-6), to), from, to);
    return numbers_.uniform(from, to);
  }

  Dice form_, numbers_;
};

/// @throws SceneError where a document is refused at any stage
void prepare(const json& document) {
  const Scene scene = read_scene(document);
  make_problem(scene, wavelengths_of(scene));
  make_output(scene, wavelengths_of(scene));
}

/// Takes out what is refused, member by member.
json allowed(json document) {
  for (;;) {
    try {
      prepare(document);
      return document;
    } catch (const SceneError& refused) {
      json::json_pointer at(refused.pointer);
      while (!at.empty() && !document.contains(at)) at.pop_back();
      if (at.empty()) return json::object();
      json& parent = document[at.parent_pointer()];
      // A list is of no use without one of its items.
      if (parent.is_array()) at.pop_back();
      document[at.parent_pointer()].erase(at.back());
    }
  }
}

}  // namespace

json any_scene(std::uint64_t seed) {
  json document = Draw(seed / scenes_of_a_form, seed).value(schema());
  if (document.contains("method")) {
    json orders = document["method"].value("scattering_orders", json("all"));
    document["method"] = {{"scattering_orders", std::move(orders)}};
  }
  if (document.contains("image")) {
    document["image"].erase("width");
    document["image"].erase("height");
  }
  return allowed(std::move(document));
}

}  // namespace cyanometer
