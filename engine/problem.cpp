#include "engine/problem.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "engine/optics/colour.h"
#include "engine/optics/gas.h"
#include "engine/optics/interpolate.h"
#include "engine/optics/mie.h"
#include "engine/optics/ozone.h"
#include "engine/optics/phase.h"
#include "engine/optics/profile.h"
#include "engine/optics/spectrum.h"
#include "engine/optics/sunlight.h"
#include "engine/optics/visibility.h"
#include "engine/scene/document.h"

namespace cyanometer {
namespace {

constexpr double degree = std::numbers::pi / 180;

// ---- Media

/// One constituent on its way to a medium.
struct Mixing {
  const Scene& scene;
  const std::vector<double>& wavelengths_nm;
  const std::string& name;
  const Profile& profile;

  std::vector<double> at_wavelengths(const Spectrum& spectrum) const {
    return evaluate(spectrum, scene.spectrum.wavelengths_nm, wavelengths_nm);
  }
  std::vector<double> zeros() const { return std::vector<double>(wavelengths_nm.size(), 0.0); }

  /// The length by which a vertical optical depth becomes a coefficient.
  double column(const char* member, double asked) const {
    const double length = column_km(profile, scene.atmosphere.thickness_km);
    if (length > 0 || asked <= 0) return length > 0 ? length : 1;
    throw SceneError("/atmosphere/constituents/" + name + "/" + member,
                     nlohmann::json(asked).dump(), "0, or a profile that is dense somewhere",
                     "nothing of the profile lies between the ground and the top");
  }

  Medium medium() const {
    return {name, normalised(profile), zeros(), zeros(), HenyeyGreenstein{0}};
  }

  Medium operator()(const Molecules& molecules) const {
    return std::visit(*this, molecules.optics);
  }
  Medium operator()(const Absorber& absorber) const {
    return std::visit(*this, absorber.optics);
  }

  Medium operator()(const Gas& gas) const {
    Medium m = medium();
    RayleighPhase phase;
    for (std::size_t w = 0; w < wavelengths_nm.size(); ++w) {
      const double l = wavelengths_nm[w];
      const auto* named = std::get_if<std::string>(&gas.refractive_index);
      const double index = named ? refractive_index(*named, l)
                                 : evaluate(std::get<Spectrum>(gas.refractive_index),
                                            scene.spectrum.wavelengths_nm, l);
      const double king = gas.king_factor.value_or(named ? king_factor(*named, l) : 1);
      m.scattering_per_km[w] =
          molecular_scattering_per_km(index, king, gas.pressure_pa, gas.temperature_k, l);
      phase.gamma.push_back(depolarisation_gamma(king));
    }
    m.phase = phase;
    return m;
  }
  Medium operator()(const ScatteringCoefficient& given) const {
    Medium m = medium();
    m.scattering_per_km = at_wavelengths(given.scattering_per_km);
    m.phase = RayleighPhase{zeros()};
    return m;
  }

  Medium operator()(const AbsorptionCoefficient& given) const {
    Medium m = medium();
    m.absorption_per_km = at_wavelengths(given.absorption_per_km);
    return m;
  }
  Medium operator()(const Ozone& ozone) const {
    Medium m = medium();
    const double per_m2 = ozone.dobson_units * molecules_per_dobson_unit;
    const double length = column("dobson_units", ozone.dobson_units);
    for (std::size_t w = 0; w < wavelengths_nm.size(); ++w)
      m.absorption_per_km[w] = per_m2 * ozone_cross_section_m2(wavelengths_nm[w]) / length;
    return m;
  }

  Medium operator()(const Particles& particles) const {
    Medium m = medium();
    m.phase = std::visit([&](const auto& phase) { return tabulated(phase); }, particles.phase);
    const auto* spheres = std::get_if<MieSpheres>(&particles.phase);
    std::visit([&](const auto& optics) { add(m, optics, spheres); }, particles.optics);
    return m;
  }

  PhaseFunction tabulated(const HenyeyGreenstein& phase) const { return phase; }
  PhaseFunction tabulated(const CornetteShanks& phase) const { return phase; }
  PhaseFunction tabulated(const MieSpheres& spheres) const {
    return TabulatedPhase{mie_angles_rad(), mie_optics(spheres, wavelengths_nm).phase};
  }
  PhaseFunction tabulated(const PhaseTable& table) const {
    std::vector<double> angle_rad;
    for (double angle : table.angle_deg) angle_rad.push_back(angle * degree);
    if (!(sphere_integral(angle_rad, table.values) > 0))
      throw SceneError("/atmosphere/constituents/" + name + "/phase/values",
                       nlohmann::json(table.values).dump(), "values of which some are above 0",
                       "a phase function scatters somewhere");
    return TabulatedPhase{angle_rad, std::vector(wavelengths_nm.size(),
                                                 normalised_phase(angle_rad, table.values))};
  }

  void split(Medium& m, const std::vector<double>& extinction,
             const std::vector<double>& albedo) const {
    for (std::size_t w = 0; w < wavelengths_nm.size(); ++w) {
      m.scattering_per_km[w] = extinction[w] * albedo[w];
      m.absorption_per_km[w] = extinction[w] * (1 - albedo[w]);
    }
  }

  void add(Medium& m, const ParticleCoefficients& given, const MieSpheres*) const {
    m.scattering_per_km = at_wavelengths(given.scattering_per_km);
    m.absorption_per_km = at_wavelengths(given.absorption_per_km);
  }
  void add(Medium& m, const ParticleOpticalDepth& given, const MieSpheres*) const {
    std::vector<double> extinction = at_wavelengths(given.optical_depth);
    const double length = column("optical_depth", std::ranges::max(extinction));
    for (double& value : extinction) value /= length;
    split(m, extinction, at_wavelengths(given.single_scattering_albedo));
  }
  void add(Medium& m, const MieOpticalDepth& given, const MieSpheres* spheres) const {
    const double extinction = given.value / column("optical_depth", given.value);
    const double number = spheres_per_um2_km(*spheres, given.at_nm, extinction);
    const MieOptics mie = mie_optics(*spheres, wavelengths_nm);
    for (std::size_t w = 0; w < wavelengths_nm.size(); ++w) {
      const double absorbing_um2 = mie.extinction_um2[w] - mie.scattering_um2[w];
      m.scattering_per_km[w] = number * mie.scattering_um2[w];
      m.absorption_per_km[w] = number * std::max(0.0, absorbing_um2);  // not -1e-17
    }
  }
  void add(Medium& m, const Visibility& given, const MieSpheres* spheres) const {
    const double at_550_nm = visibility_optical_depth / given.visibility_km;
    std::vector<double> extinction(wavelengths_nm.size(), at_550_nm);
    if (spheres) {
      const double number = spheres_per_um2_km(*spheres, visibility_at_nm, at_550_nm);
      extinction = mie_optics(*spheres, wavelengths_nm).extinction_um2;
      for (double& value : extinction) value *= number;
    }
    split(m, extinction, at_wavelengths(given.single_scattering_albedo));
  }

  /// How many spheres it takes for an extinction at a wavelength, as a factor from
  /// cross-sections in um^2 to coefficients per km.
  double spheres_per_um2_km(const MieSpheres& spheres, double at_nm,
                            double extinction_per_km) const {
    const double each_um2 = mie_optics(spheres, {at_nm}).extinction_um2[0];
    if (each_um2 > 0) return extinction_per_km / each_um2;
    throw SceneError("/atmosphere/constituents/" + name + "/phase/refractive_index",
                     nlohmann::json(spheres.refractive_index).dump(),
                     "an index other than that of air, 1",
                     "no number of such spheres has an optical depth");
  }
};

bool does_anything(const Medium& medium) {
  const auto some = [](double value) { return value != 0; };
  return std::ranges::any_of(medium.scattering_per_km, some) ||
         std::ranges::any_of(medium.absorption_per_km, some);
}

std::vector<Medium> make_media(const Scene& scene, const std::vector<double>& wavelengths_nm) {
  std::vector<Medium> media;
  for (const auto& [name, constituent] : scene.atmosphere.constituents) {
    Medium medium = std::visit(Mixing{scene, wavelengths_nm, name, constituent.profile},
                               constituent.matter);
    if (does_anything(medium)) media.push_back(std::move(medium));
  }
  return media;
}

/// Towards the sun at the camera's foot point: x east, y north, z up.
std::array<double, 3> direction_to(const Sun& sun) {
  const double elevation = sun.elevation_deg * degree, azimuth = sun.azimuth_deg * degree;
  return {std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth),
          std::sin(elevation)};
}

/// Heights are in the air that there is.
void check_relief(const Scene& scene, const Ground& ground) {
  if (ground.relief_km < scene.atmosphere.thickness_km) return;
  const bool map = std::holds_alternative<MapSurface>(scene.planet.surface);
  throw SceneError(map ? "/planet/surface/height_km" : "/planet/surface/relief_km",
                   nlohmann::json(ground.relief_km).dump(),
                   "less than atmosphere.thickness_km, " +
                       nlohmann::json(scene.atmosphere.thickness_km).dump(),
                   "the ground stands out of the air");
}

// ---- Output

/// Y 1 of a `cie` image in cd/m^2.
constexpr double white_luminance = 1000;

/// Steps over the visible range; each sample stands for 1 nm, half of it at the ends.
template <class Function>
void over_visible_range(Function function) {
  for (double l = shortest_visible_nm; l <= longest_visible_nm; ++l)
    function(l, l == shortest_visible_nm || l == longest_visible_nm ? 0.5 : 1.0);
}

/// The weights w that make sum w_i f_i the polyline through (wavelengths, f) at `l`, constant
/// beyond.
struct Hats {
  std::vector<std::size_t> order;  ///< ascending in wavelength
  std::vector<double> ascending_nm;

  explicit Hats(const std::vector<double>& wavelengths_nm) : order(wavelengths_nm.size()) {
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t w) { return wavelengths_nm[w]; });
    for (std::size_t w : order) ascending_nm.push_back(wavelengths_nm[w]);
  }
  template <class Function>
  void at(double l, Function function) const {
    const auto above = static_cast<std::size_t>(std::ranges::upper_bound(ascending_nm, l) -
                                                ascending_nm.begin());
    if (above == 0) return function(order.front(), 1.0);
    if (above == order.size()) return function(order.back(), 1.0);
    const double t =
        (l - ascending_nm[above - 1]) / (ascending_nm[above] - ascending_nm[above - 1]);
    function(order[above - 1], 1 - t);
    function(order[above], t);
  }
};

/// XYZ in units of white_luminance of a light of unit radiance over irradiance at one
/// wavelength and 0 at all others, interpolated as the contract says.
std::array<std::vector<double>, 3> colour_weights(const Scene& scene,
                                                  const std::vector<double>& wavelengths_nm) {
  std::array<std::vector<double>, 3> xyz;
  xyz.fill(std::vector<double>(wavelengths_nm.size(), 0.0));
  const Hats hats(wavelengths_nm);
  over_visible_range([&](double l, double width_nm) {
    const double light = luminous_efficacy / white_luminance * width_nm *
                         sunlight(scene.sun, scene.spectrum.wavelengths_nm, l);
    const Triple matching = colour_matching(l);
    hats.at(l, [&](std::size_t w, double weight) {
      for (std::size_t c = 0; c < 3; ++c) xyz[c][w] += light * weight * matching[c];
    });
  });
  return xyz;
}

Triple blackbody_xyz(double kelvin) {
  Triple xyz{};
  over_visible_range([&](double l, double width_nm) {
    const Triple matching = colour_matching(l);
    for (std::size_t c = 0; c < 3; ++c) xyz[c] += width_nm * planck(kelvin, l) * matching[c];
  });
  return xyz;
}

std::array<std::vector<double>, 3> times(const Matrix& m,
                                         const std::array<std::vector<double>, 3>& columns) {
  auto product = columns;
  for (std::size_t w = 0; w < columns[0].size(); ++w) {
    const Triple v = m * Triple{columns[0][w], columns[1][w], columns[2][w]};
    for (std::size_t c = 0; c < 3; ++c) product[c][w] = v[c];
  }
  return product;
}

Triple total(const std::array<std::vector<double>, 3>& weights) {
  Triple sum;
  for (std::size_t c = 0; c < 3; ++c)
    sum[c] = std::accumulate(weights[c].begin(), weights[c].end(), 0.0);
  return sum;
}

Matrix white_balance(const WhitePoint& white, const Triple& sunlight_xyz) {
  try {
    if (white.kind == WhitePoint::Kind::sun) return adaptation_to_d65(sunlight_xyz);
    if (white.kind == WhitePoint::Kind::kelvin)
      return adaptation_to_d65(blackbody_xyz(white.kelvin));
  } catch (const std::domain_error&) {
    const bool sun = white.kind == WhitePoint::Kind::sun;
    throw SceneError("/image/white", sun ? "\"sun\"" : nlohmann::json(white.kelvin).dump(),
                     "\"d65\", or a light that all of the eye's cones respond to",
                     "a picture cannot be adapted to this light");
  }
  return Output{}.white_balance;
}

}  // namespace

Problem make_problem(const Scene& scene, const std::vector<double>& wavelengths_nm) {
  Problem problem;
  problem.planet_radius_km = scene.planet.radius_km;
  problem.thickness_km = scene.atmosphere.thickness_km;
  problem.wavelengths_nm = wavelengths_nm;
  problem.ground_albedo =
      evaluate(scene.planet.ground_albedo, scene.spectrum.wavelengths_nm, wavelengths_nm);
  problem.media = make_media(scene, wavelengths_nm);
  problem.sun_direction = direction_to(scene.sun);
  problem.sun_distance_km = scene.sun.distance_km.value_or(0);
  problem.sun_angular_radius_rad = scene.sun.angular_diameter_deg / 2 * degree;
  problem.sun_disc_samples = scene.sun.disc_samples;
  problem.solar_distance_au = scene.sun.solar_distance_au;
  for (double l : wavelengths_nm)
    problem.limb_darkening_exponent.push_back(
        scene.sun.limb_darkening ? limb_darkening_exponent(l) : 0);
  problem.camera = scene.camera;
  if ((problem.ground = make_ground(scene, wavelengths_nm))) {
    check_relief(scene, *problem.ground);
    problem.ground_albedo = mean_albedo(*problem.ground);
    problem.camera.altitude_km += height_at_foot_km(*problem.ground, problem.planet_radius_km);
  }
  problem.width = scene.image.width;
  problem.height = scene.image.height;
  problem.show = scene.image.show;
  problem.scattering_orders = scene.method.scattering_orders.value_or(-1);
  return problem;
}

Output make_output(const Scene& scene, const std::vector<double>& wavelengths_nm) {
  Output output;
  output.white_luminance = white_luminance;
  for (double l : wavelengths_nm)
    output.irradiance.push_back(sunlight(scene.sun, scene.spectrum.wavelengths_nm, l));
  Triple sunlight_xyz;
  if (scene.spectrum.colour == Colour::cie) {
    output.xyz = colour_weights(scene, wavelengths_nm);
    output.rgb = times(rec709_from_xyz(), output.xyz);
    sunlight_xyz = total(output.xyz);
    output.white_card = sunlight_xyz[1] / std::numbers::pi;
  } else {
    output.rgb.fill(std::vector<double>(wavelengths_nm.size(), 0.0));
    for (std::size_t c = 0; c < std::min<std::size_t>(3, wavelengths_nm.size()); ++c)
      output.rgb[c][c] = output.irradiance[c];
    output.xyz = output.rgb;
    const Triple light = total(output.rgb);
    sunlight_xyz = xyz_from_rec709() * light;
    output.white_card = (light[0] + light[1] + light[2]) / 3 / std::numbers::pi;
  }
  if (!(output.white_card > 0)) output.white_card = 1;  // all is black, at any exposure
  output.white_balance = white_balance(scene.image.white, sunlight_xyz);
  return output;
}

Problem at_wavelengths(const Problem& problem, std::size_t first, std::size_t count) {
  Problem part = problem;
  auto keep = [&](auto& by_wavelength) {
    auto begin = by_wavelength.begin() + static_cast<std::ptrdiff_t>(first);
    by_wavelength = {begin, begin + static_cast<std::ptrdiff_t>(count)};
  };
  keep(part.wavelengths_nm);
  keep(part.ground_albedo);
  if (part.ground) std::ranges::for_each(part.ground->albedo, keep);
  keep(part.limb_darkening_exponent);
  for (Medium& medium : part.media) {
    keep(medium.scattering_per_km);
    keep(medium.absorption_per_km);
    if (auto* rayleigh = std::get_if<RayleighPhase>(&medium.phase)) keep(rayleigh->gamma);
    if (auto* table = std::get_if<TabulatedPhase>(&medium.phase)) keep(table->values);
  }
  return part;
}

double largest_depth(const Problem& problem) {
  double largest = 0;
  for (std::size_t w = 0; w < problem.wavelengths_nm.size(); ++w) {
    double depth = 0;
    for (const Medium& medium : problem.media) {
      depth += (medium.scattering_per_km[w] + medium.absorption_per_km[w]) *
               column_km(medium.profile, problem.thickness_km);
    }
    largest = std::max(largest, depth);
  }
  return largest;
}

}  // namespace cyanometer
