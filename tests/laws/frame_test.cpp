// Laws of whole frames and of radiances, on the device.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/trigonometric.hpp>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/accuracy/finest.h"
#include "engine/display/compositor.h"
#include "engine/engine.h"
#include "engine/scene/document.h"
#include "tests/device.h"

namespace cyanometer {
namespace {

using nlohmann::json;

Scene scene_of(json document) {
  document["method"] = {{"name", "nishita"}, {"view_samples", 24}, {"light_samples", 8}};
  return read_scene(document);
}

json small(json document = json::object()) {
  document["image"]["width"] = 48;
  document["image"]["height"] = 24;
  return document;
}

json no_air(json document = json::object()) {
  for (const char* name : {"air", "aerosol", "ozone"}) {
    document["atmosphere"]["constituents"][name] = nullptr;
  }
  return document;
}

float sample(const Frame& frame, const std::string& channel, int pixel) {
  for (const auto& plane : frame.planes) {
    if (plane.channel == channel) return plane.samples[pixel];
  }
  ADD_FAILURE() << "no channel " << channel;
  return 0;
}

TEST(Frame, WithoutAirIsBlackSkyOverSunlitGround) {
  json document = no_air({{"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
                          {"planet", {{"ground_albedo", 0.4}}},
                          {"sun", {{"elevation_deg", 30}}}});
  Radiances found = device().radiance(scene_of(document), {{40, 10}, {-40, 10}}, true);
  for (std::size_t w = 0; w < 3; ++w) {
    EXPECT_EQ(found.radiance[0][w], 0);
    EXPECT_NEAR(found.radiance[1][w], 0.4 * std::numbers::inv_pi * 0.5, 1e-5);
    EXPECT_EQ(found.transmittance[0][w], 1);
    EXPECT_NEAR(found.irradiance->direct[w], 0.5, 1e-6);
    EXPECT_EQ(found.irradiance->diffuse_down[w], 0);
    EXPECT_NEAR(found.irradiance->diffuse_up[w], 0.4 * 0.5, 1e-4);
  }
}

TEST(Frame, HalfOfALargeSunOnTheHorizonLightsThePlane) {
  // Of a disc of radius r on the horizon the upper half gives the plane, over its projected
  // solid angle pi sin^2 r, the integral of cos z: 2/3 (r - sin r cos r) to good accuracy.
  for (double diameter : {10.0, 40.0}) {
    json document = no_air({{"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
                            {"sun",
                             {{"elevation_deg", 0},
                              {"angular_diameter_deg", diameter},
                              {"limb_darkening", false},
                              {"disc_samples", 256}}}});
    Radiances found = device().radiance(scene_of(document), {{40, 10}}, true);
    const double r = glm::radians(diameter / 2);
    constexpr int steps = 4000;
    double integral = 0;  // of sin(elevation) over the half disc, rows of equal elevation
    for (int i = 0; i < steps; ++i) {
      const double e = r * (i + 0.5) / steps;
      integral += 2 * std::acos(std::min(std::cos(r) / std::cos(e), 1.0)) * std::cos(e) *
                  std::sin(e) * r / steps;
    }
    const double expected = integral / (std::numbers::pi * std::pow(std::sin(r), 2));
    for (double direct : found.irradiance->direct)
      EXPECT_NEAR(direct, expected, 0.02 * expected) << diameter;
  }
}

TEST(Frame, ColoursOfRaysAreThoseOfItsPixelsUnderALampToo) {
  // Green light, none at the outer wavelengths themselves: between them there is some.
  json document = small({{"spectrum", {{"wavelengths_nm", {440, 550, 680}}, {"colour", "cie"}}},
                         {"sun", {{"irradiance", {0, 1, 0}}}},
                         {"image", {{"format", "exr"}, {"show", {"ground"}}}}});
  const Scene scene = scene_of(document);
  const Frame frame = device().render(scene);
  for (int pixel : {5 * 48 + 7, 20 * 48 + 30}) {
    const std::vector<Direction> towards = pixel_directions(scene, {pixel});
    const Radiances found = device().radiance(scene, towards, false, device().plan(scene));
    const Triple rgb = RayColours(scene, found.wavelengths_nm).rgb(found.relative.front());
    for (int c = 0; c < 3; ++c) {
      const double shown = sample(frame, std::string(1, "RGB"[c]), pixel);
      EXPECT_NEAR(rgb[c], shown, 1e-4 * std::abs(shown)) << c;
    }
    EXPECT_EQ(found.radiance.front()[0], 0);
    EXPECT_GT(found.relative.front()[0], 0);
  }
}

TEST(Frame, SpectralChannelsOfNearWavelengthsHaveNamesOfTheirOwn) {
  json document = small({{"spectrum", {{"wavelengths_nm", {1270.001, 1270.004}}}},
                         {"image", {{"format", "exr"}, {"channels", "spectral"}}}});
  const Frame frame = device().render(scene_of(document));
  EXPECT_GT(sample(frame, "1270,001nm", 5 * 48 + 7), 0);
  EXPECT_GT(sample(frame, "1270,004nm", 5 * 48 + 7), 0);
}

TEST(Frame, OfOrderZeroIsTheSunAlone) {
  json document = small({{"camera", {{"fov_deg", 2}, {"pitch_deg", 30}}},
                         {"image", {{"format", "exr"}, {"show", {"sun"}}}}});
  document["method"] = {{"name", "nishita"}, {"scattering_orders", 0}};
  Frame frame = device().render(read_scene(document));
  EXPECT_GT(sample(frame, "G", 12 * 48 + 24), 1000);
  EXPECT_EQ(sample(frame, "G", 0), 0);
}

TEST(Frame, IsTheSumOfItsLayers) {
  json document = small({{"sun", {{"elevation_deg", 8}}}});
  document["image"]["format"] = "exr";
  document["image"]["layers"] = {"inscatter", "ground", "sun", "transmittance"};
  Frame frame = device().render(scene_of(document));
  for (int pixel = 0; pixel < 48 * 24; ++pixel) {
    for (std::string c : {"R", "G", "B"}) {
      float sum = sample(frame, "inscatter." + c, pixel) + sample(frame, "ground." + c, pixel) +
                  sample(frame, "sun." + c, pixel);
      EXPECT_NEAR(sample(frame, c, pixel), sum, 1e-5 * std::abs(sum));
      EXPECT_LE(sample(frame, "transmittance." + c, pixel), 1.001);
    }
  }
}

TEST(Frame, IsLinearInTheSunsIrradiance) {
  json document = small({{"spectrum", {{"wavelengths_nm", {680, 550, 440}}}}});
  document["image"]["format"] = "npy";
  Frame one = device().render(scene_of(document));
  document["sun"]["irradiance"] = 8;
  Frame eight = device().render(scene_of(document));
  for (int pixel = 0; pixel < 48 * 24; ++pixel) {
    EXPECT_EQ(8 * sample(one, "G", pixel), sample(eight, "G", pixel));
  }
}

TEST(Frame, KeepsTheOrderOfItsWavelengths) {
  json document = small({{"spectrum", {{"wavelengths_nm", {680, 550, 440}}}}});
  document["image"]["format"] = "npy";
  Frame there = device().render(scene_of(document));
  document["spectrum"]["wavelengths_nm"] = {440, 550, 680};
  Frame back = device().render(scene_of(document));
  for (int pixel = 0; pixel < 48 * 24; ++pixel) {
    EXPECT_NEAR(sample(there, "R", pixel), sample(back, "B", pixel),
                1e-6 * sample(there, "R", pixel));
  }
}

TEST(Frame, IsTheSameWhateverWasRenderedBefore) {
  Scene scene = scene_of(small({{"preset", "mars"}}));
  Engine fresh;
  Frame first = fresh.render(scene);
  device().render(scene_of(small()));
  Frame later = device().render(scene);
  EXPECT_EQ(std::memcmp(first.rgbx, later.rgbx, 48 * 24 * 4), 0);
}

TEST(Frame, OfManyWavelengthsIsThatOfEachByItself) {
  json document = small({{"image", {{"format", "exr"}, {"channels", "spectral"}}}});
  json wavelengths = json::array();
  for (int i = 0; i < 37; ++i) wavelengths.push_back(380 + 10 * i);
  document["spectrum"] = {{"wavelengths_nm", wavelengths}, {"colour", "cie"}};
  Frame all = device().render(scene_of(document));
  ASSERT_EQ(all.planes.size(), 37u);
  document["spectrum"]["wavelengths_nm"] = {440, 680};
  Frame two = device().render(scene_of(document));
  for (int pixel = 0; pixel < 48 * 24; pixel += 7) {
    for (const char* channel : {"440nm", "680nm"}) {
      float expected = sample(two, channel, pixel);
      EXPECT_NEAR(sample(all, channel, pixel), expected, 1e-5 * expected);
    }
  }
}

TEST(Frame, IsMirroredAboutTheSunsAzimuth) {
  json document = small({{"sun", {{"elevation_deg", 3}}}});
  document["image"]["format"] = "npy";
  document["image"]["show"] = {"ground"};
  Frame frame = device().render(scene_of(document));
  for (int row = 0; row < 24; ++row) {
    for (int column = 0; column < 24; ++column) {
      float left = sample(frame, "B", row * 48 + column);
      EXPECT_NEAR(left, sample(frame, "B", row * 48 + 47 - column), 1e-4 * left);
    }
  }
}

TEST(Sun, FarAwayLightsLikeAParallelOne) {
  json document = {{"sun", {{"elevation_deg", 20}}},
                   {"spectrum", {{"wavelengths_nm", {680, 550, 440}}}}};
  std::vector<Direction> directions{{90, 0}, {10, 0}, {5, 120}, {-30, 40}};
  Radiances parallel = device().radiance(scene_of(document), directions, false);
  document["sun"]["distance_km"] = 1.5e8;
  Radiances near = device().radiance(scene_of(document), directions, false);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    EXPECT_NEAR(near.radiance[i][1], parallel.radiance[i][1], 3e-4 * parallel.radiance[i][1]);
  }
}

TEST(Sun, OfManyPointsSmallDiscIsTheSunOfOne) {
  json document = {{"sun", {{"elevation_deg", 25}, {"angular_diameter_deg", 0.02}}},
                   {"spectrum", {{"wavelengths_nm", {680, 550, 440}}}}};
  std::vector<Direction> directions{{90, 0}, {10, 30}, {-30, 40}};
  Radiances one = device().radiance(scene_of(document), directions, false);
  document["sun"]["disc_samples"] = 16;
  Radiances many = device().radiance(scene_of(document), directions, false);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    EXPECT_NEAR(many.radiance[i][1], one.radiance[i][1], 1e-3 * one.radiance[i][1]);
  }
}

TEST(Irradiance, OfTheSkyIsTheIntegralOfItsRadiance) {
  json document = {{"sun", {{"elevation_deg", 50}}},
                   {"spectrum", {{"wavelengths_nm", {680, 550, 440}}}}};
  std::vector<Direction> grid;
  for (int e = 0; e < 90; ++e) {
    for (int a = 0; a < 360; a += 5) grid.push_back({e + 0.5, a + 2.5});
  }
  double sum = 0;
  std::optional<Radiances::Irradiance> stated;
  for (std::size_t first = 0; first < grid.size(); first += 4096) {
    std::vector<Direction> part(grid.begin() + first,
                                grid.begin() + std::min(first + 4096, grid.size()));
    Radiances found = device().radiance(scene_of(document), part, first == 0);
    if (first == 0) stated = found.irradiance;
    for (std::size_t i = 0; i < part.size(); ++i) {
      double e = glm::radians(part[i].elevation_deg);
      sum += found.radiance[i][1] * std::cos(e) * std::sin(e) * glm::radians(1.0) *
             glm::radians(5.0);
    }
  }
  EXPECT_NEAR(stated->diffuse_down[1], sum, 0.01 * sum);
}

TEST(Exposure, PutsTheMeanOfAnEvenFrameAStopAboveMiddleGrey) {
  std::vector<float> even(1000, 0.5f);
  EXPECT_NEAR(std::exp2(automatic_exposure_ev(even, 1)) * 0.5, 0.36, 1e-6);
  even.resize(2000, -1.f);  // outside the planet
  EXPECT_NEAR(std::exp2(automatic_exposure_ev(even, 1)) * 0.5, 0.36, 1e-6);
  even.resize(3000, 1e-6f);  // a night side
  EXPECT_NEAR(std::exp2(automatic_exposure_ev(even, 1)) * 0.5, 0.36, 1e-6);
}

TEST(Exposure, OfABlackFrameIsZero) {
  EXPECT_EQ(automatic_exposure_ev(std::vector<float>(10, 0.f), 1), 0);
}

}  // namespace
}  // namespace cyanometer
