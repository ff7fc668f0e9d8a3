// The planet and its air.
#include "engine/scene/members.h"
#include "engine/scene/named_map.h"
#include "engine/scene/presets.h"

namespace cyanometer {
namespace {

Spelled<std::map<std::string, Constituent>> constituents() {
  return named_map(/*longest_name=*/32, /*most=*/32, constituent());
}

}  // namespace

ObjectOf<Planet> planet_members() {
  return object<Planet>(
      Member("radius_km", &Planet::radius_km, number(1, 1e7), "Planet's radius",
             "Radius of the ground's sphere.")
          .log_slider(10, 1e5),
      Member("surface", &Planet::surface, surface(), "Surface",
             "How the ground differs from place to place."),
      Member("ground_albedo", &Planet::ground_albedo, spectrum(0, 1), "Ground albedo",
             "The share of the light that falls on the ground which it reflects, evenly to all "
             "sides; idle where the surface is not uniform.")
          .slider(0, 1, 0.01)
          .idle_unless([](const Planet& planet) {
            return std::holds_alternative<UniformSurface>(planet.surface);
          }));
}

ObjectOf<Atmosphere> atmosphere_members() {
  return object<Atmosphere>(
      Member("thickness_km", &Atmosphere::thickness_km, number(0.01, 1e6), "Top of the air",
             "Altitude above which there is nothing; a profile that reaches higher is cut.")
          .log_slider(1, 1000),
      Member("constituents", &Atmosphere::constituents, constituents(), "Constituents",
             "What the air is made of, each under a name; null removes one.")
          .otherwise(
              "those of " + std::string(base_preset), [](const Atmosphere&, const Reading&) {
                Reading earth;
                return constituents()->read(
                    expanded_preset(base_preset)["atmosphere"]["constituents"], At{earth, ""});
              }));
}

}  // namespace cyanometer
