#include "engine/display/displayed.h"

#include <cmath>
#include <glm/glm.hpp>

#include "engine/optics/ciede2000.h"

namespace cyanometer {
namespace {
namespace tone {

using Real = double;
using Vec3 = glm::dvec3;
using glm::clamp;
using glm::dot;
using glm::exp;
using glm::log2;
using glm::max;
using glm::min;
using glm::pow;

#define CONSTANT [[maybe_unused]] constexpr
#include "shaders/display/tone.glsl"
#undef CONSTANT

}  // namespace tone
}  // namespace

Triple into_gamut(const Triple& rgb) {
  const glm::dvec3 inside = tone::into_gamut({rgb[0], rgb[1], rgb[2]});
  return {inside.x, inside.y, inside.z};
}

Matrix display_matrix(const Output& output, double exposure_ev) {
  Matrix matrix = output.white_balance;
  for (double& element : matrix) element *= std::exp2(exposure_ev) / output.white_card;
  return matrix;
}

Displayed::Displayed(const Image& image, const Output& output, double exposure_ev)
    : tone_map_(static_cast<int>(image.tone_map)),
      matrix_(display_matrix(output, exposure_ev)) {}

Triple Displayed::levels(const Triple& rgb) const {
  const Triple linear = matrix_ * rgb;
  const glm::dvec3 shown = glm::clamp(
      tone::tone_mapped(tone_map_, tone::into_gamut({linear[0], linear[1], linear[2]})), 0.0,
      1.0);
  Triple levels;
  for (int c = 0; c < 3; ++c) {
    levels[static_cast<std::size_t>(c)] = 255 * tone::srgb_encoded(shown[c]);
  }
  return levels;
}

Triple lab_of_levels(const Triple& levels) {
  Triple encoded;
  for (std::size_t c = 0; c < 3; ++c) encoded[c] = std::floor(levels[c] + 0.5) / 255;
  return lab_from_srgb(encoded);
}

}  // namespace cyanometer
