#include "server/routes/answers.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/accuracy/finest.h"
#include "engine/scene/document.h"
#include "server/routes/reading.h"

namespace cyanometer {
namespace {

using nlohmann::json;

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
  Scene scene;
  within(pointer, [&] { scene = read_scene(document); });
  return scene;
}

/// `rgb` as in files, and of colours that an observer would see, the luminance.
void add_colours(const Scene& scene, const Radiances& radiances, json& out) {
  const RayColours colours(scene, radiances.wavelengths_nm);
  json rgb = json::array(), luminance = nullptr;
  for (const auto& ray : radiances.relative) rgb.push_back(colours.rgb(ray));
  if (scene.spectrum.colour == Colour::cie) {
    luminance = json::array();
    for (const auto& xyz : colours.error_channels(radiances.relative)) {
      luminance.push_back(xyz[1] * colours.output().white_luminance);
    }
  }
  out["rgb"] = rgb;
  out["luminance_cd_m2"] = luminance;
}

}  // namespace

json plan_document(const Scene& scene, const Plan& plan) {
  json document = plan_document(plan);
  document["scene"] = canonical(scene);
  document["ms"] = plan.expected_ms;
  document["met"] = plan.met;
  document["why"] = plan.why;
  document["limits"] = limits_near(scene, plan.method);
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

json radiance_document(const Scene& scene, const Radiances& radiances) {
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
  add_colours(scene, radiances, out);
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

FramePair render_pair(Engine& engine, const CompareRequest& asked, const Watch& watch) {
  FramePair frames;
  // What is refused of b is refused of it alone too; all else is a's.
  try {
    within("/a", [&] { frames = render_pair(engine, asked.a, asked.b, watch); });
  } catch (const SceneError&) {
    within("/b", [&] { engine.plan(asked.b, watch); });
    throw;
  } catch (const OverLimit&) {
    within("/b", [&] { engine.render(asked.b, watch); });
    throw;
  }
  return frames;
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

json attribution_document(const Attribution& attribution) {
  json out = plan_document(attribution.plan);
  const EstimatedError& error = attribution.error;
  out.update({{"error", error.measure.error},
              {"error_95", {error.low, error.high}},
              {"reference_noise", attribution.reference_noise},
              {"shares", json::array()}});
  for (const ErrorShare& share : attribution.shares)
    out["shares"].push_back(
        {{"cause", share.cause}, {"error", share.error}, {"how", share.how}});
  return out;
}

}  // namespace cyanometer
