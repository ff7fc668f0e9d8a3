#include "engine/physics/curves.h"

#include <algorithm>
#include <cmath>

#include "engine/optics/profile.h"
#include "engine/optics/visibility.h"
#include "engine/physics/pack.h"
#include "engine/problem.h"

namespace cyanometer {
namespace {

using P = Physics<double>;

std::vector<double> evenly(double from, double to, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(std::lerp(from, to, i / (count - 1.0)));
  return values;
}

/// Steps that grow with the angle: forward peaks are narrow.
std::vector<double> angles_deg() {
  constexpr int count = 121;
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(180 * std::pow(i / (count - 1.0), 1.5));
  return values;
}

std::vector<double> wavelengths_of(const Scene& scene) {
  return scene.spectrum.wavelengths_nm.empty() ? evenly(380, 730, 36)
                                               : scene.spectrum.wavelengths_nm;
}

std::size_t nearest(const std::vector<double>& values, double wanted) {
  const auto found = std::ranges::min_element(
      values, {}, [wanted](double value) { return std::abs(value - wanted); });
  return static_cast<std::size_t>(found - values.begin());
}

std::vector<std::size_t> phase_indices(const std::vector<double>& wavelengths_nm) {
  std::vector<std::size_t> indices;
  for (const double wanted : {440.0, 550.0, 680.0}) {
    const std::size_t index = nearest(wavelengths_nm, wanted);
    if (std::ranges::find(indices, index) == indices.end()) indices.push_back(index);
  }
  return indices;
}

P::ScatteringAngle at_angle(double degrees) {
  const double half = glm::radians(degrees) / 2;
  return {std::cos(2 * half), 2 * std::sin(half) * std::sin(half),
          2 * std::cos(half) * std::cos(half)};
}

/// The value of wavelength `w` in groups of four that begin at `first`.
template <class Groups>
double lane(const Groups& groups, std::size_t first, std::size_t w) {
  return groups[first + w / 4][static_cast<int>(w % 4)];
}

void add_optical_depth(const Medium& medium, double thickness_km, ConstituentCurves& curves) {
  const double column = column_km(medium.profile, thickness_km);
  for (std::size_t w = 0; w < medium.scattering_per_km.size(); ++w) {
    curves.optical_depth.push_back(column *
                                   (medium.scattering_per_km[w] + medium.absorption_per_km[w]));
  }
}

void add_visibility(const std::vector<double>& wavelengths_nm, ConstituentCurves& curves) {
  const std::size_t w = nearest(wavelengths_nm, visibility_at_nm);
  const double extinction = curves.scattering_per_km[w] + curves.absorption_per_km[w];
  if (extinction > 0) curves.visibility_km = visibility_optical_depth / extinction;
}

/// The phase functions of all constituents out of what they scatter towards each angle.
void add_phases(P& physics, const std::vector<std::size_t>& indices, Curves& curves) {
  const auto media = static_cast<std::size_t>(physics.MEDIA);
  for (std::size_t c = 0; c < media; ++c) {
    auto& each = curves.constituents[c];
    if (std::ranges::max(each.scattering_per_km) > 0) {
      each.phase.assign(indices.size(), {});
    }
  }
  P::Vec4 towards[P::MEDIA_GROUPS_SIZE];
  for (const double angle : curves.angle_deg) {
    physics.scattering_towards(at_angle(angle), towards);
    for (std::size_t c = 0; c < media; ++c) {
      auto& each = curves.constituents[c];
      for (std::size_t i = 0; i < each.phase.size(); ++i) {
        const double scattered = each.scattering_per_km[indices[i]];
        const double there = lane(towards, c * P::GROUPS_SIZE, indices[i]);
        each.phase[i].push_back(scattered > 0 ? there / scattered : 0);
      }
    }
  }
}

}  // namespace

Curves constituent_curves(const Scene& scene) {
  const Problem problem = make_problem(scene, wavelengths_of(scene));
  Curves curves;
  curves.altitude_km = evenly(0, problem.thickness_km, 201);
  curves.wavelengths_nm = problem.wavelengths_nm;
  curves.angle_deg = angles_deg();
  const auto indices = phase_indices(curves.wavelengths_nm);
  for (const std::size_t i : indices) {
    curves.phase_wavelengths_nm.push_back(curves.wavelengths_nm[i]);
  }
  auto physics = pack<double>(problem);
  const auto media = packed_media(problem);
  for (std::size_t c = 0; c < media.size(); ++c) {
    ConstituentCurves each;
    each.name = media[c]->name;
    each.scattering_per_km = media[c]->scattering_per_km;
    each.absorption_per_km = media[c]->absorption_per_km;
    for (const double altitude : curves.altitude_km) {
      each.density.push_back(physics.relative_density(altitude, static_cast<int>(c)));
    }
    add_optical_depth(*media[c], problem.thickness_km, each);
    add_visibility(curves.wavelengths_nm, each);
    curves.constituents.push_back(std::move(each));
  }
  add_phases(physics, indices, curves);
  return curves;
}

}  // namespace cyanometer
