// Which pixels `"show": ["clipped"]` paints.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "engine/engine.h"
#include "engine/image/picture.h"
#include "engine/scene/document.h"
#include "tests/device.h"

namespace cyanometer {
namespace {

using nlohmann::json;
using Triples = std::vector<std::array<double, 3>>;

/// Linear colours as an image shows them: pixels of objects that stand before the camera.
std::vector<std::array<int, 3>> shown(const Triples& colours, const std::string& tone_map,
                                      bool clipped) {
  Scene scene = read_scene({{"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
                            {"image",
                             {{"width", colours.size()},
                              {"height", 1},
                              {"exposure_ev", 0},
                              {"tone_map", tone_map}}}});
  scene.image.show = {.sun = false, .stars = false, .ground = true, .clipped = clipped};
  Plan plan;
  plan.method = "raymarch";
  plan.wavelengths_nm = scene.spectrum.wavelengths_nm;
  for (const MethodDescription& method : methods()) {
    if (method.name != plan.method) continue;
    for (const MethodOption& option : method.options) {
      plan.options[option.name] = option.default_value;
    }
  }
  // At exposure 0 a white card is 1: irradiance over pi, and that is 1 at each wavelength.
  Picture picture;
  for (const auto& colour : colours) {
    for (std::size_t c = 0; c < 3; ++c) {
      picture.rgb[c].push_back(static_cast<float>(colour[c] / std::numbers::pi));
    }
    picture.distance_km.push_back(0);
  }
  const Frame frame = device().composite(scene, picture, plan);
  std::vector<std::array<int, 3>> pixels;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const unsigned char* p = frame.rgbx + 4 * i;
    pixels.push_back({p[0], p[1], p[2]});
  }
  return pixels;
}

constexpr std::array<int, 3> paint{255, 0, 255};

double half_a_level_below_white() {
  return std::pow((254.5 / 255 + 0.055) / 1.055, 2.4);  // [IEC 61966-2-1]
}

/// The grey beyond which a map shows no more, by its own formula.
double brightest_grey(const std::string& tone_map) {
  const double nearly = half_a_level_below_white();
  if (tone_map == "reinhard") return nearly / (1 - nearly);
  if (tone_map == "exponential") return -std::log(1 - nearly);
  if (tone_map == "agx") return std::exp2(4.026069);
  if (tone_map == "aces") {
    // Where the two polynomials of the fit are equal.
    const double a = 1 - 0.983729, b = 0.0245786 - 0.4329510, c = -0.000090537 - 0.238081;
    return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
  }
  return 1;
}

TEST(Clipped, PaintsGreysThatAreTooBrightToBeShownByEveryToneMap) {
  Triples greys;
  for (int i = 0; i < 256; ++i) {
    const double grey = std::exp2((i - 127.3) / 8);
    greys.push_back({grey, grey, grey});
  }
  for (const std::string tone_map : {"linear", "reinhard", "exponential", "aces", "agx"}) {
    SCOPED_TRACE(tone_map);
    const double brightest = brightest_grey(tone_map);
    const auto plain = shown(greys, tone_map, false), painted = shown(greys, tone_map, true);
    for (std::size_t i = 0; i < greys.size(); ++i) {
      EXPECT_EQ(painted[i], greys[i][0] > brightest ? paint : plain[i]) << greys[i][0];
      EXPECT_NE(plain[i], paint);
    }
  }
}

TEST(Clipped, PaintsColoursOfWhichOneChannelIsTooBright) {
  const Triples colours{{0.5, 0.5, 1.1}, {0.5, 0.5, 0.9}, {1e4, 1, 1}, {0.1, 0.1, 0.1}};
  for (const std::string tone_map : {"linear", "reinhard", "exponential", "aces", "agx"}) {
    SCOPED_TRACE(tone_map);
    const auto painted = shown(colours, tone_map, true);
    EXPECT_EQ(painted[0] == paint, tone_map == "linear");
    EXPECT_NE(painted[1], paint);
    EXPECT_EQ(painted[2], paint);
    EXPECT_NE(painted[3], paint);
  }
}

}  // namespace
}  // namespace cyanometer
