#include "engine/optics/profile.h"

#include <algorithm>
#include <cmath>

namespace cyanometer {
namespace {

/// The integral over `length` of a density that goes from `a` to `b`, linear in its logarithm,
/// or linear where one of them is 0.
double segment(double a, double b, double length) {
  if (a <= 0 || b <= 0) return 0.5 * (a + b) * length;
  const double log_ratio = std::log(b / a);
  return a * length * (log_ratio == 0 ? 1 : std::expm1(log_ratio) / log_ratio);
}

double between(double a, double b, double t) {
  return a <= 0 || b <= 0 ? std::lerp(a, b, t) : a * std::pow(b / a, t);
}

struct Column {
  double top_km;

  double operator()(const ExponentialProfile& p) const {
    return -p.scale_height_km * std::expm1(-top_km / p.scale_height_km);
  }
  double operator()(const TentProfile& p) const {
    // Each flank rises linearly from the tent's edge to its middle.
    const auto flank = [&](double far_from_centre_km, double near_centre_km) {
      const auto height = [&](double d) { return std::max(0.0, 1 - d / p.half_width_km); };
      const double d = std::min(far_from_centre_km, p.half_width_km);
      return near_centre_km >= d
                 ? 0
                 : 0.5 * (height(d) + height(near_centre_km)) * (d - near_centre_km);
    };
    return flank(p.centre_km, std::max(0.0, p.centre_km - top_km)) +
           flank(top_km - p.centre_km, std::max(0.0, -p.centre_km));
  }
  double operator()(const QuadraticProfile&) const { return top_km / 3; }
  double operator()(const UniformProfile&) const { return top_km; }
  double operator()(const TableProfile& p) const {
    const double maximum = std::ranges::max(p.density);
    if (maximum <= 0) return 0;
    const auto& h = p.altitude_km;
    double sum = p.density.front() * std::clamp(h.front(), 0.0, top_km);
    for (std::size_t i = 1; i < h.size(); ++i) {
      const double low = std::clamp(h[i - 1], 0.0, top_km),
                   high = std::clamp(h[i], 0.0, top_km);
      if (high <= low) continue;
      const auto density = [&](double altitude) {
        return between(p.density[i - 1], p.density[i],
                       (altitude - h[i - 1]) / (h[i] - h[i - 1]));
      };
      sum += segment(density(low), density(high), high - low);
    }
    return sum / maximum;
  }
};

}  // namespace

Profile normalised(Profile profile) {
  if (auto* table = std::get_if<TableProfile>(&profile)) {
    const double maximum = std::ranges::max(table->density);
    if (maximum > 0)
      for (double& density : table->density) density /= maximum;
  }
  return profile;
}

double column_km(const Profile& profile, double thickness_km) {
  return std::visit(Column{thickness_km}, profile);
}

}  // namespace cyanometer
