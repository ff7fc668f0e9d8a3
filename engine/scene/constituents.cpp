// What the air is made of.
#include "engine/scene/members.h"
#include "engine/scene/variant_object.h"

namespace cyanometer {
namespace {

Spelled<Spectrum> coefficient() { return spectrum(0, 1e6); }

/// Refuses lists that belong together and differ in length.
void check_same_length(const std::vector<double>& of, const std::string& name,
                       const std::vector<double>& expected, const std::string& its_name,
                       const At& at) {
  if (of.size() != expected.size())
    refuse(at / name, of, "a list of " + std::to_string(expected.size()) + " numbers",
           "one for each of " + its_name);
}

// ---- Profiles

ObjectOf<TableProfile> table_profile() {
  return object<TableProfile>(
      Member("altitude_km", &TableProfile::altitude_km,
             list(number(0, 1e6), 2, 4096, Order::ascending), "Altitudes",
             "The altitudes of the densities.")
          .required(),
      Member("density", &TableProfile::density, list(number(0, 1e30), 2, 4096), "Densities",
             "Density at each altitude, in any unit; it is divided by its maximum.")
          .required(),
      Rule<TableProfile>([](const TableProfile& table, const At& at) {
        check_same_length(table.density, "density", table.altitude_km, "its altitude_km", at);
        if (std::ranges::max(table.density) == 0)
          refuse(at / "density", table.density, "above zero somewhere");
      }));
}

Spelled<Profile> profile() {
  return tagged<Profile>(
      cases<Profile>()
          .type("exponential", "Exponential, 1 at the ground",
                object<ExponentialProfile>(
                    Member("scale_height_km", &ExponentialProfile::scale_height_km,
                           number(0.01, 1000), "Scale height",
                           "The altitude over which the density falls to 1/e.")
                        .log_slider(0.1, 100)))
          .type(
              "tent", "A layer, linear to both sides",
              object<TentProfile>(
                  Member("centre_km", &TentProfile::centre_km, number(0, 1e5),
                         "Layer's altitude", "The altitude at which the layer is densest.")
                      .slider(0, 100, 0.5),
                  Member("half_width_km", &TentProfile::half_width_km, number(0.01, 1e5),
                         "Layer's half width", "From the densest altitude to the layer's edge.")
                      .log_slider(0.1, 100)))
          .type("quadratic", "(1 - h / top)^2", object<QuadraticProfile>())
          .type("uniform", "The same up to the top", object<UniformProfile>())
          .type("table", "A table of densities", table_profile()));
}

// ---- Phase functions

template <class T>
ObjectOf<T> asymmetry() {
  return object<T>(Member("g", &T::g, number(-0.999, 0.999), "Asymmetry",
                          "The mean cosine of the scattering angle; above zero is forward.")
                       .slider(-0.95, 0.95, 0.01));
}

ObjectOf<MieSpheres> mie_spheres() {
  return object<MieSpheres>(
      Member("radius_um", &MieSpheres::radius_um, number(0.001, 50), "Radius",
             "The number-median radius of the spheres.")
          .log_slider(0.01, 10),
      Member("geometric_sigma", &MieSpheres::geometric_sigma, number(1, 3), "Spread of radii",
             "The geometric standard deviation of the log-normal radii; 1 is a single size.")
          .slider(1, 2.5, 0.01),
      Member("refractive_index", &MieSpheres::refractive_index,
             pair(number(0.05, 10), number(0, 10)), "Refractive index",
             "Real and imaginary part; a positive imaginary part absorbs."));
}

ObjectOf<PhaseTable> phase_table() {
  return object<PhaseTable>(
      Member("angle_deg", &PhaseTable::angle_deg,
             list(number(0, 180), 2, 4096, Order::ascending), "Angles",
             "Scattering angles from 0 (forward) to 180.")
          .required(),
      Member("values", &PhaseTable::values, list(number(1e-30, 1e30), 2, 4096), "Values",
             "The phase function at each angle, in any unit; it is normalised.")
          .required(),
      Rule<PhaseTable>([](const PhaseTable& table, const At& at) {
        check_same_length(table.values, "values", table.angle_deg, "its angle_deg", at);
        if (table.angle_deg.front() != 0 || table.angle_deg.back() != 180)
          refuse(at / "angle_deg", table.angle_deg,
                 "a list that begins with 0 and ends with 180");
      }));
}

Spelled<Phase> phase() {
  return tagged<Phase>(
      cases<Phase>()
          .type("henyey_greenstein", "Henyey-Greenstein", asymmetry<HenyeyGreenstein>())
          .type("cornette_shanks", "Cornette-Shanks", asymmetry<CornetteShanks>())
          .type("mie", "Spheres, by Mie theory", mie_spheres())
          .type("table", "A table of values", phase_table()));
}

// ---- Molecules

ObjectOf<Gas> gas() {
  return object<Gas>(
      Member("refractive_index", &Gas::refractive_index,
             one_of<std::variant<std::string, Spectrum>, std::string, Spectrum>(
                 one_name_of({"air", "co2", "n2", "h2", "he", "ch4"}), spectrum(1, 3)),
             "Refractive index",
             "A gas with its dispersion, or the index, at 101325 Pa and 288.15 K."),
      Member("pressure_pa", &Gas::pressure_pa, number(0, 1e8), "Pressure",
             "Pressure where the profile is 1; scattering grows in proportion.")
          .log_slider(100, 1e7),
      Member("temperature_k", &Gas::temperature_k, number(1, 1e5), "Temperature",
             "Temperature where the profile is 1; scattering falls in proportion.")
          .slider(20, 1000, 1),
      Member("king_factor", &Gas::king_factor, optional(number(1, 3)), "King factor",
             "How much more the gas scatters than round molecules would; 1 is round.")
          .slider(1, 1.2, 0.001));
}

ObjectOf<Molecules> molecules() {
  return object<Molecules>(Forms<Molecules>(
      cases<Molecules>(&Molecules::optics)
          .form(gas())
          .form(object<ScatteringCoefficient>(
              Member("scattering_per_km", &ScatteringCoefficient::scattering_per_km,
                     coefficient(), "Scattering", "Scattering where the profile is 1.")
                  .log_slider(1e-4, 10)
                  .required()))));
}

// ---- Particles

Spelled<Spectrum> fraction() { return spectrum(0, 1); }

constexpr auto albedo_name = "single_scattering_albedo";
constexpr auto albedo_title = "Single-scattering albedo";
constexpr auto albedo_help =
    "The share of what particles take out of a beam that they scatter.";

template <class T>
auto albedo() {
  return Member(albedo_name, &T::single_scattering_albedo, fraction(), albedo_title,
                albedo_help)
      .slider(0, 1, 0.01);
}

ObjectOf<ParticleCoefficients> particle_coefficients() {
  return object<ParticleCoefficients>(
      Member("scattering_per_km", &ParticleCoefficients::scattering_per_km, coefficient(),
             "Scattering", "Scattering where the profile is 1.")
          .log_slider(1e-4, 10),
      Member("absorption_per_km", &ParticleCoefficients::absorption_per_km, coefficient(),
             "Absorption", "Absorption where the profile is 1.")
          .log_slider(1e-4, 10));
}

constexpr auto depth_name = "optical_depth";
constexpr auto depth_title = "Optical depth";
constexpr auto depth_help = "Vertical optical depth of extinction, from the ground to the top.";

constexpr double greatest_depth = 1e4;

ObjectOf<MieOpticalDepth> mie_optical_depth() {
  return object<MieOpticalDepth>(
      Wrapped<MieOpticalDepth>(
          depth_name,
          object<MieOpticalDepth>(
              Member("value", &MieOpticalDepth::value, number(0, greatest_depth), "Value",
                     "The optical depth at one wavelength; the others "
                     "follow from Mie theory.")
                  .log_slider(1e-3, 10)
                  .required(),
              Member("at_nm", &MieOpticalDepth::at_nm, wavelength(), "At",
                     "The wavelength at which the optical depth holds.")
                  .slider(380, 780, 1)
                  .required()),
          depth_title, depth_help),
      Consumed<MieOpticalDepth, Spectrum>(albedo_name, fraction(), albedo_title, albedo_help));
}

ObjectOf<Particles> particles() {
  return object<Particles>(
      Forms<Particles>(
          cases<Particles>(&Particles::optics)
              .form(particle_coefficients())
              .form(object<ParticleOpticalDepth>(
                  Member(depth_name, &ParticleOpticalDepth::optical_depth,
                         spectrum(0, greatest_depth), depth_title, depth_help)
                      .log_slider(1e-3, 10)
                      .required(),
                  albedo<ParticleOpticalDepth>()))
              .form(mie_optical_depth())
              .form(object<Visibility>(
                  Member("visibility_km", &Visibility::visibility_km, number(0.001, 1e6),
                         "Visibility", "How far one sees where the profile is 1, at 550 nm.")
                      .log_slider(0.1, 300)
                      .required(),
                  albedo<Visibility>())),
          /*required=*/true),
      Member("phase", &Particles::phase, phase(), "Phase function",
             "How much light is scattered into which direction."),
      Rule<Particles>([](const Particles& particles, const At& at) {
        if (const auto* depth = std::get_if<MieOpticalDepth>(&particles.optics);
            depth && !std::holds_alternative<MieSpheres>(particles.phase))
          refuse(at / std::string_view(depth_name),
                 {{"value", depth->value}, {"at_nm", depth->at_nm}},
                 spectrum(0, greatest_depth)->words(),
                 "only with a phase of type mie the rest follows");
      }));
}

// ---- Absorbers

ObjectOf<Absorber> absorber() {
  return object<Absorber>(Forms<Absorber>(
      cases<Absorber>(&Absorber::optics)
          .form(object<AbsorptionCoefficient>(
              Member("absorption_per_km", &AbsorptionCoefficient::absorption_per_km,
                     coefficient(), "Absorption", "Absorption where the profile is 1.")
                  .log_slider(1e-5, 1)
                  .required()))
          .form(object<Ozone>(
              Constant<Ozone>("gas", "ozone", "Gas", "The gas, whose cross-section is known."),
              Member("dobson_units", &Ozone::dobson_units, number(0, 1e6), "Column",
                     "The whole column of the gas, ground to top.")
                  .unit("DU")
                  .slider(0, 1000, 5))),
      /*required=*/true));
}

}  // namespace

Spelled<Constituent> constituent() {
  return tagged<Constituent>(
      cases<Constituent>(&Constituent::matter)
          .type("molecules", "Molecules of a gas, which scatter", molecules(), "air")
          .type("particles", "Particles, which scatter and absorb", particles(), "haze")
          .type("absorber", "A gas that absorbs", absorber(), "ozone"),
      object<Constituent>(Member("profile", &Constituent::profile, profile(), "Profile",
                                 "How the density changes with altitude.")
                              .required()));
}

}  // namespace cyanometer
