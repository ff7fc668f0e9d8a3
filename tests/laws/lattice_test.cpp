// Frames of which some rays are traced: no pixel is left out, and none is off by more than what
// was asked from what it would be by itself.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>

#include "engine/accuracy/comparison.h"
#include "engine/accuracy/error.h"
#include "engine/engine.h"
#include "engine/lattice/lattice.h"
#include "engine/scene/document.h"
#include "tests/device.h"

namespace cyanometer {
namespace {

using nlohmann::json;

// ---- The lattice by itself

Physics<double> camera_of(const json& document) {
  return pack<double>(make_problem(read_scene(document), {680, 550, 440}));
}

json picture(const std::string& projection, int width, int height, double altitude_km = 0.002) {
  return {{"camera", {{"projection", projection}, {"altitude_km", altitude_km}}},
          {"image", {{"width", width}, {"height", height}}}};
}

/// Of a camera: a value for each pixel, and what a settled lattice makes of them.
class Settled {
 public:
  Settled(const json& document, const std::function<float(const glm::dvec3&)>& value,
          float tolerance)
      : camera_(camera_of(document)), lattice_(camera_) {
    const auto pixels = static_cast<std::size_t>(camera_.scene.width) * camera_.scene.height;
    for (std::size_t i = 0; i < pixels; ++i)
      truth_.push_back(value(camera_.pixel_ray(static_cast<int>(i)).direction));
    const Interpolated of{truth_, tolerance};
    filled_.assign(pixels, std::nanf(""));
    times_.assign(pixels, 0);
    while (!lattice_.settled()) {
      for (int pixel : lattice_.wanted()) trace(pixel);
      for (int pixel : lattice_.outside()) trace(pixel);
      lattice_.settle({&of, 1});
    }
    for (const auto& [side, corners] : lattice_.cells()) {
      for (int corner : corners) fill(corner, side);
    }
  }

  const std::vector<float>& truth() const { return truth_; }
  const std::vector<float>& filled() const { return filled_; }
  /// How many cells have the pixel, or 1 where it is traced and none has.
  const std::vector<int>& times() const { return times_; }
  int traced() const { return lattice_.traced(); }
  /// Pixels of all cells, and those in none.
  int pixels() const {
    auto count = static_cast<int>(lattice_.singles().size());
    for (const auto& [side, corners] : lattice_.cells()) {
      for (int corner : corners) count += lattice_.pixels(corner, side);
    }
    return count;
  }

 private:
  void trace(int pixel) {
    EXPECT_TRUE(std::isnan(filled_[static_cast<std::size_t>(pixel)])) << "traced twice";
    filled_[static_cast<std::size_t>(pixel)] = truth_[static_cast<std::size_t>(pixel)];
  }

  void fill(int corner, int side) {
    const int width = lattice_.width(), x0 = corner % width, y0 = corner / width;
    const int last_row = (y0 / lattice_.panel() + 1) * lattice_.panel() - 1;
    const int x1 = std::min(x0 + side, width - 1), y1 = std::min(y0 + side, last_row);
    auto at = [&](int x, int y) { return truth_[static_cast<std::size_t>(y * width + x)]; };
    for (int y = y0; y < std::min(y0 + side, last_row + 1); ++y) {
      for (int x = x0; x < std::min(x0 + side, width); ++x) {
        const float u = x1 > x0 ? static_cast<float>(x - x0) / static_cast<float>(x1 - x0) : 0,
                    v = y1 > y0 ? static_cast<float>(y - y0) / static_cast<float>(y1 - y0) : 0;
        const auto pixel = static_cast<std::size_t>(y * width + x);
        filled_[pixel] = std::lerp(std::lerp(at(x0, y0), at(x1, y0), u),
                                   std::lerp(at(x0, y1), at(x1, y1), u), v);
        ++times_[pixel];
      }
    }
  }

  Physics<double> camera_;
  Lattice lattice_;
  std::vector<float> truth_, filled_;
  std::vector<int> times_;
};

std::vector<json> pictures() {
  return {picture("perspective", 160, 128),     picture("perspective", 163, 129),
          picture("perspective", 128, 300),     picture("fisheye", 150, 150),
          picture("fisheye", 200, 131),         picture("equirectangular", 256, 128),
          picture("equirectangular", 262, 131), picture("cubemap", 64, 384),
          picture("cubemap", 51, 306),          picture("perspective", 160, 120, 2e4),
          picture("fisheye", 170, 170, 36000)};
}

TEST(Lattice, EveryPixelIsTracedOrInOneCell) {
  for (const json& document : pictures()) {
    const Settled settled(
        document,
        [](const glm::dvec3& d) { return static_cast<float>(std::exp(3 * d.z) + d.x); }, 0.01f);
    for (std::size_t i = 0; i < settled.filled().size(); ++i) {
      ASSERT_FALSE(std::isnan(settled.filled()[i])) << document << " pixel " << i;
      ASSERT_LE(settled.times()[i], 1) << document << " pixel " << i;
    }
    EXPECT_EQ(settled.pixels(), static_cast<int>(settled.filled().size())) << document;
    EXPECT_LT(settled.traced(), 0.6 * static_cast<double>(settled.filled().size())) << document;
  }
}

TEST(Lattice, WhatIsInterpolatedIsOffByNoMoreThanIsAllowed) {
  const glm::dvec3 peak = glm::normalize(glm::dvec3(0.3, 1, 0.4));
  for (const json& document : pictures()) {
    for (float tolerance : {0.02f, 0.002f}) {
      const Settled settled(
          document,
          [&](const glm::dvec3& d) {
            const double distance = glm::length(d - peak);
            return static_cast<float>(std::exp(-d.z * d.z * 30) + 0.5 * d.y +
                                      std::exp(-distance * distance * 20));
          },
          tolerance);
      double most = 0;
      for (std::size_t i = 0; i < settled.filled().size(); ++i)
        most = std::max<double>(most, std::abs(settled.filled()[i] - settled.truth()[i]));
      EXPECT_LE(most, 1.2 * tolerance) << document << settled.traced();
    }
  }
}

TEST(Lattice, PlanetsAndSunsSmallerThanItsCellsAreFound) {
  // A planet of some five pixels, and its air of less than one.
  json document = picture("perspective", 320, 240, 6e5);
  document["camera"].update({{"pitch_deg", -84}, {"fov_deg", 60}});
  Physics<double> camera = camera_of(document);
  const Settled settled(
      document,
      [&](const glm::dvec3& d) { return camera.path_from_camera(d).meets_ground ? 1.f : 0.f; },
      0.001f);
  EXPECT_EQ(settled.filled(), settled.truth());
  EXPECT_GT(std::ranges::count(settled.truth(), 1.f), 9);
  document = picture("fisheye", 256, 256);
  document["sun"]["elevation_deg"] = 50;
  document["camera"]["pitch_deg"] = 90;
  camera = camera_of(document);
  const auto sun = camera.sun_ray({0, 0, 6360}, glm::dvec3(0)).direction;
  const Settled sunny(
      document, [&](const glm::dvec3& d) { return glm::length(d - sun) < 0.01 ? 1.f : 0.f; },
      0.001f);
  EXPECT_EQ(sunny.filled(), sunny.truth());
  EXPECT_GT(std::ranges::count(sunny.truth(), 1.f), 0);
}

// ---- Frames

struct FrameCase {
  const char* name;
  json document;
};

std::vector<FrameCase> frame_cases() {
  auto named = [](const char* preset, json camera, int width, int height) {
    return json{{"preset", preset},
                {"camera", std::move(camera)},
                {"image", {{"width", width}, {"height", height}}}};
  };
  json night = named("earth_twilight", {{"fov_deg", 90}}, 240, 135);
  json telescope = named("earth_noon", {{"fov_deg", 2}, {"pitch_deg", 60}}, 161, 130);
  telescope["sun"]["elevation_deg"] = 60;
  json clipped = named("earth_low_sun", {{"fov_deg", 70}}, 192, 108);
  clipped["image"].update({{"show", {"sun", "ground", "clipped"}}, {"exposure_ev", 2}});
  return {{"noon", named("earth_noon", {{"fov_deg", 100}, {"pitch_deg", 40}}, 256, 144)},
          {"low sun", named("earth_low_sun", {{"fov_deg", 60}}, 322, 181)},
          {"stars", night},
          {"the sun's disc", telescope},
          {"clipped", clipped},
          {"10 km", named("earth_10km", json::object(), 256, 144)},
          {"limb", named("earth_limb", json::object(), 256, 144)},
          {"a far planet",
           named("earth_noon", {{"altitude_km", 1e5}, {"pitch_deg", -85}, {"fov_deg", 40}}, 200,
                 150)},
          {"fisheye",
           named("earth_noon", {{"projection", "fisheye"}, {"pitch_deg", 90}, {"fov_deg", 180}},
                 180, 150)},
          {"all around", named("earth_low_sun", {{"projection", "equirectangular"}}, 256, 128)},
          {"cube", named("earth_low_sun", {{"projection", "cubemap"}}, 64, 384)}};
}

Plan plan_with(double interpolation, const char* method = "raymarch") {
  Plan plan;
  plan.method = method;
  for (const MethodDescription& each : methods()) {
    if (each.name == plan.method) plan.options = each.ladder.front();
  }
  plan.options["interpolation"] = interpolation;
  plan.wavelengths_nm = {440, 500, 550, 620};
  return plan;
}

Frame frame_of(json document, const char* format, const Plan& plan) {
  document["image"]["format"] = format;
  return device().render(read_scene(document), plan);
}

TEST(SparseFrame, IsWithinWhatIsAskedOfTheFrameOfAllRays) {
  for (const FrameCase& each : frame_cases()) {
    const Scene scene = read_scene(each.document);
    const std::vector<bool> counted = measured_pixels(scene);
    const Frame full = frame_of(each.document, "npy", plan_with(0));
    auto channels = [&](const Frame& frame) {
      return in_error_channels(image_planes(frame), Colour::cie, counted);
    };
    for (double tolerance : {0.004, 0.0005}) {
      const Frame sparse = frame_of(each.document, "npy", plan_with(tolerance));
      const ErrorMeasure measure = measure_error(channels(sparse), channels(full), 3);
      // As plans reckon with it (planner.cpp).
      EXPECT_LE(measure.error, 0.5 * tolerance) << each.name;
      EXPECT_LE(measure.max, 12 * tolerance) << each.name;
      for (std::size_t i = 0; i < counted.size(); ++i) {
        for (std::size_t c = 0; !counted[i] && c < 3; ++c)
          ASSERT_EQ(sparse.planes[c].samples[i], full.planes[c].samples[i])
              << each.name << " pixel " << i << ", which sees neither air nor ground";
      }
    }
  }
}

TEST(SparseFrame, IsDisplayedWithinALevelOfTheFrameOfAllRays) {
  for (FrameCase each : frame_cases()) {
    if (!each.document["image"].contains("exposure_ev"))
      each.document["image"]["exposure_ev"] = 0.5;
    const Frame full = frame_of(each.document, "png", plan_with(0)),
                sparse = frame_of(each.document, "png", plan_with(0.004));
    EXPECT_TRUE(sparse.planes.empty());
    const int bytes = 4 * full.width * full.height;
    int apart = 0;
    for (int i = 0; i < bytes; ++i) {
      const int off = std::abs(full.rgbx[i] - sparse.rgbx[i]);
      apart += off > 0;
      ASSERT_LE(off, 1) << each.name << " pixel " << i / 4 % full.width << ", "
                        << i / 4 / full.width;
    }
    EXPECT_LT(apart, bytes / 4) << each.name;
  }
}

TEST(SparseFrame, IsExposedAsTheFrameOfAllRays) {
  for (const FrameCase& each : frame_cases()) {
    if (each.document["image"].contains("exposure_ev")) continue;
    const double full = frame_of(each.document, "png", plan_with(0)).exposure_ev;
    EXPECT_NEAR(frame_of(each.document, "png", plan_with(0.004)).exposure_ev, full, 0.02)
        << each.name;
  }
}

TEST(SparseFrame, HasAllLayersAndWavelengths) {
  json document = frame_cases()[1].document;
  document["spectrum"]["wavelengths_nm"] = {440, 500, 550, 620};
  document["image"].update(
      {{"channels", "spectral"}, {"layers", {"transmittance", "inscatter", "ground", "sun"}}});
  const Frame full = frame_of(document, "exr", plan_with(0)),
              sparse = frame_of(document, "exr", plan_with(0.001));
  ASSERT_EQ(full.planes.size(), 20u);
  ASSERT_EQ(sparse.planes.size(), full.planes.size());
  for (std::size_t p = 0; p < full.planes.size(); ++p) {
    EXPECT_EQ(sparse.planes[p].channel, full.planes[p].channel);
    const float *a = full.planes[p].samples, *b = sparse.planes[p].samples;
    const int pixels = full.width * full.height;
    float largest = 0;
    for (int i = 0; i < pixels; ++i) largest = std::max(largest, std::abs(a[i]));
    for (int i = 0; i < pixels; ++i)
      ASSERT_NEAR(b[i], a[i], 0.005 * std::abs(a[i]) + 1e-4 * largest)
          << full.planes[p].channel << " " << i;
  }
}

TEST(SparseFrame, IsTheSameWhateverWasRenderedBefore) {
  Engine fresh;
  for (const FrameCase& each : frame_cases()) {
    for (const char* format : {"png", "npy"}) {
      json document = each.document;
      document["image"]["format"] = format;
      const Scene scene = read_scene(document);
      const Plan plan = plan_with(0.002);
      const Frame later = device().render(scene, plan), first = fresh.render(scene, plan);
      const auto pixels = static_cast<std::size_t>(first.width) * first.height;
      if (first.rgbx) {
        EXPECT_EQ(std::memcmp(first.rgbx, later.rgbx, 4 * pixels), 0) << each.name;
      }
      for (std::size_t p = 0; p < first.planes.size(); ++p)
        EXPECT_EQ(std::memcmp(first.planes[p].samples, later.planes[p].samples,
                              sizeof(float) * pixels),
                  0)
            << each.name;
    }
  }
}

TEST(SparseFrame, OfEveryMethodFollowsItsRays) {
  json document = frame_cases()[0].document;
  for (const char* method : {"nishita", "raymarch", "hillaire", "moments"}) {
    Plan plan = plan_with(0.002, "moments");
    plan.method = method;
    for (const MethodDescription& each : methods()) {
      if (each.name != plan.method) continue;
      plan.options.clear();
      for (const MethodOption& option : each.options)
        plan.options[option.name] = option.default_value;
    }
    plan.options["interpolation"] = 0;
    const Frame full = frame_of(document, "npy", plan);
    plan.options["interpolation"] = 0.002;
    const Frame sparse = frame_of(document, "npy", plan);
    const std::vector<bool> counted = measured_pixels(read_scene(document));
    auto channels = [&](const Frame& frame) {
      return in_error_channels(image_planes(frame), Colour::cie, counted);
    };
    EXPECT_LE(measure_error(channels(sparse), channels(full), 3).error, 0.001) << method;
  }
}

}  // namespace
}  // namespace cyanometer
