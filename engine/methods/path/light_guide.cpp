#include "engine/methods/path/light_guide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include "engine/gauss_legendre.h"
#include "engine/methods/moments/phase_series.h"

namespace cyanometer {
namespace {

using P = Physics<double>;

/// Of the brightest place's: what is less counts as this.
constexpr double least_light = 1e-7;

using SkyLight = std::vector<double>;  ///< irradiance from each cell on a small sphere

double total(const SkyLight& sky) {
  double sum = 0;
  for (double cell : sky) sum += cell;
  return sum;
}

/// Up to three wavelengths (lanes) from those of the smallest to those of the largest vertical
/// depth, of those that scatter at all.
std::vector<int> typical_lanes(P& p) {
  double column[P::MEDIA_SIZE];
  p.columns_to_top(0, 1, column);
  std::vector<std::pair<double, int>> depths;
  for (int lane = 0; lane < 4 * p.GROUPS; ++lane) {
    double depth = 0, scattered = 0;
    for (int c = 0; c < p.MEDIA; ++c) {
      depth += column[c] * p.extinction(c, lane / 4)[lane % 4];
      scattered += column[c] * p.scattering(c, lane / 4)[lane % 4];
    }
    if (scattered > 0) depths.emplace_back(depth, lane);
  }
  std::sort(depths.begin(), depths.end());
  std::vector<int> lanes;
  std::size_t count = std::min<std::size_t>(depths.size(), 3);
  for (std::size_t i = 0; i < count; ++i) {
    lanes.push_back(
        depths[i * (depths.size() - 1) / std::max<std::size_t>(count - 1, 1)].second);
  }
  return lanes;
}

/// Middles of the cells: the inverses of altitude_coordinate and sun_coordinate.
double altitude_of(P& p, int i, int count) {
  double x = (i + 0.5) / count;
  return x * x * p.scene.thickness_km;
}

double sun_of(P& p, int j, int count) {
  double dip = std::sqrt(p.squared_height(p.scene.thickness_km)) /
               (p.scene.planet_radius_km + p.scene.thickness_km);
  double lowest = std::asinh(-4.0), highest = std::asinh(2 / dip + 0.5);
  double y = lowest + (highest - lowest) * (j + 0.5) / count;
  return std::min((std::sinh(y) - 0.5) * dip / 2, 1.0);
}

using ByMedium = std::array<double, P::MEDIA_SIZE>;

/// A node on a ray, or the ground at its end.
struct Node {
  double altitude_km, distance_km;
  double length_km;  ///< that it stands for
  bool ground;
  ByMedium density, column;  ///< there, and from the ray's start to there
};

/// Rays from a grid of altitudes, and what they pass: the same at every wavelength.
class Views {
 public:
  explicit Views(P& physics) : p_(physics) {
    for (int i = 0; i < P::LIGHT_ALTITUDES * P::LIGHT_SUNS; ++i) add_sunbeam(i);
    for (int i = 0; i < P::SKY_ALTITUDES; ++i) {
      double h = altitude_of(p_, i, P::SKY_ALTITUDES);
      for (int row = 0; row < P::SKY_ELEVATIONS; ++row) {
        double mu = p_.sky_cosine(2 * (row + 0.5) / P::SKY_ELEVATIONS - 1);
        nodes_.push_back(nodes_along(h, mu));
        for (int j = 0; j < P::SKY_SUNS; ++j) look_up(h, mu, sun_of(p_, j, P::SKY_SUNS));
      }
    }
  }

  /// By altitude and sun, the column that sunlight has passed where it arrives.
  const std::vector<std::optional<ByMedium>>& sunbeams() const { return sunbeams_; }
  /// By altitude and elevation.
  const std::vector<std::vector<Node>>& nodes() const { return nodes_; }
  /// By altitude, elevation, sun, azimuth and node, where its light stands.
  const std::vector<std::uint16_t>& places() const { return places_; }

 private:
  void add_sunbeam(int i) {
    double h = altitude_of(p_, i / P::LIGHT_SUNS, P::LIGHT_ALTITUDES),
           mu_sun = sun_of(p_, i % P::LIGHT_SUNS, P::LIGHT_SUNS);
    sunbeams_.emplace_back();
    if (p_.meets_ground(h, mu_sun)) return;
    double column[P::MEDIA_SIZE] = {};
    p_.columns_to_top(h, mu_sun, column);
    sunbeams_.back() = std::to_array(column);
  }

  std::vector<Node> nodes_along(double h, double mu) {
    static const GaussRule rule = gauss_legendre(12);
    P::Leg leg = p_.leg_from(h, mu, P::ENDLESS);
    std::vector<Node> nodes;
    for (bool back : {true, false}) {
      P::Stretch stretch = p_.stretch_of(leg, back);
      if (stretch.length_km <= 0) continue;
      for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
        double d = p_.stretched_distance(stretch, rule.nodes[k]);
        nodes.push_back(node(h, mu, back ? leg.back_km - d : leg.back_km + d,
                             p_.altitude_after(leg.low_h, stretch.mu, d)));
        nodes.back().length_km = rule.weights[k] * p_.stretched_rate(stretch, rule.nodes[k]);
      }
    }
    if (leg.meets_ground) {
      nodes.push_back(node(h, mu, leg.back_km + leg.on_km, 0));
      nodes.back().ground = true;
    }
    return nodes;
  }

  Node node(double h, double mu, double distance_km, double altitude_km) {
    double column[P::MEDIA_SIZE] = {}, density[P::MEDIA_SIZE] = {};
    p_.columns_along(h, mu, distance_km, column);
    p_.densities(altitude_km, density);
    return {altitude_km, distance_km, 0, false, std::to_array(density), std::to_array(column)};
  }

  void look_up(double h, double mu, double mu_sun) {
    double radius = p_.scene.planet_radius_km;
    for (int column = 0; column < P::SKY_AZIMUTHS; ++column) {
      double s = (column + 0.5) / P::SKY_AZIMUTHS;
      double nu =
          mu * mu_sun + std::sqrt((1 - mu * mu) * (1 - mu_sun * mu_sun)) * (1 - 2 * s * s);
      for (const Node& node : nodes_.back()) {
        double there =
            ((radius + h) * mu_sun + node.distance_km * nu) / (radius + node.altitude_km);
        places_.push_back(static_cast<std::uint16_t>(p_.light_place(node.altitude_km, there)));
      }
    }
  }

  P& p_;
  std::vector<std::optional<ByMedium>> sunbeams_;
  std::vector<std::vector<Node>> nodes_;
  std::vector<std::uint16_t> places_;
};

/// Means of the cosine of the angle by which the constituents scatter, at one wavelength; those
/// that scatter more to the back count as isotropic.
std::vector<double> mean_cosines(const Problem& problem, int lane) {
  std::vector<double> means;
  std::size_t wavelengths = problem.wavelengths_nm.size();
  for (const Medium* medium : packed_media(problem)) {
    auto chi = legendre_coefficients(medium->phase, wavelengths, 1);
    means.push_back(std::clamp(chi[lane][1], 0.0, 1.0));
  }
  return means;
}

/// The scattering of a shell lit from outside, order by order and at one wavelength: enough to
/// tell where light is. Phases are isotropic, of so much less scattering as carries light as
/// far [similarity: van de Hulst 1980, Multiple Light Scattering, section 14.1].
class Lighting {
 public:
  Lighting(P& physics, const Problem& problem, const Views& views, int lane)
      : p_(physics), views_(views) {
    const std::vector<double> forward = mean_cosines(problem, lane);
    for (int c = 0; c < p_.MEDIA; ++c) {
      double scattering = p_.scattering(c, lane / 4)[lane % 4];
      extinction_.push_back(p_.extinction(c, lane / 4)[lane % 4] - forward[c] * scattering);
      scattering_.push_back((1 - forward[c]) * scattering);
    }
    for (const auto& sunbeam : views_.sunbeams())
      sunlight_.push_back(sunbeam ? transmittance(*sunbeam) : 0);
    for (const auto& nodes : views_.nodes()) {
      for (const Node& node : nodes)
        weights_.push_back(weight(node, p_.ground_albedo(lane / 4)[lane % 4]));
    }
    light_ = sunlight_;
    sky_.assign(P::SKY_ALTITUDES * P::SKY_SUNS, SkyLight(P::SKY_CELLS, 0.0));
    constexpr int most_orders = 32;
    for (int order = 0; order < most_orders; ++order) {
      look_around();
      if (add_skylight() < 0.1) break;
    }
  }

  /// By altitude and sun, what scatters there.
  const std::vector<double>& light() const { return light_; }
  /// By altitude and sun, what arrives there by scattering.
  const std::vector<SkyLight>& sky() const { return sky_; }

 private:
  double transmittance(const ByMedium& column) const {
    double depth = 0;
    for (int c = 0; c < p_.MEDIA; ++c) depth += extinction_[c] * column[c];
    return std::exp(-depth);
  }

  /// What a node adds to its ray's light for each unit of light at it.
  double weight(const Node& node, double ground_albedo) const {
    double scattered = 0;
    for (int c = 0; c < p_.MEDIA; ++c) scattered += scattering_[c] * node.density[c];
    return (node.ground ? ground_albedo : node.length_km * scattered) *
           transmittance(node.column);
  }

  /// The sky of every place, from the light of all others.
  void look_around() {
    const double* weight = weights_.data();
    const std::uint16_t* place = views_.places().data();
    for (int view = 0; view < P::SKY_ALTITUDES * P::SKY_ELEVATIONS; ++view) {
      int i = view / P::SKY_ELEVATIONS, row = view % P::SKY_ELEVATIONS;
      double mu = p_.sky_cosine(2 * (row + 0.5) / P::SKY_ELEVATIONS - 1);
      std::size_t nodes = views_.nodes()[view].size();
      for (int cell = 0; cell < P::SKY_SUNS * P::SKY_AZIMUTHS; ++cell, place += nodes) {
        int j = cell / P::SKY_AZIMUTHS, column = cell % P::SKY_AZIMUTHS;
        double radiance = 0;
        for (std::size_t k = 0; k < nodes; ++k) radiance += weight[k] * light_[place[k]];
        double solid_angle =
            2.0 / P::SKY_CELLS / p_.sky_density(mu, (column + 0.5) / P::SKY_AZIMUTHS);
        sky_[i * P::SKY_SUNS + j][row * P::SKY_AZIMUTHS + column] =
            radiance * solid_angle / (4 * std::numbers::pi);
      }
      weight += nodes;
    }
  }

  /// @returns the largest part that is new of the light of a place
  double add_skylight() {
    double newest = 0, most = *std::max_element(light_.begin(), light_.end());
    for (int i = 0; i < P::LIGHT_ALTITUDES * P::LIGHT_SUNS; ++i) {
      double h = altitude_of(p_, i / P::LIGHT_SUNS, P::LIGHT_ALTITUDES),
             mu_sun = sun_of(p_, i % P::LIGHT_SUNS, P::LIGHT_SUNS);
      double light = sunlight_[i] + total(sky_[p_.sky_place(h, mu_sun)]);
      if (light > least_light * most) newest = std::max(newest, 1 - light_[i] / light);
      light_[i] = light;
    }
    return newest;
  }

  P& p_;
  const Views& views_;
  std::vector<double> extinction_, scattering_;
  std::vector<double> weights_;  ///< by altitude, elevation and node
  std::vector<double> sunlight_, light_;
  std::vector<SkyLight> sky_;
};

/// Where the estimate knows of no light, walks still look.
void append_light(std::vector<double>& guide, const std::vector<double>& light) {
  double most = *std::max_element(light.begin(), light.end());
  for (double value : light) guide.push_back(std::max(value, least_light * most));
}

void append_sky(std::vector<double>& guide, const std::vector<SkyLight>& skies) {
  std::vector<double> light;
  for (const SkyLight& sky : skies) light.push_back(total(sky));
  append_light(guide, light);
  for (const SkyLight& sky : skies) {
    double sum = 0, all = std::max(total(sky), 1e-300);
    for (double cell : sky) {
      guide.push_back(sum / all);
      sum += cell;
    }
    guide.push_back(1.0);
  }
}

}  // namespace

void append_light_guide(Physics<double>& physics, const Problem& problem) {
  std::vector<double> light(P::LIGHT_ALTITUDES * P::LIGHT_SUNS, 0.0);
  std::vector<SkyLight> sky(P::SKY_ALTITUDES * P::SKY_SUNS, SkyLight(P::SKY_CELLS, 0.0));
  const Views views(physics);
  for (int lane : typical_lanes(physics)) {
    Lighting lighting(physics, problem, views, lane);
    for (std::size_t i = 0; i < light.size(); ++i) light[i] += lighting.light()[i];
    for (std::size_t i = 0; i < sky.size(); ++i) {
      for (std::size_t k = 0; k < sky[i].size(); ++k) sky[i][k] += lighting.sky()[i][k];
    }
  }
  append_light(physics.path_guide, light);
  append_sky(physics.path_guide, sky);
  physics.GUIDED = true;
}

bool needs_light_guide(const Problem& problem) {
  // The lowest sun over all that the camera can see of the lower air.
  double radius = problem.planet_radius_km, lower_air = problem.thickness_km / 20;
  double away = std::acos(radius / (radius + problem.camera.altitude_km)) +
                std::acos(radius / (radius + lower_air));
  constexpr double low = 0.12;  // radians
  return std::asin(std::clamp(problem.sun_direction[2], -1.0, 1.0)) - away < low;
}

}  // namespace cyanometer
