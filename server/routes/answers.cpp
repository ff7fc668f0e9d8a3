#include "server/routes/answers.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/scene/document.h"

namespace cyanometer {
namespace {

using nlohmann::json;

/// In the words in which the scene's own members are refused.
[[noreturn]] void refuse(const std::string& pointer, const json& given,
                         const std::string& allowed) {
  std::string text = given.dump(-1, ' ', false, json::error_handler_t::replace);
  if (text.size() > 80) text = text.substr(0, 77) + "...";
  const std::string place = pointer.empty() ? "the document" : pointer;
  throw SceneError(pointer, text, allowed,
                   place + " must be " + allowed + ", not " + text + ".");
}

[[noreturn]] void miss(const std::string& pointer, const std::string& allowed) {
  throw SceneError(pointer, "", allowed, pointer + " is missing: it must be " + allowed + ".");
}

/// RFC 6901: a name as part of a pointer.
std::string escaped(const std::string& name) {
  std::string out;
  for (const char c : name) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return out;
}

void check_members(const json& object, const std::string& pointer,
                   const std::vector<std::string>& known) {
  std::string allowed;
  for (const auto& name : known) allowed += (allowed.empty() ? "" : ", ") + name;
  if (!object.is_object()) refuse(pointer, object, "an object with " + allowed);
  for (const auto& [name, unused] : object.items()) {
    if (std::ranges::find(known, name) == known.end()) {
      const std::string at = pointer + "/" + escaped(name);
      throw SceneError(at, "", allowed, at + " is not a member; there are " + allowed + ".");
    }
  }
}

double read_angle(const json& direction, const std::string& pointer, const std::string& name,
                  double limit) {
  const std::string allowed = "a number from " + std::to_string(static_cast<int>(-limit)) +
                              " to " + std::to_string(static_cast<int>(limit));
  const auto found = direction.find(name);
  if (found == direction.end()) miss(pointer + "/" + name, allowed);
  if (!found->is_number()) refuse(pointer + "/" + name, *found, allowed);
  const double value = found->get<double>();
  if (!(std::abs(value) <= limit)) refuse(pointer + "/" + name, *found, allowed);
  return value;
}

std::vector<Direction> read_directions(const json& document) {
  const std::string pointer = "/directions";
  const std::string allowed =
      "a list of 1 to " + std::to_string(most_directions) + " directions";
  const auto found = document.find("directions");
  if (found == document.end()) miss(pointer, allowed);
  if (!found->is_array() || found->empty()) refuse(pointer, *found, allowed);
  if (found->size() > most_directions) {
    throw OverLimit(pointer, std::to_string(found->size()) + " directions are more than " +
                                 std::to_string(most_directions));
  }
  std::vector<Direction> out;
  for (std::size_t i = 0; i < found->size(); ++i) {
    const auto& each = (*found)[i];
    const std::string at = pointer + "/" + std::to_string(i);
    check_members(each, at, {"elevation_deg", "azimuth_deg"});
    out.push_back(
        {read_angle(each, at, "elevation_deg", 90), read_angle(each, at, "azimuth_deg", 360)});
  }
  return out;
}

/// A scene that is a member of the body.
Scene read_scene_at(const std::string& pointer, const json& document) {
  try {
    return read_scene(document);
  } catch (const SceneError& error) {
    const std::string what = error.what();
    throw SceneError(pointer + error.pointer, error.given, error.allowed,
                     what.starts_with('/') ? pointer + what : what);
  }
}

}  // namespace

json plan_document(const Scene& scene, const Plan& plan) {
  json document = plan_document(plan);
  document["scene"] = canonical(scene);
  document["ms"] = plan.expected_ms;
  document["met"] = plan.met;
  document["why"] = plan.why;
  document["atmosphere"] = atmosphere_key(scene);
  return document;
}

RadianceRequest read_radiance_request(const json& document) {
  check_members(document, "", {"scene", "directions", "irradiance"});
  RadianceRequest out;
  out.scene = read_scene_at("/scene", document.value("scene", json::object()));
  out.directions = read_directions(document);
  const auto irradiance = document.find("irradiance");
  if (irradiance != document.end()) {
    if (!irradiance->is_boolean()) {
      refuse("/irradiance", *irradiance, "true or false");
    }
    out.irradiance = irradiance->get<bool>();
  }
  return out;
}

json radiance_document(const Radiances& radiances) {
  json out{{"wavelengths_nm", radiances.wavelengths_nm},
           {"radiance", radiances.radiance},
           {"standard_error", nullptr},
           {"transmittance", radiances.transmittance},
           {"method", radiances.plan.method},
           {"error", radiances.plan.expected_error}};
  if (radiances.standard_error) out["standard_error"] = *radiances.standard_error;
  if (const auto& flux = radiances.irradiance) {
    out["irradiance"] = {{"direct", flux->direct},
                         {"diffuse_down", flux->diffuse_down},
                         {"diffuse_up", flux->diffuse_up}};
  }
  return out;
}

CompareRequest read_compare_request(const json& document) {
  check_members(document, "", {"a", "b"});
  const auto scene_at = [&](const std::string& name) {
    if (!document.contains(name)) miss("/" + name, "a scene");
    return read_scene_at("/" + name, document[name]);
  };
  CompareRequest out{scene_at("a"), scene_at("b")};
  check_comparable(out.a, out.b);
  return out;
}

json comparison_document(const Comparison& comparison) {
  const ErrorMeasure& measure = comparison.measure;
  json out{{"error", measure.error},
           {"bias", measure.bias},
           {"p99", measure.p99},
           {"max", measure.max},
           {"ciede2000_p99", comparison.ciede2000_p99},
           {"banding", comparison.banding}};
  if (comparison.error_95) out["error_95"] = *comparison.error_95;
  return out;
}

json explanation_document(const std::vector<Worth>& ingredients) {
  json out = json::object();
  for (const Worth& worth : ingredients) {
    json difference = nullptr;
    if (worth.ciede2000) difference = *worth.ciede2000;
    out[worth.name] = {
        {"error", worth.error}, {"ciede2000", difference}, {"ms_saved", worth.ms_saved}};
  }
  return out;
}

}  // namespace cyanometer
