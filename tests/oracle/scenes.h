// Scenes that the oracle and the device are compared on.
#pragma once

#include <cmath>
#include <fstream>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "engine/engine.h"
#include "engine/problem.h"

namespace cyanometer::oracle {

/// The scene of tests/data/single_scattering.json: order one, irradiance 1, three wavelengths.
inline Scene reference_scene(double altitude_km, double sun_elevation_deg,
                             double ground_albedo = 0) {
  Scene scene;
  scene.planet.ground_albedo = ground_albedo;
  scene.atmosphere.constituents["air"] = {
      ExponentialProfile{8},
      Molecules{ScatteringCoefficient{PerWavelength{{0.005802, 0.013558, 0.0331}}}}};
  scene.atmosphere.constituents["aerosol"] = {
      ExponentialProfile{1.2},
      Particles{ParticleCoefficients{0.003996, 0.000444}, CornetteShanks{0.8}}};
  scene.atmosphere.constituents["ozone"] = {
      TentProfile{25, 15},
      Absorber{AbsorptionCoefficient{PerWavelength{{0.00065, 0.001881, 8.5e-05}}}}};
  scene.sun.elevation_deg = sun_elevation_deg;
  scene.sun.irradiance = Spectrum{1.0};
  scene.camera.altitude_km = altitude_km;
  scene.spectrum = {{680, 550, 440}, Colour::channels};
  scene.method.name = "nishita";
  scene.method.scattering_orders = 1;
  scene.method.options = {{"view_samples", 64}, {"light_samples", 16}};
  scene.image.width = 64;
  scene.image.height = 36;
  return scene;
}

inline glm::dvec3 towards(double elevation_deg, double azimuth_deg) {
  double e = glm::radians(elevation_deg), a = glm::radians(azimuth_deg);
  return {std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e)};
}

/// Directions that meet the planet, spread evenly over elevation and azimuth.
inline std::vector<Direction> spread_directions(double altitude_km, int count) {
  double lowest = -90, highest = 90;
  if (altitude_km > 100) {
    highest = -glm::degrees(std::acos(6460 / (6360 + altitude_km))) - 1e-6;
    lowest = highest - 2 * (90 + highest);  // the planet from limb to limb, through the nadir
  }
  std::vector<Direction> directions;
  for (int i = 0; i < count; ++i) {
    double elevation = lowest + (highest - lowest) * (i + 0.5) / count;
    double azimuth = std::fmod(137.50776 * i, 360);
    directions.push_back(elevation >= -90 ? Direction{elevation, azimuth}
                                          : Direction{-180 - elevation, azimuth});
  }
  return directions;
}

inline nlohmann::json published(const std::string& file) {
  std::ifstream stream(std::string(CYANOMETER_TEST_DATA) + "/" + file);
  return nlohmann::json::parse(stream);
}

}  // namespace cyanometer::oracle
