// Errors along one quantity of a scene.
#include <nlohmann/json.hpp>

#include "engine/scene/document.h"
#include "engine/stability/suite.h"

namespace cyanometer {
namespace {

using nlohmann::json;

/// Rays of a whole sky, and of the ground below where the camera is high.
std::vector<Measured> error_of_the_sky(Trial& trial, const json& scene) {
  return measured(trial.error(scene, fan({2, 8, 20, 45, 80}, {5, 40, 90, 140, 175})));
}

json at_sun(double elevation_deg) {
  return changed(plain_scene(), {{"sun", {{"elevation_deg", elevation_deg}}}});
}

json with_haze(double optical_depth, double g) {
  return changed(at_sun(30),
                 {{"atmosphere",
                   {{"constituents",
                     {{"aerosol",
                       {{"type", "particles"},
                        {"optical_depth", optical_depth},
                        {"single_scattering_albedo", 0.95},
                        {"phase", {{"type", "henyey_greenstein"}, {"g", g}}}}}}}}}});
}

StabilityRow curve(const char* name, const char* trigger, std::vector<double> sweep,
                   std::function<json(double)> scene) {
  StabilityRow row{.name = name,
                   .trigger = trigger,
                   .quantity = "error",
                   .stated_errors = 1,
                   .sweep = std::move(sweep)};
  row.scene = scene;
  row.measure = [scene](Trial& trial, double x) { return error_of_the_sky(trial, scene(x)); };
  return row;
}

StabilityRow over_altitude() {
  StabilityRow row = curve("altitude", "camera's altitude, km",
                           {0.002, 1, 5, 20, 60, 200, 2000}, [](double x) {
                             return changed(at_sun(20), {{"camera", {{"altitude_km", x}}}});
                           });
  row.measure = [scene = row.scene](Trial& trial, double x) -> std::vector<Measured> {
    json whole = changed(scene(x), {{"camera", {{"projection", "equirectangular"}}},
                                    {"image", {{"width", 128}, {"height", 64}}}});
    auto rays = sample_directions(read_scene(whole), x > 1000 ? 1024 : 64);
    return measured(trial.error(scene(x), rays));
  };
  return row;
}

/// Titan from seven radii away, its whole disc or what is left of it: the haze is thick, the
/// light comes through its edge, and most of what is seen lies in twilight.
StabilityRow over_phase() {
  StabilityRow row = curve("crescent", "phase angle of Titan, deg", {30, 90, 120, 150, 165},
                           [](double phase_deg) -> json {
                             return {{"preset", "titan"},
                                     {"sun", {{"elevation_deg", 90 - phase_deg}}},
                                     {"camera",
                                      {{"altitude_km", 18000},
                                       {"pitch_deg", -90},
                                       {"projection", "perspective"},
                                       {"fov_deg", 18}}},
                                     {"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
                                     {"image", {{"width", 160}, {"height", 160}}}};
                           });
  row.measure = [scene = row.scene](Trial& trial, double x) -> std::vector<Measured> {
    return measured(trial.error(scene(x), sample_directions(read_scene(scene(x)), 64)));
  };
  return row;
}

}  // namespace

const std::vector<StabilityRow>& stability_curves() {
  static const std::vector<StabilityRow> curves{
      curve("sun", "sun's elevation, deg",
            {90, 60, 30, 10, 5, 2, 0, -2, -4, -6, -9, -12, -15, -18},
            [](double x) {
              return changed(at_sun(x), {{"atmosphere", {{"thickness_km", 200}}}});
            }),
      over_altitude(),
      curve("optical depth", "optical depth of haze, g 0.7", {0.03, 0.1, 0.3, 1, 3, 10},
            [](double x) { return with_haze(x, 0.7); }),
      curve("g", "g of haze of optical depth 0.2", {0, 0.4, 0.7, 0.8, 0.9, 0.95},
            [](double x) { return with_haze(0.2, x); }),
      curve("radius", "radius, km, the air as it is", {300, 1000, 3000, 6360, 20000, 60000},
            [](double x) {
              return changed(at_sun(5), {{"planet", {{"radius_km", x}}}});
            }),
      over_phase()};
  return curves;
}

}  // namespace cyanometer
