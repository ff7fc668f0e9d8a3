// The sun: where it stands, how strong it is, what it looks like.
#include "engine/optics/sun_position.h"
#include "engine/scene/members.h"

namespace cyanometer {
namespace {

Spelled<Place> place() {
  return object<Place>(
      Member("latitude_deg", &Place::latitude_deg, number(-90, 90), "Latitude",
             "Latitude on Earth, north is positive.")
          .slider(-90, 90, 0.1)
          .required(),
      Member("longitude_deg", &Place::longitude_deg, number(-360, 360), "Longitude",
             "Longitude on Earth, east is positive.")
          .slider(-180, 180, 0.1)
          .required(),
      Member("time", &Place::time, text("a date and time with its offset, as RFC 3339 has it"),
             "Time",
             "Date and time with the offset from UTC, such as 2024-06-20T18:30:00+02:00.")
          .required());
}

void stand_at(Sun& sun, const Place& place, const At& at) {
  try {
    const SunPosition position =
        sun_position(place.latitude_deg, place.longitude_deg, place.time);
    sun.elevation_deg = position.elevation_deg;
    sun.azimuth_deg = position.azimuth_deg;
  } catch (const std::invalid_argument& problem) {
    refuse(at / "time", place.time, problem.what());
  }
  at.reading.place = place;
}

Spelled<Irradiance> irradiance() {
  return one_of<Irradiance, MeasuredSunlight, Blackbody, Spectrum>(
      keyword<MeasuredSunlight>("solar"),
      object<Blackbody>(Member("blackbody_k", &Blackbody::blackbody_k, number(500, 1e6),
                               "Temperature",
                               "A black body, as strong in total as the real sun at 5772 K.")
                            .slider(1000, 20000, 50)
                            .required()),
      spectrum(0, 1e9));
}

void check_distance(const Sun& sun, const At& at) {
  const Scene& scene = at.reading.scene;
  const double top = scene.planet.radius_km + scene.atmosphere.thickness_km;
  if (sun.distance_km && *sun.distance_km <= top)
    refuse(at / "distance_km", *sun.distance_km, "more than " + in_words(top),
           "the sun is outside the air, and distances are from the planet's centre");
}

bool has_disc(const Sun& sun) { return sun.angular_diameter_deg > 0; }

}  // namespace

ObjectOf<Sun> sun_members() {
  return object<Sun>(
      Exclusive<Sun>({{{"elevation_deg", "azimuth_deg"}, {"place"}}}),
      Member("elevation_deg", &Sun::elevation_deg, number(-90, 90), "Elevation",
             "Height of the sun above the horizontal at the camera's foot point.")
          .slider(-20, 90, 0.1),
      Member("azimuth_deg", &Sun::azimuth_deg, number(-360, 360), "Azimuth",
             "Direction to the sun, clockwise from north.")
          .slider(-180, 180, 1),
      Consumed<Sun, Place>("place", place(), "Place and time",
                           "Instead of the angles: where on Earth and when.", stand_at),
      Member(
          "irradiance", &Sun::irradiance, irradiance(), "Irradiance",
          "Sunlight above the air on a plane that faces the sun: measured, a black body's, or "
          "a spectrum.")
          .unit("W m^-2 nm^-1")
          .otherwise("solar, or 1 where spectrum.colour is channels",
                     [](const Sun&, const Reading& read) -> Irradiance {
                       if (read.scene.spectrum.colour == Colour::channels) return Spectrum(1.0);
                       return MeasuredSunlight{};
                     })
          .slider(0, 10, 0.1),
      Member("solar_distance_au", &Sun::solar_distance_au, number(0.01, 1000),
             "Distance from the sun",
             "Of the planet: measured sunlight and a black body's fall with its square, and "
             "stars are so much brighter beside them. The disc has its own diameter.")
          .log_slider(0.1, 50),
      Member("angular_diameter_deg", &Sun::angular_diameter_deg, number(0, 90), "Diameter",
             "Angle that the sun's disc covers; 0 draws none.")
          .slider(0, 10, 0.01),
      Member("disc_samples", &Sun::disc_samples, integer(1, 256), "Disc samples",
             "Above 1, scattered light too is integrated over the disc with so many points.")
          .slider(1, 64, 1)
          .idle_unless(has_disc),
      Member("distance_km", &Sun::distance_km, optional(number(1, 1e12)), "Distance",
             "Of a near sun, from the planet's centre: its rays spread from a point. "
             "Without it they are parallel.")
          .log_slider(1e4, 1e9),
      Member("limb_darkening", &Sun::limb_darkening, boolean(), "Limb darkening",
             "Darken the edge of the disc, its mean kept.")
          .idle_unless(has_disc),
      Rule<Sun>(check_distance));
}

}  // namespace cyanometer
