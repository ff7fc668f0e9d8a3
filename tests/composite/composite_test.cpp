// A client's picture behind the scene's air: limits, closed forms, and every method against
// integrals along the same parts of rays.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/accuracy/adaptive.h"
#include "engine/accuracy/error.h"
#include "engine/display/planes.h"
#include "engine/engine.h"
#include "engine/optics/colour.h"
#include "engine/scene/document.h"
#include "tests/device.h"
#include "tests/moments/reference.h"

namespace cyanometer {
namespace {

using nlohmann::json;
using Samples = std::vector<std::vector<double>>;
using MethodOptions = std::map<std::string, double>;

constexpr int width = 16, height = 10, pixels = width * height;
constexpr float endless = std::numeric_limits<float>::infinity();
const std::vector<double> wavelengths{680, 550, 440};

/// A hazy Earth at three wavelengths that are the channels; half sky, half ground.
Scene scene_with(const json& more = json::object()) {
  json document{{"spectrum", {{"wavelengths_nm", wavelengths}}},
                {"camera", {{"altitude_km", 1.5}, {"pitch_deg", 0}, {"fov_deg", 80}}},
                {"sun", {{"elevation_deg", 20}, {"azimuth_deg", 40}}},
                {"image",
                 {{"width", width},
                  {"height", height},
                  {"format", "exr"},
                  {"exposure_ev", 0},
                  {"show", {"ground"}},
                  {"layers", {"transmittance", "inscatter", "ground", "sun"}}}}};
  document.update(more, /*merge_objects=*/true);  // unlike a patch keeps null
  return read_scene(document);
}

Picture picture_of(float colour, float distance_km) {
  const std::vector<float> plane(pixels, colour);
  return {{plane, plane, plane}, std::vector<float>(pixels, distance_km)};
}

/// Distances of all sizes, from a metre on, over every part of the frame.
Picture scattered_picture(double longest_km) {
  Picture picture = picture_of(0, 0);
  for (int i = 0; i < pixels; ++i) {
    const double share = std::fmod(0.5 + i * 0.6180339887498949, 1.0);
    picture.distance_km[i] = static_cast<float>(1e-3 * std::pow(longest_km / 1e-3, share));
  }
  return picture;
}

/// By the method's defaults, and what of its options is given.
Plan plan_of(const std::string& method, const MethodOptions& changed = {},
             const std::vector<double>& wavelengths_nm = wavelengths) {
  Plan plan;
  plan.method = method;
  plan.wavelengths_nm = wavelengths_nm;
  const auto& known = *std::ranges::find(methods(), method, &MethodDescription::name);
  for (const MethodOption& option : known.options) {
    plan.options[option.name] = option.default_value;
  }
  for (const auto& [name, value] : changed) plan.options.at(name) = value;
  return plan;
}

/// The same with tables that are small: laws hold for any.
Plan quick_plan_of(const std::string& method, MethodOptions changed = {}) {
  if (method == "bruneton") {
    changed.merge(MethodOptions{
        {"altitudes", 6}, {"zeniths", 12}, {"suns", 12}, {"azimuths", 5}, {"orders", 2}});
  }
  return plan_of(method, changed);
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const MethodDescription& method : methods()) names.push_back(method.name);
  return names;
}

/// [pixel][channel] of the frame, or of a layer.
Samples values(const Frame& frame, const std::string& layer = "") {
  Samples result(static_cast<std::size_t>(frame.width) * frame.height,
                 std::vector<double>(3, std::nan("")));
  for (const Frame::Plane& plane : frame.planes) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (plane.channel != layer + (layer.empty() ? "" : ".") + "RGB"[c]) continue;
      for (std::size_t i = 0; i < result.size(); ++i) result[i][c] = plane.samples[i];
    }
  }
  return result;
}

void expect_equal(const Samples& a, const Samples& b, const std::string& what) {
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_EQ(a[i], b[i]) << what << ", pixel " << i;
}

void expect_near(const Samples& a, const Samples& b, double relative, const std::string& what) {
  double largest = 0;
  for (const auto& pixel : b) {
    for (double value : pixel) largest = std::max(largest, std::abs(value));
  }
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_NEAR(a[i][c], b[i][c], relative * std::max(std::abs(b[i][c]), 1e-3 * largest))
          << what << ", pixel " << i << ", channel " << c;
    }
  }
}

TEST(Composite, OfNothingInTheWayIsThePlainFrame) {
  for (const json& more :
       {json::object(), json{{"camera", {{"altitude_km", 400}, {"pitch_deg", -20}}}}}) {
    const Scene scene = scene_with(more);
    for (const std::string& method : method_names()) {
      const Plan plan = quick_plan_of(method);
      const Samples plain = values(device().render(scene, plan));
      for (const float far : {endless, 1e30f}) {
        const Frame frame = device().composite(scene, picture_of(0, far), plan);
        expect_equal(values(frame), plain, method);
      }
    }
  }
}

TEST(Composite, SkyPixelsOfAPictureWithObjectsAreThoseOfThePlainFrame) {
  const Scene scene = scene_with();
  for (const std::string& method : method_names()) {
    const Plan plan = quick_plan_of(method);
    const Samples plain = values(device().render(scene, plan));
    Picture picture = picture_of(0, endless);
    for (int i = 0; i < pixels; i += 2) picture.distance_km[i] = 3;
    const Samples mixed = values(device().composite(scene, picture, plan));
    for (int i = 1; i < pixels; i += 2) ASSERT_EQ(mixed[i], plain[i]) << method;
    for (int i = 0; i < pixels; i += 2) ASSERT_LT(mixed[i][2], plain[i][2]) << method;
  }
}

TEST(Composite, AtDistanceZeroIsThePicture) {
  const Scene scene = scene_with();
  for (const std::string& method : method_names()) {
    const Frame frame = device().composite(scene, picture_of(0.7f, 0), quick_plan_of(method));
    for (const auto& pixel : values(frame)) {
      for (double value : pixel) ASSERT_NEAR(value, 0.7, 1e-6) << method;
    }
  }
}

TEST(Composite, BehindEvenAirIsTheClosedForm) {
  // On a planet so large that the air is flat, under a sun overhead: along a ray of the zenith
  // cosine mu light grows by exp(beta mu t).
  const double beta = 0.05, top = 20, altitude = 5;
  const Scene scene = scene_with({{"planet", {{"radius_km", 1e6}, {"ground_albedo", 0}}},
                                  {"atmosphere",
                                   {{"thickness_km", top},
                                    {"constituents",
                                     {{"air", nullptr},
                                      {"ozone", nullptr},
                                      {"aerosol",
                                       {{"type", "particles"},
                                        {"scattering_per_km", 0.8 * beta},
                                        {"absorption_per_km", 0.2 * beta},
                                        {"optical_depth", nullptr},
                                        {"single_scattering_albedo", nullptr},
                                        {"phase", {{"type", "henyey_greenstein"}, {"g", 0}}},
                                        {"profile", {{"type", "uniform"}}}}}}}}},
                                  {"sun", {{"elevation_deg", 90}, {"irradiance", 1}}},
                                  {"camera", {{"altitude_km", altitude}, {"fov_deg", 20}}},
                                  {"method", {{"scattering_orders", 1}}}});
  Physics<double> camera = pack<double>(make_problem(scene, wavelengths));
  for (const std::string& method : method_names()) {
    // The midpoint rule has no exact column of the light.
    const double exact = method == "nishita" ? 2e-3 : method == "hillaire" ? 2e-3 : 2e-4;
    for (const double km : {0.001, 0.5, 4.0, 20.0}) {
      const Frame frame = device().composite(
          scene, picture_of(1, static_cast<float>(km)),
          quick_plan_of(method, method == "nishita" ? MethodOptions{{"view_samples", 64}}
                                                    : MethodOptions{}));
      const double through = std::exp(-beta * km),
                   sunlight = std::exp(-beta * (top - altitude));
      const Samples air = values(frame, "inscatter"), all = values(frame);
      for (int i = 0; i < pixels; ++i) {
        const double shift = 1 - camera.pixel_ray(i).direction.z;
        const double scattered = 0.8 * sunlight / (4 * std::numbers::pi) *
                                 (1 - std::exp(-beta * shift * km)) / shift;
        ASSERT_NEAR(air[i][0], scattered, exact * scattered) << method << " " << km;
        ASSERT_NEAR(all[i][0], through + scattered, 2e-4) << method << " " << km;
      }
    }
  }
}

/// Distances of the ground, where there is some, and the sky.
Picture picture_of_ground(const Scene& scene, float colour) {
  Physics<double> camera = pack<double>(make_problem(scene, wavelengths));
  Picture picture = picture_of(0, endless);
  for (int i = 0; i < pixels; ++i) {
    const auto path = camera.path_from_camera(camera.pixel_ray(i).direction);
    if (!path.meets_ground) continue;
    picture.distance_km[i] = static_cast<float>(path.length_km * (1 - 1e-6));
    for (auto& plane : picture.rgb) plane[i] = colour;
  }
  return picture;
}

TEST(Composite, OfTheGroundIsTheAirThatThePlainFrameShowsBeforeIt) {
  const Scene scene = scene_with();
  for (const std::string& method : method_names()) {
    const Plan plan = quick_plan_of(
        method, method == "path" ? MethodOptions{{"samples_per_pixel", 256}} : MethodOptions{});
    const Frame plain = device().render(scene, plan);
    const Picture picture = picture_of_ground(scene, 0.3f);
    const Frame frame = device().composite(scene, picture, plan);
    const Samples air = values(frame, "inscatter"), wanted = values(plain, "inscatter");
    // A part of a ray has nodes, or walks, of its own.
    EXPECT_LT(measure_error(air, wanted).error, method == "path" ? 0.05 : 0.01) << method;
    const Samples through = values(frame, "transmittance"), all = values(frame);
    for (int i = 0; i < pixels; ++i) {
      if (picture.distance_km[i] == endless) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_NEAR(all[i][c], air[i][c] + 0.3 * through[i][c], 2e-6) << method << " " << i;
      }
    }
    expect_near(through, values(plain, "transmittance"), method == "nishita" ? 0.2 : 1e-3,
                method);
  }
}

TEST(Composite, AirBeforeAnObjectGrowsWithItsDistanceAndHidesIt) {
  const Scene scene = scene_with();
  for (const std::string& method : method_names()) {
    Samples before(pixels, {0, 0, 0}), through(pixels, {1, 1, 1});
    for (const float km : {0.01f, 0.1f, 1.0f, 4.0f, 30.0f, 200.0f}) {
      const Plan plan = quick_plan_of(
          method, method == "nishita" ? MethodOptions{{"view_samples", 512}} : MethodOptions{});
      const Frame frame = device().composite(scene, picture_of(0, km), plan);
      const Samples now = values(frame, "inscatter"), t = values(frame, "transmittance");
      // Of two walks' results the noise may be more than the difference.
      const double slack = method == "path" ? 0.1 : 1e-4;
      for (int i = 0; i < pixels; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
          ASSERT_GE(now[i][c], before[i][c] * (1 - slack)) << method << " " << km << " " << i;
          ASSERT_LE(t[i][c], through[i][c] * (1 + 1e-6)) << method << " " << km << " " << i;
        }
      }
      before = now;
      through = t;
    }
  }
}

TEST(Composite, TransmittancesOfPartsMultiply) {
  // Straight up, where the camera can follow the ray.
  const auto up = [](double altitude_km, double length_km) {
    const Scene scene = scene_with(
        {{"camera", {{"altitude_km", altitude_km}, {"pitch_deg", 90}, {"fov_deg", 1}}}});
    return values(device().composite(scene, picture_of(0, static_cast<float>(length_km)),
                                     plan_of("raymarch")),
                  "transmittance")[pixels / 2 + width / 2];
  };
  const auto whole = up(0.1, 30), near = up(0.1, 2), far = up(2.1, 28);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(near[c] * far[c], whole[c], 2e-5);
}

TEST(Composite, AnObjectHidesGroundDiscAndStarsAndTheAirDimsWhatLiesBeyondIt) {
  const Scene scene = scene_with({{"camera", {{"pitch_deg", 20}, {"heading_deg", 40}}},
                                  {"sun", {{"angular_diameter_deg", 20}}},
                                  {"image", {{"show", {"sun", "stars", "ground"}}}}});
  const Plan plan = plan_of("moments");
  const Samples plain_sun = values(device().render(scene, plan), "sun");
  const Frame objects = device().composite(scene, picture_of(0, 1e6f), plan);
  const Frame background = device().composite(scene, picture_of(0.2f, endless), plan);
  const Samples through = values(background, "transmittance"), sun = values(background, "sun"),
                ground = values(background, "ground");
  double disc = 0;
  for (int i = 0; i < pixels; ++i) {
    disc += plain_sun[i][0];
    EXPECT_EQ(values(objects, "sun")[i][0], 0);
    EXPECT_EQ(values(objects, "ground")[i][0], 0);
    const bool sky = ground[i][0] == 0;
    EXPECT_NEAR(sun[i][0], plain_sun[i][0] + (sky ? 0.2 * through[i][0] : 0),
                1e-6 * (1 + plain_sun[i][0]));
  }
  EXPECT_GT(disc, 0);
}

TEST(Composite, LayersAddUpToTheFrame) {
  const Scene scene = scene_with({{"image", {{"show", {"sun", "stars", "ground"}}}}});
  Picture picture = scattered_picture(300);
  for (int i = 0; i < pixels; i += 3) picture.distance_km[i] = endless;
  for (auto& plane : picture.rgb) plane.assign(pixels, 0.25f);
  const Frame frame = device().composite(scene, picture, plan_of("moments"));
  const Samples all = values(frame);
  Samples sum(pixels, {0, 0, 0});
  for (const char* layer : {"inscatter", "ground", "sun"}) {
    const Samples part = values(frame, layer);
    for (int i = 0; i < pixels; ++i) {
      for (std::size_t c = 0; c < 3; ++c) sum[i][c] += part[i][c];
    }
  }
  expect_near(all, sum, 1e-5, "layers");
}

TEST(Composite, TheTransmittanceIsExactToAThousandthWhateverIsAsked) {
  // Colour's wavelengths, few of the method's samples, level views through haze.
  json document{{"image",
                 {{"width", width},
                  {"height", height},
                  {"format", "exr"},
                  {"layers", {"transmittance"}}}},
                {"camera", {{"pitch_deg", 0}, {"fov_deg", 30}}}};
  const Plan coarse =
      plan_of("nishita", {{"view_samples", 1}, {"light_samples", 1}}, colour_wavelengths(4));
  const std::vector<double> many = colour_wavelengths(64);
  double largest = 0;
  for (const char* preset : {"earth", "earth_hazy", "mars", "earth_dust", "gas_mixture"}) {
    document["preset"] = preset;
    const Scene scene = read_scene(document);
    const Output output = make_output(scene, many);
    oracle::Adaptive oracle(pack<double>(make_problem(scene, many)));
    Physics<double> camera = pack<double>(make_problem(scene, many));
    for (const float km : {0.3f, 5.0f, 40.0f, 1000.0f}) {
      const Frame frame = device().composite(scene, picture_of(0, km), coarse);
      const Samples through = values(frame, "transmittance");
      for (int i = 0; i < pixels; i += 7) {
        auto path = camera.path_from_camera(camera.pixel_ray(i).direction);
        const auto columns =
            oracle.column(path.altitude_km, path.mu, std::min<double>(km, path.length_km));
        for (std::size_t c = 0; c < 3; ++c) {
          double wanted = 0, sum = 0;
          for (std::size_t w = 0; w < many.size(); ++w) {
            double depth = 0;
            for (int m = 0; m < camera.MEDIA; ++m) {
              depth += columns[m] * camera.extinction(m, int(w / 4))[int(w % 4)];
            }
            wanted += output.rgb[c][w] * std::exp(-depth);
            sum += output.rgb[c][w];
          }
          EXPECT_NEAR(through[i][c], wanted / sum, 1e-3) << preset << " " << km << " " << i;
          largest = std::max(largest, std::abs(through[i][c] - wanted / sum));
        }
      }
    }
  }
  std::printf("largest error of a transmittance: %.1e\n", largest);
}

/// Order one by adaptive quadrature in double along the very parts of rays.
Samples adaptive_values(const Scene& scene, const Picture& picture) {
  const Problem problem = make_problem(scene, wavelengths);
  const Output output = make_output(scene, wavelengths);
  oracle::Adaptive oracle(pack<double>(problem));
  Physics<double> camera = pack<double>(problem);
  Samples result;
  for (int i = 0; i < pixels; ++i) {
    glm::dvec3 direction = camera.pixel_ray(i).direction;
    const double air_km =
        picture.distance_km[i] -
        glm::length(camera.path_from_camera(direction).start -
                    glm::dvec3(0, 0, problem.planet_radius_km + problem.camera.altitude_km));
    const oracle::Ray ray = oracle.trace(direction, std::max(air_km, 0.0));
    auto& pixel = result.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      pixel.push_back(ray.inscatter[c] * output.irradiance[c]);
    }
  }
  return result;
}

struct View {
  const char* name;
  double altitude_km, pitch_deg, sun_deg, longest_km;
};
const std::vector<View> views{{"ground, day", 0.002, 10, 30, 150},
                              {"ground, sunset", 0.002, 5, 1, 150},
                              {"twilight", 0.5, 10, -4, 300},
                              {"10 km, day", 10, -5, 30, 400},
                              {"space", 400, -40, 25, 1500}};

Scene scene_of(const View& view, const json& more = json::object()) {
  json document{{"camera",
                 {{"altitude_km", view.altitude_km},
                  {"pitch_deg", view.pitch_deg},
                  {"fov_deg", view.altitude_km > 100 ? 50 : 70}}},
                {"sun", {{"elevation_deg", view.sun_deg}}}};
  document.update(more, /*merge_objects=*/true);  // unlike a patch keeps null
  return scene_with(document);
}

TEST(Composite, OrderOneIsTheIntegralAlongThePartOfTheRay) {
  for (const View& view : views) {
    const Scene scene = scene_of(view, {{"method", {{"scattering_orders", 1}}}});
    const Picture picture = scattered_picture(view.longest_km);
    const Samples wanted = adaptive_values(scene, picture);
    const auto error = [&](const std::string& method, const MethodOptions& options) {
      return measure_error(values(device().composite(scene, picture, plan_of(method, options)),
                                  "inscatter"),
                           wanted)
          .error;
    };
    SCOPED_TRACE(view.name);
    EXPECT_LT(error("raymarch", {}), 1e-4);
    EXPECT_LT(error("path", {{"samples_per_pixel", 1}}), 1e-4);
    EXPECT_LT(error("bruneton", {}), 1e-4);
    EXPECT_LT(error("moments", {}), 1e-4);
    // Tables of parts, and the midpoint rule.
    EXPECT_LT(error("hillaire", {}), 0.03);
    EXPECT_LT(error("moments", {{"march_pixels", 0}}), 0.03);
    std::printf("%s: hillaire %.4f moments' table %.4f nishita %.4f\n", view.name,
                error("hillaire", {}), error("moments", {{"march_pixels", 0}}),
                error("nishita", {{"view_samples", 64}, {"light_samples", 64}}));
  }
}

TEST(Composite, AllOrdersAgreeWithRandomWalksWithinWhatTheMethodStates) {
  for (const View& view : views) {
    const Scene scene = scene_of(view);
    const Picture picture = scattered_picture(view.longest_km);
    const auto walked = [&](double seed) {
      return values(
          device().composite(scene, picture,
                             plan_of("path", {{"samples_per_pixel", 1024}, {"seed", seed}})),
          "inscatter");
    };
    const Samples a = walked(1), b = walked(2);
    SCOPED_TRACE(view.name);
    for (const char* method : {"hillaire", "bruneton", "moments"}) {
      Scene asked = scene;
      asked.method.name = method;
      asked.method.options = plan_of(method).options;
      const Frame frame = device().composite(asked, picture);
      const EstimatedError error = measure_error(values(frame, "inscatter"), a, b);
      std::printf("%s, %s: stated %.4f, measured %.4f (%.4f to %.4f)\n", view.name, method,
                  frame.plan.expected_error, error.measure.error, error.low, error.high);
      EXPECT_LT(error.low, frame.plan.expected_error) << method;
    }
  }
}

TEST(Composite, WalksToAnEndAgreeWithMomentTablesInDoubleAlongThePart) {
  // Clear air, where these tables hold to a permille.
  const json clear{{"atmosphere", {{"constituents", {{"aerosol", nullptr}}}}}};
  for (const View& view : {views[0]}) {
    const Scene scene = scene_of(view, clear);
    const Problem problem = make_problem(scene, wavelengths);
    const Output output = make_output(scene, wavelengths);
    MomentReference reference(problem, {.degree = 4, .altitudes = 10, .suns = 16});
    Physics<double> camera = pack<double>(problem);
    const Picture picture = scattered_picture(view.longest_km);
    Scene once = scene;
    once.method.scattering_orders = 1;
    const Samples first = values(device().composite(once, picture, plan_of("raymarch")));
    Samples wanted;
    for (int i = 0; i < pixels; ++i) {
      const glm::dvec4 further = reference.further_radiance(
          problem, camera.pixel_ray(i).direction, picture.distance_km[i]);
      auto& pixel = wanted.emplace_back();
      for (int c = 0; c < 3; ++c) {
        pixel.push_back(first[i][c] + further[c] * output.irradiance[c]);
      }
    }
    const auto walked = [&](double seed) {
      return values(device().composite(
          scene, picture, plan_of("path", {{"samples_per_pixel", 2048}, {"seed", seed}})));
    };
    const EstimatedError walks = measure_error(wanted, walked(1), walked(2));
    EXPECT_LT(walks.low, 0.005) << view.name;
    EXPECT_NEAR(walks.measure.bias, 0, 0.004) << view.name;
    std::printf("%s: walks and tables differ by %.4f (%.4f to %.4f), bias %.4f\n", view.name,
                walks.measure.error, walks.low, walks.high, walks.measure.bias);
    const Samples moments = values(device().composite(scene, picture, plan_of("moments")));
    EXPECT_LT(measure_error(moments, wanted).error, 0.006) << view.name;
    const Samples tables = values(device().composite(scene, picture, plan_of("bruneton")));
    EXPECT_LT(measure_error(tables, wanted).error, 0.006) << view.name;
  }
}

TEST(Composite, TransmittancesOfChannelsAreNoneOfASunThatLacksTheirColour) {
  const json suns[] = {0,
                       {{"wavelengths_nm", {500, 545, 590}}, {"values", {0, 1, 0}}},
                       {{"wavelengths_nm", {360, 830}}, {"values", {1, 1}}}};
  for (const json& irradiance : suns) {
    const Scene scene = read_scene({{"sun", {{"irradiance", irradiance}}}});
    const std::vector<double> nm = colour_wavelengths(24);
    for (const std::vector<double>& row : transmittance_rows(scene, nm)) {
      for (double depth : {0.0, 0.3, 3.0}) {
        double through = 0;  // air that dims as Rayleigh's does
        for (std::size_t w = 0; w < nm.size(); ++w)
          through += row[w] * std::exp(-depth * std::pow(550 / nm[w], 4));
        EXPECT_GE(through, -0.01) << irradiance << ", " << depth;
        EXPECT_LE(through, 1.0 + 1e-9) << irradiance << ", " << depth;
        if (depth == 0) {
          EXPECT_NEAR(through, 1, 1e-9) << irradiance;
        }
      }
    }
  }
}

TEST(Composite, ThePlanOfOnePictureIsNoneForAnotherAsFarAway) {
  json document{{"method", {{"name", "auto"}, {"max_error", 0.01}}}};
  const Scene scene = scene_with(document);
  const Plan bright = device().plan(scene, picture_of(1e6f, 20));
  const Plan black = device().plan(scene, picture_of(0, 20));
  EXPECT_LT(bright.expected_error, 1e-4);
  EXPECT_GT(black.expected_error, 1e-4);
}

}  // namespace
}  // namespace cyanometer
