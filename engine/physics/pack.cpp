#include "engine/physics/pack.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/gauss_legendre.h"
#include "engine/optics/profile.h"
#include "engine/physics/kinks.h"
#include "engine/surface/pack_ground.h"

namespace cyanometer {
namespace {

/// The value of lane `w` of wavelength group after group; `fill` beyond the last wavelength.
template <class Real>
void append_groups(std::vector<glm::vec<4, Real>>& out, const std::vector<double>& values,
                   double fill = 0) {
  for (std::size_t first = 0; first < values.size(); first += 4) {
    glm::vec<4, Real> group(static_cast<Real>(fill));
    for (int lane = 0; lane < 4 && first + lane < values.size(); ++lane) {
      group[lane] = static_cast<Real>(values[first + lane]);
    }
    out.push_back(group);
  }
}

template <class Real>
void append_profile_nodes(Physics<Real>& p, const TableProfile& table) {
  auto node = [&](double altitude, double density, double linear, double logarithmic) {
    p.profile_nodes.emplace_back(altitude, density, linear, logarithmic);
  };
  const auto& h = table.altitude_km;
  const auto& d = table.density;
  node(h.front() - 1, d.front(), 0, 0);
  for (std::size_t i = 0; i + 1 < h.size(); ++i) {
    double width = h[i + 1] - h[i];
    if (d[i] > 0 && d[i + 1] > 0) {
      node(h[i], d[i], 0, std::log(d[i + 1] / d[i]) / width);
    } else {
      node(h[i], d[i], (d[i + 1] - d[i]) / width, 0);
    }
  }
  node(h.back(), 0, 0, 0);
}

template <class Real>
void append_phase_nodes(Physics<Real>& p, const TabulatedPhase& table) {
  std::vector<double> at_angle(table.values.size());
  for (std::size_t a = 0; a < table.angle_rad.size(); ++a) {
    p.phase_angles.push_back(static_cast<Real>(table.angle_rad[a]));
    for (std::size_t w = 0; w < at_angle.size(); ++w) at_angle[w] = table.values[w][a];
    append_groups(p.phase_values, at_angle);
  }
}

template <class Real>
void set_phase(Physics<Real>& p, typename Physics<Real>::MediumData& data,
               const PhaseFunction& phase) {
  using P = Physics<Real>;
  if (std::holds_alternative<RayleighPhase>(phase)) data.phase = P::PHASE_RAYLEIGH;
  if (auto* hg = std::get_if<HenyeyGreenstein>(&phase)) {
    data.phase = P::PHASE_HENYEY_GREENSTEIN;
    data.g = static_cast<Real>(hg->g);
  }
  if (auto* cs = std::get_if<CornetteShanks>(&phase)) {
    data.phase = P::PHASE_CORNETTE_SHANKS;
    data.g = static_cast<Real>(cs->g);
  }
  if (auto* table = std::get_if<TabulatedPhase>(&phase)) {
    data.phase = P::PHASE_TABLE;
    data.phase_node = static_cast<int>(p.phase_angles.size());
    data.phase_nodes = static_cast<int>(table->angle_rad.size());
    append_phase_nodes(p, *table);
  }
}

template <class Real>
void set_profile(Physics<Real>& p, typename Physics<Real>::MediumData& data,
                 const Profile& profile, double thickness_km) {
  if (auto* exponential = std::get_if<ExponentialProfile>(&profile)) {
    data.a = static_cast<Real>(1 / exponential->scale_height_km);
    ++p.EXPONENTIALS;
  } else if (auto* tent = std::get_if<TentProfile>(&profile)) {
    data.a = static_cast<Real>(tent->centre_km);
    data.b = static_cast<Real>(1 / tent->half_width_km);
    ++p.TENTS;
  } else if (std::holds_alternative<QuadraticProfile>(profile)) {
    data.a = static_cast<Real>(1 / thickness_km);
    ++p.QUADRATICS;
  } else if (std::holds_alternative<UniformProfile>(profile)) {
    ++p.UNIFORMS;
  } else {
    data.profile_node = static_cast<int>(p.profile_nodes.size());
    append_profile_nodes(p, std::get<TableProfile>(profile));
    data.profile_nodes = static_cast<int>(p.profile_nodes.size()) - data.profile_node;
    ++p.TABLES;
  }
}

template <class Real>
void append_media(Physics<Real>& p, const Problem& problem) {
  for (const Medium* medium : packed_media(problem)) {
    typename Physics<Real>::MediumData data{};
    set_profile(p, data, medium->profile, problem.thickness_km);
    bool scatters =
        std::any_of(medium->scattering_per_km.begin(), medium->scattering_per_km.end(),
                    [](double s) { return s > 0; });
    std::vector<double> extinction = medium->scattering_per_km;
    std::transform(extinction.begin(), extinction.end(), medium->absorption_per_km.begin(),
                   extinction.begin(), std::plus<>());
    std::vector<double> gamma(extinction.size(), 0.0);
    if (scatters) {
      set_phase(p, data, medium->phase);
      if (auto* rayleigh = std::get_if<RayleighPhase>(&medium->phase)) gamma = rayleigh->gamma;
    }
    append_groups(p.spectra, extinction);
    append_groups(p.spectra, medium->scattering_per_km);
    append_groups(p.spectra, gamma);
    p.media.push_back(data);
  }
  p.MEDIA = static_cast<int>(p.media.size());
}

/// The scale of raymarch's nodes: that of each constituent which scatters, weighted by what it
/// scatters.
double view_scale_km(const Problem& problem) {
  double weights = 0, sum = 0;
  for (const Medium& medium : problem.media) {
    double column = column_km(medium.profile, problem.thickness_km);
    double depth = column * *std::ranges::max_element(medium.scattering_per_km);
    if (depth > 0) sum += depth * std::log(column);
    weights += depth;
  }
  return weights > 0 ? std::exp(sum / weights) : problem.thickness_km;
}

/// Whether a layer that is denser inside than at its edge dims a slanting ray much.
bool has_layers(const Problem& problem) {
  return std::ranges::any_of(problem.media, [&](const Medium& medium) {
    if (std::holds_alternative<ExponentialProfile>(medium.profile)) return false;
    double most = 0;
    for (std::size_t w = 0; w < problem.wavelengths_nm.size(); ++w)
      most = std::max(most, medium.scattering_per_km[w] + medium.absorption_per_km[w]);
    return most * column_km(medium.profile, problem.thickness_km) > 0.1;
  });
}

/// (node, weight) of all rules of up to `most` nodes, one after another.
std::vector<glm::dvec4> gauss_rules(int most) {
  std::vector<glm::dvec4> all;
  for (int nodes = 1; nodes <= most; ++nodes) {
    GaussRule rule = gauss_legendre(nodes);
    for (int i = 0; i < nodes; ++i) all.emplace_back(rule.nodes[i], rule.weights[i], 0, 0);
  }
  return all;
}

template <class Real>
void append_quadrature(Physics<Real>& p, const Problem& problem) {
  static const std::vector<glm::dvec4> rules = gauss_rules(Physics<Real>::MOST_GAUSS_NODES);
  p.quadrature.assign(rules.begin(), rules.end());
  std::vector<double> kinks = profile_kinks_km(problem);
  for (double altitude : kinks) p.quadrature.emplace_back(altitude, 0, 0, 0);
  p.scene.kinks = static_cast<int>(kinks.size());
  p.scene.view_scale_km = static_cast<Real>(view_scale_km(problem));
  p.scene.layers = has_layers(problem) ? 1 : 0;
}

/// The angle that a pixel spans; rays that are given one by one are as wide.
template <class Real>
double pixel_rad(const Physics<Real>& p) {
  Physics<double> camera;
  camera.scene.tan_half_fov = p.scene.tan_half_fov;
  camera.scene.half_fov_rad = p.scene.half_fov_rad;
  camera.scene.width = p.scene.width;
  camera.scene.height = p.scene.height;
  camera.scene.projection = p.scene.projection;
  return camera.pixel_angle();
}

template <class Real>
void set_camera(Physics<Real>& p, const Problem& problem) {
  using Vec4 = typename Physics<Real>::Vec4;
  const Camera& camera = problem.camera;
  double heading = glm::radians(camera.heading_deg), pitch = glm::radians(camera.pitch_deg),
         roll = glm::radians(camera.roll_deg);
  glm::dvec3 forward(std::sin(heading) * std::cos(pitch), std::cos(heading) * std::cos(pitch),
                     std::sin(pitch));
  glm::dvec3 right(std::cos(heading), -std::sin(heading), 0);
  glm::dvec3 up = glm::cross(right, forward);
  // Seen from behind, a camera that turns clockwise lowers its right.
  p.scene.camera_right = Vec4(right * std::cos(roll) - up * std::sin(roll), 0);
  p.scene.camera_up = Vec4(up * std::cos(roll) + right * std::sin(roll), 0);
  p.scene.camera_forward = Vec4(forward, 0);
  p.scene.camera_altitude_km = static_cast<Real>(camera.altitude_km);
  p.scene.half_fov_rad = static_cast<Real>(glm::radians(camera.fov_deg) / 2);
  if (camera.projection == Projection::perspective) {
    p.scene.tan_half_fov = static_cast<Real>(std::tan(glm::radians(camera.fov_deg) / 2));
  }
  p.scene.width = problem.width;
  p.scene.height = problem.height;
  p.scene.projection = static_cast<int>(camera.projection);
  p.scene.pixel_rad = static_cast<Real>(pixel_rad(p));
}

/// What makes the drawn disc send its irradiance, 1/sr: one over the integral of its shape over
/// the projected solid angle, which is the square of the sine times pi.
double disc_scale(double disc_sine, double pixel_rad, double exponent) {
  static const GaussRule rule = gauss_legendre(24);
  Physics<double> p;
  double fade = p.disc_fade(disc_sine, pixel_rad), limb = disc_sine + fade / 2;
  // Over t, the cube root of 1 - (sine / limb)^2: its powers leave no singularity at the limb.
  auto t_at = [&](double sine) {
    return std::cbrt(std::max(1 - std::pow(sine / limb, 2), 0.0));
  };
  double begin = t_at(1), middle = std::max(t_at(std::max(limb - fade, 0.0)), begin), sum = 0;
  for (auto [from, to] : {std::pair{begin, middle}, std::pair{middle, 1.0}}) {
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      double t = from + (to - from) * rule.nodes[i];
      double sine = limb * std::sqrt(1 - t * t * t);
      sum += rule.weights[i] * (to - from) * 3 * t * t *
             p.disc_shape(sine, disc_sine, fade, glm::dvec4(exponent)).x;
    }
  }
  return 1 / (std::numbers::pi * limb * limb * sum);
}

template <class Real>
void append_disc_scale(Physics<Real>& p, const Problem& problem) {
  glm::vec<3, Real> camera(0, 0, p.scene.planet_radius_km + p.scene.camera_altitude_km);
  double disc_sine = p.disc_sine(p.sun_ray(camera, glm::vec<3, Real>(0)));
  std::vector<double> scales;
  for (double exponent : problem.limb_darkening_exponent) {
    scales.push_back(disc_sine > 0 ? disc_scale(disc_sine, p.scene.pixel_rad, exponent) : 0);
  }
  append_groups(p.sun_points, scales);
}

/// Points spread evenly over the disc on Vogel's spiral, each with its share of the light: of
/// the irradiance of a plane that faces the disc's centre.
template <class Real>
void append_sun_points(Physics<Real>& p, const Problem& problem, glm::dvec3 direction) {
  int count = problem.sun_disc_samples;
  const auto& exponents = problem.limb_darkening_exponent;
  glm::dvec3 side = std::abs(direction.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  glm::dvec3 across = glm::normalize(glm::cross(side, direction));
  glm::dvec3 along = glm::cross(direction, across);
  auto radius_squared = [&](int k) { return count > 1 ? (k + 0.5) / count : 0.0; };
  std::vector<double> total(exponents.size(), 0.0);
  for (int k = 0; k < count; ++k) {
    for (std::size_t w = 0; w < total.size(); ++w) {
      total[w] += std::pow(1 - radius_squared(k), exponents[w] / 2);
    }
  }
  for (int k = 0; k < count; ++k) {
    double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
    glm::dvec3 offset = std::sqrt(radius_squared(k)) * (across * std::cos(k * golden_angle) +
                                                        along * std::sin(k * golden_angle));
    p.sun_points.emplace_back(glm::vec<3, Real>(offset), Real(0));
    double facing = std::sqrt(1 - radius_squared(k) * std::pow(p.scene.sun_sin_radius, 2));
    std::vector<double> weight(total.size());
    for (std::size_t w = 0; w < weight.size(); ++w) {
      weight[w] = std::pow(1 - radius_squared(k), exponents[w] / 2) / total[w] / facing;
    }
    append_groups(p.sun_points, weight);
  }
  p.scene.disc_points = count;
  p.MANY_SUNS = count > 1;
}

template <class Real>
void set_sun(Physics<Real>& p, const Problem& problem) {
  using Vec4 = typename Physics<Real>::Vec4;
  glm::dvec3 direction(problem.sun_direction[0], problem.sun_direction[1],
                       problem.sun_direction[2]);
  p.scene.sun_direction = Vec4(direction, 0);
  p.scene.sun_sin_radius = static_cast<Real>(std::sin(problem.sun_angular_radius_rad));
  p.scene.sun_distance_km = static_cast<Real>(problem.sun_distance_km);
  p.NEAR_SUN = problem.sun_distance_km > 0;
  if (p.NEAR_SUN) {
    double radius = problem.planet_radius_km, distance = problem.sun_distance_km;
    double foot =
        -radius * direction.z +
        std::sqrt(distance * distance - radius * radius * (1 - direction.z * direction.z));
    p.scene.sun_position = Vec4(glm::dvec3(0, 0, radius) + foot * direction, 0);
    p.scene.sun_foot_km = static_cast<Real>(foot);
  }
  append_sun_points(p, problem, direction);
  append_disc_scale(p, problem);
}

}  // namespace

std::vector<const Medium*> packed_media(const Problem& problem) {
  std::vector<const Medium*> ordered;
  for (const Medium& medium : problem.media) ordered.push_back(&medium);
  std::stable_sort(ordered.begin(), ordered.end(), [](const Medium* a, const Medium* b) {
    return a->profile.index() < b->profile.index();
  });
  return ordered;
}

template <class Real>
Physics<Real> pack(const Problem& problem) {
  Physics<Real> p;
  p.GROUPS = static_cast<int>((problem.wavelengths_nm.size() + 3) / 4);
  p.scene.planet_radius_km = static_cast<Real>(problem.planet_radius_km);
  p.scene.thickness_km = static_cast<Real>(problem.thickness_km);
  append_groups(p.spectra, problem.ground_albedo);
  append_groups(p.spectra, problem.limb_darkening_exponent);
  append_media(p, problem);
  append_quadrature(p, problem);
  set_camera(p, problem);
  if (problem.ground) {
    p.scene.surface = p.SURFACE_KIND = problem.ground->kind;
    p.surface_values = packed_ground<Real>(*problem.ground);
    if (problem.ground->images) p.surface_texels = problem.ground->images->texels;
  }
  p.scene.ends = static_cast<int>(p.ends_km.size());
  set_sun(p, problem);
  return p;
}

template <class Real>
void set_directions(Physics<Real>& physics, const std::vector<glm::dvec3>& directions) {
  physics.directions.clear();
  for (const glm::dvec3& d : directions) {
    physics.directions.emplace_back(glm::vec<3, Real>(d), Real(0));
  }
  physics.scene.projection = Physics<Real>::PROJECTION_LIST;
}

std::vector<std::uint32_t> specialization(const Physics<float>& p) {
  auto bits = [](int value) { return static_cast<std::uint32_t>(value); };
  return {bits(p.EXPONENTIALS), bits(p.TENTS),
          bits(p.QUADRATICS),   bits(p.UNIFORMS),
          bits(p.TABLES),       bits(std::max(p.MEDIA, 1)),
          bits(p.GROUPS),       bits(p.scene.projection),
          bits(p.NEAR_SUN),     bits(p.MANY_SUNS)};
}

template Physics<float> pack<float>(const Problem&);
template Physics<double> pack<double>(const Problem&);
template void set_directions<float>(Physics<float>&, const std::vector<glm::dvec3>&);
template void set_directions<double>(Physics<double>&, const std::vector<glm::dvec3>&);

}  // namespace cyanometer
