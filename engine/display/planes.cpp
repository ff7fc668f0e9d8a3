#include "engine/display/planes.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "engine/optics/colour.h"

namespace cyanometer {
namespace {

enum Quantity { inscatter = 1, ground = 2, sun = 4, transmittance = 8 };

void set_weights(PlaneGroup& group, int quantities, std::size_t planes) {
  for (std::size_t k = 0; k < planes; ++k) {
    group.inscatter[k] = quantities & inscatter ? 1.f : 0.f;
    group.ground[k] = quantities & ground ? 1.f : 0.f;
    group.sun[k] = quantities & sun ? 1.f : 0.f;
    group.transmittance[k] = quantities & transmittance ? 1.f : 0.f;
  }
}

/// What an image shows of the light that there is.
int shown(const Problem& problem) {
  int quantities = 0;
  if (problem.scattering_orders != 0) {
    quantities |= inscatter | (problem.show.ground ? ground : 0);
  }
  if (problem.show.sun) quantities |= sun;
  return quantities;
}

/// With the fewest digits that tell it from all others, and a comma where a number has a dot:
/// in the names of an EXR a dot ends that of a layer [Fichet et al. 2021, An OpenEXR Layout for
/// Spectral Images].
std::string wavelength_name(double nm) {
  std::array<char, 32> digits;
  char* end = std::to_chars(digits.data(), digits.data() + digits.size(), nm).ptr;
  std::replace(digits.data(), end, '.', ',');
  return std::string(digits.data(), end) + "nm";
}

/// Over its sum; none where that is a small difference of large numbers, which would make
/// transmittances of more than 1 and less than 0.
std::optional<std::vector<double>> normalised(std::vector<double> row) {
  constexpr double least_share = 0.3;
  double sum = 0, sizes = 0;
  for (double x : row) {
    sum += x;
    sizes += std::abs(x);
  }
  if (!(sum > least_share * sizes)) return std::nullopt;
  for (double& x : row) x /= sum;
  return row;
}

PlaneGroup rgb_group(const std::array<std::vector<double>, 3>& rows, int quantities,
                     const std::string& prefix) {
  PlaneGroup group;
  for (std::size_t c = 0; c < 3; ++c) {
    group.channels.push_back(prefix + "RGB"[c]);
    group.rows[c] = rows[c];
  }
  set_weights(group, quantities, 3);
  return group;
}

std::vector<PlaneGroup> spectral_groups(const Problem& problem, const Output& output,
                                        int quantities, const std::string& prefix) {
  std::vector<PlaneGroup> groups;
  std::size_t count = problem.wavelengths_nm.size();
  for (std::size_t first = 0; first < count; first += 4) {
    PlaneGroup& group = groups.emplace_back();
    for (std::size_t w = first; w < std::min(first + 4, count); ++w) {
      std::vector<double>& row = group.rows[w - first];
      row.assign(count, 0.0);
      row[w] = quantities & transmittance ? 1 : output.irradiance[w];
      group.channels.push_back(prefix + wavelength_name(problem.wavelengths_nm[w]));
    }
    set_weights(group, quantities, group.channels.size());
  }
  return groups;
}

PlaneGroup image_group(const Scene& scene, const Problem& problem, const Output& output) {
  PlaneGroup group = rgb_group(output.rgb, shown(problem), "");
  group.stars = problem.show.stars;
  std::vector<double>& luminance = group.rows[3];
  luminance = output.xyz[1];
  if (scene.spectrum.colour == Colour::channels) {
    for (std::size_t w = 0; w < luminance.size(); ++w) {
      luminance[w] = (output.xyz[0][w] + output.xyz[1][w] + output.xyz[2][w]) / 3;
    }
  }
  group.inscatter[3] = group.inscatter[0];
  group.ground[3] = group.ground[0];
  return group;
}

}  // namespace

std::vector<PlaneGroup> plane_groups(const Scene& scene, const Problem& problem,
                                     const Output& output) {
  std::vector<PlaneGroup> groups{image_group(scene, problem, output)};
  bool spectral = scene.image.channels == Channels::spectral;
  auto add = [&](int quantities, const std::string& prefix, bool stars) {
    if (!spectral) {
      const auto rows = quantities & transmittance
                            ? transmittance_rows(scene, problem.wavelengths_nm)
                            : output.rgb;
      groups.push_back(rgb_group(rows, quantities, prefix));
      groups.back().stars = stars;
      return;
    }
    for (PlaneGroup& group : spectral_groups(problem, output, quantities, prefix)) {
      group.stars = stars;
      groups.push_back(std::move(group));
    }
  };
  int show = shown(problem);
  if (spectral) add(show, "", problem.show.stars);
  const Layers& layers = scene.image.layers;
  if (layers.transmittance) add(transmittance, "transmittance.", false);
  if (layers.inscatter) add(inscatter & show, "inscatter.", false);
  if (layers.ground) add(ground & show, "ground.", false);
  if (layers.sun) add(sun & show, "sun.", problem.show.stars);
  return groups;
}

std::vector<PlaneGroup> composite_groups(const Scene& scene, const Problem& problem,
                                         const Output& output) {
  std::vector<PlaneGroup> groups = plane_groups(scene, problem, output);
  for (PlaneGroup& group : groups) {
    const std::string& channel = group.channels.front();
    const bool image = channel == "R";
    group.objects = image || channel == "ground.R";
    group.background = image || channel == "sun.R";
    group.transmittance_itself = channel == "transmittance.R";
    if (group.transmittance_itself) group.transmittance = {};
  }
  return groups;
}

std::vector<double> wavelengths_of_transmittance(const Scene& scene) {
  return scene.spectrum.wavelengths_nm.empty() ? colour_wavelengths(transmittance_wavelengths)
                                               : scene.spectrum.wavelengths_nm;
}

std::array<std::vector<double>, 3> transmittance_rows(
    const Scene& scene, const std::vector<double>& wavelengths_nm) {
  Scene even = scene;
  even.sun.irradiance = Spectrum(1.0);
  const auto of_sun = make_output(scene, wavelengths_nm).rgb,
             of_even = make_output(even, wavelengths_nm).rgb;
  std::array<std::vector<double>, 3> rows;
  for (std::size_t c = 0; c < 3; ++c) {
    // Of more than the eye sees, of wavelengths that are few, even light may have none either.
    const std::vector<double> none(wavelengths_nm.size(), 0.0);
    rows[c] = normalised(of_sun[c]).value_or(normalised(of_even[c]).value_or(none));
  }
  return rows;
}

}  // namespace cyanometer
