#include <gmock/gmock.h>

#include <filesystem>
#include <future>
#include <latch>
#include <numbers>

#include "engine/accuracy/adaptive.h"
#include "engine/accuracy/error.h"
#include "engine/accuracy/precision.h"
#include "engine/attention.h"
#include "tests/scene/scene_testing.h"
#include "tests/surface/testing.h"

namespace cyanometer::surface_testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::vector<Direction> downwards() {
  std::vector<Direction> all;
  for (double elevation : {-89.0, -60.0, -30.0, -15.0}) {
    for (double azimuth : {10.0, 130.0, 250.0}) all.push_back({elevation, azimuth});
  }
  return all;
}

using Samples = std::vector<std::vector<double>>;

Samples radiance_of(const Scene& scene, const std::vector<Direction>& directions) {
  return device().radiance(scene, directions, false).radiance;
}

/// Largest relative difference.
double largest_difference(const Samples& a, const Samples& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t w = 0; w < a[i].size(); ++w) {
      largest = std::max(largest, std::abs(a[i][w] / b[i][w] - 1));
    }
  }
  return largest;
}

Scene uniform(const Scene& like, double albedo) {
  Scene scene = like;
  scene.planet.surface = UniformSurface{};
  scene.planet.ground_albedo = albedo;
  return scene;
}

// The sun's own light comes to the ground through all of the air: what the tables of hillaire
// and moments take for not scattered, because it goes nearly straight on, is missing in it; and
// nishita's own ground is as coarse as its light samples.
TEST(Surface, OfOneMatterIsUniformGroundByEveryMethod) {
  for (const MethodDescription& method : methods()) {
    Scene scene = scene_on(even_world(0.3), 2, 30, method.name);
    if (method.name == "path") scene.method.options["samples_per_pixel"] = 32;
    if (method.name == "nishita") scene.method.options["light_samples"] = 400;
    double difference = largest_difference(radiance_of(scene, downwards()),
                                           radiance_of(uniform(scene, 0.3), downwards()));
    double bound = method.name == "hillaire" ? 1e-2 : method.name == "moments" ? 4e-3 : 1e-3;
    EXPECT_LT(difference, bound) << method.name;
  }
}

TEST(Surface, WithoutAirIsLambertian) {
  Scene scene = without_air(scene_on(even_world(0.5), 3, 25));
  Samples seen = radiance_of(scene, {{-90, 0}});
  EXPECT_NEAR(seen[0][1], 0.5 / std::numbers::pi * std::sin(glm::radians(25.0)), 1e-5);
}

// ---- Against the adaptive integration, from 1 km to deep space

TEST(Surface, IsTheAdaptiveIntegralFrom1KilometreTo36000) {
  ProceduralSurface land;
  land.sea_fraction = 0;
  for (const char* method : {"raymarch", "path", "bruneton"}) {
    for (double altitude_km : {1.0, 10.0, 400.0, 36000.0}) {
      Scene scene = scene_on(land, altitude_km, 40, method);
      scene.method.scattering_orders = 1;
      Problem problem = make_problem(scene, scene.spectrum.wavelengths_nm);
      P p = pack<double>(problem);
      oracle::Adaptive integral(p);
      std::vector<Direction> directions;
      double horizon = -glm::degrees(std::acos(6360 / (6360 + altitude_km)));
      for (double share : {0.1, 0.4, 0.7, 0.95}) {
        directions.push_back({horizon + (-90 - horizon) * share, 77 * share});
      }
      Samples seen = radiance_of(scene, directions);
      for (std::size_t i = 0; i < directions.size(); ++i) {
        glm::dvec3 towards =
            oracle::towards(directions[i].elevation_deg, directions[i].azimuth_deg);
        oracle::Ray ray = integral.trace(towards);
        P::Path path = p.path_from_camera(towards);
        glm::dvec3 end = path.start + path.direction * path.length_km;
        double from_km = glm::length(end - glm::dvec3(0, 0, 6360 + altitude_km));
        double share[P::MATTERS];
        p.look_at_ground(glm::normalize(end), p.pixel_width_km(from_km), share);
        for (std::size_t w = 0; w < 3; ++w) {
          double ground = ray.ground[w] * p.dry_albedo(share, 0)[static_cast<int>(w)] /
                          problem.ground_albedo[w];
          EXPECT_NEAR(seen[i][w], ray.inscatter[w] + ground, 2e-3 * (ray.inscatter[w] + ground))
              << method << ", " << altitude_km << " km, ray " << i;
        }
      }
    }
  }
}

// ---- Energy

TEST(Surface, ThatIsWhiteSendsBackAllThatFallsOnIt) {
  for (const char* method : {"moments", "bruneton", "path"}) {
    Scene scene = scene_on(even_world(1), 0, 40, method);
    if (std::string(method) == "path") scene.method.options["samples_per_pixel"] = 64;
    auto flux = device().radiance(scene, {{90, 0}}, true).irradiance.value();
    for (std::size_t w = 0; w < 3; ++w) {
      double down = flux.direct[w] + flux.diffuse_down[w];
      EXPECT_NEAR(flux.diffuse_up[w] / down, 1, 0.02) << method;
    }
  }
}

// ---- What tables take for the ground between the camera's and the sun's own light

TEST(Surface, InTablesIsWithinAFewPercentOfWalksThatMeetItTruly) {
  ProceduralSurface world;
  world.seed = 3;
  Scene scene = scene_on(world, 400, 50, "path");
  scene.method.options["samples_per_pixel"] = 128;
  std::vector<Direction> directions;
  for (int i = 0; i < 40; ++i) directions.push_back({-89.0 + 1.7 * i, 137.5 * i});
  std::array<Samples, 2> walks;
  for (int half : {0, 1}) {
    scene.method.options["seed"] = half;
    walks[half] = radiance_of(scene, directions);
  }
  for (const char* method : {"moments", "bruneton"}) {
    Samples tables = radiance_of(scene_on(world, 400, 50, method), directions);
    EXPECT_LT(measure_error(tables, walks[0], walks[1]).measure.error, 0.05) << method;
  }
}

TEST(Surface, ShowsTheGlintOfTheSunWhereTheSeaMirrorsIt) {
  ProceduralSurface sea;
  sea.sea_fraction = 1;
  sea.ice_latitude_deg = 90;
  Scene scene = without_air(scene_on(sea, 3, 30));
  P p = pack<double>(make_problem(scene, scene.spectrum.wavelengths_nm));
  glm::dvec3 sun = oracle::towards(30, 0);
  for (double azimuth : {0.0, 40.0, 180.0}) {
    glm::dvec3 view = oracle::towards(-30, azimuth);
    double share[P::MATTERS] = {1};
    P::Path path = p.path_from_camera(view);
    glm::dvec3 up = glm::normalize(path.start + view * path.length_km);
    double expected = p.reflected_beam({up, 1, up}, share, sun, -view, 0)[1];
    EXPECT_NEAR(radiance_of(scene, {{-30, azimuth}})[0][1], expected, 2e-3 * expected + 1e-6);
  }
  EXPECT_GT(radiance_of(scene, {{-30, 0}})[0][1], 20 * radiance_of(scene, {{-30, 180}})[0][1]);
}

// ---- Heights

/// A ridge along a meridian, a tent of `height_km` over `half_km` to each side.
std::string ridge_map(double half_km, double radius_km, int width) {
  return map_file(width, {"Y"}, [&](int x, int) {
    double away_km = 2 * std::numbers::pi * std::abs(x - width / 2) / width * radius_km;
    return std::max(0.0, 1 - away_km / half_km);
  });
}

/// Of its crest, which is the first texel east of longitude 0.
double crest_longitude(int width) { return std::numbers::pi / width; }

/// Where the shadow of a ridge of height h ends, as an angle at the planet's centre, under a
/// sun of elevation e there: the sine rule in the triangle of the centre, the crest and the
/// end.
double shadow_angle(double radius_km, double height_km, double elevation_rad) {
  double at_end = std::numbers::pi / 2 + elevation_rad;
  double at_crest = std::asin(radius_km * std::sin(at_end) / (radius_km + height_km));
  return std::numbers::pi - at_end - at_crest;
}

TEST(Heights, CastAShadowAsLongAsTheClosedFormSays) {
  constexpr double radius_km = 500, height_km = 4, half_km = 8;
  Maps maps;
  maps.write("grey.exr", grey_map(0.5));
  maps.write("ridge.exr", ridge_map(half_km, radius_km, 2048));
  Scene scene = without_air(scene_on(MapSurface{"grey.exr", "ridge.exr", height_km}, 60, 0));
  scene.planet.radius_km = radius_km;
  scene.camera.latitude_deg = 0;
  scene.sun.azimuth_deg = 90;  // in the east of the ridge; its shadow falls to the west
  scene.sun.angular_diameter_deg = 0.01;
  scene.camera.projection = Projection::perspective;
  scene.camera.fov_deg = 60;
  scene.image.height = 1024;
  scene.image.width = 1024;
  for (double elevation : {8.0, 12.0, 20.0}) {
    // The camera stands where the shadow is to end, and looks across its edge.
    double end = shadow_angle(radius_km, height_km, glm::radians(elevation));
    scene.camera.longitude_deg = glm::degrees(crest_longitude(2048) - end);
    scene.sun.elevation_deg = elevation;
    double pixel_deg = glm::degrees(2 * std::tan(glm::radians(30.0)) / 1024);
    std::vector<Direction> directions;
    for (int i = -6; i <= 6; ++i) {
      double angle = (i + 0.01) * pixel_deg;
      directions.push_back({-90 + std::abs(angle), angle > 0 ? 90.0 : 270.0});
    }
    Samples seen = radiance_of(scene, directions);
    double lit = seen.front()[1];
    EXPECT_NEAR(lit, 0.5 / std::numbers::pi * std::sin(glm::radians(elevation)), 0.02 * lit);
    double edge = 0;  // in pixels towards the ridge from where the closed form has it
    for (std::size_t i = 0; i < seen.size(); ++i) edge += seen[i][1] / lit;
    EXPECT_NEAR(edge, 6.5, 1) << "sun at " << elevation;
    EXPECT_NEAR(seen.back()[1], 0, 0.01 * lit);
  }
}

/// How high the air above a place is in that shadow: the same triangle, the crest seen from the
/// planet's centre at an angle towards the sun.
double shadow_height_km(double radius_km, double height_km, double elevation_rad,
                        double angle) {
  return (radius_km + height_km) * std::cos(elevation_rad + angle) / std::cos(elevation_rad) -
         radius_km;
}

TEST(Heights, ShadeTheAirAsHighAsTheClosedFormSays) {
  constexpr double radius_km = 500, height_km = 4, half_km = 8, top_km = 10;
  Maps maps;
  maps.write("grey.exr", grey_map(0.5));
  maps.write("ridge.exr", ridge_map(half_km, radius_km, 2048));
  for (const char* method : {"raymarch", "path", "bruneton"}) {
    Scene scene = scene_on(MapSurface{"grey.exr", "ridge.exr", height_km}, 0, 0, method);
    scene.method.scattering_orders = 1;
    if (std::string(method) != "path") scene.method.options["view_nodes"] = 24;
    scene.planet.radius_km = radius_km;
    // So thin that light from above comes in proportion to the air that is lit.
    scene.atmosphere.thickness_km = top_km;
    Molecules thin;
    thin.optics = ScatteringCoefficient{1e-6};
    scene.atmosphere.constituents = {{"air", {UniformProfile{}, thin}}};
    scene.camera.latitude_deg = 0;
    scene.sun.azimuth_deg = 90;
    scene.sun.elevation_deg = 8;
    for (double angle_deg : {1.1, 1.5, 2.0}) {
      scene.camera.longitude_deg = glm::degrees(crest_longitude(2048)) - angle_deg;
      double lit = radiance_of(uniform(scene, 0.5), {{90, 0}})[0][1];
      double dark_km =
          shadow_height_km(radius_km, height_km, glm::radians(8.0), glm::radians(angle_deg));
      EXPECT_NEAR(radiance_of(scene, {{90, 0}})[0][1] / lit, 1 - dark_km / top_km, 0.02)
          << method << ", " << angle_deg << " deg from the crest";
    }
  }
}

TEST(Heights, StandInTheWayOfWhatIsBehindThem) {
  constexpr double radius_km = 500;
  Maps maps;
  maps.write("grey.exr", grey_map(0.5));
  maps.write("ridge.exr", ridge_map(8, radius_km, 2048));
  Scene scene = scene_on(MapSurface{"grey.exr", "ridge.exr", 4}, 0.5, 60);
  scene.planet.radius_km = radius_km;
  scene.camera.latitude_deg = 0;
  // 17.45 km of arc west of the crest.
  scene.camera.longitude_deg = glm::degrees(crest_longitude(2048)) - 2;
  Problem problem = make_problem(scene, scene.spectrum.wavelengths_nm);
  EXPECT_NEAR(problem.camera.altitude_km, 0.5, 1e-3) << "it stands on the plain";
  // Above the crest there is air, below it the ridge's own light through far less of it.
  double crest_deg = glm::degrees(std::atan(((500 + 4) * std::cos(glm::radians(2.0)) - 500.5) /
                                            (504 * std::sin(glm::radians(2.0)))));
  auto result = device().radiance(scene, {{crest_deg + 0.3, 90}, {crest_deg - 0.3, 90}}, false);
  double to_crest = -std::log(result.transmittance[1][2]);
  EXPECT_GT(-std::log(result.transmittance[0][2]), 2 * to_crest);
  EXPECT_NEAR(to_crest, 0.5 * (0.0331 + 0.0044) * 17.6, 0.6);
  scene.camera.longitude_deg = glm::degrees(crest_longitude(2048));
  EXPECT_NEAR(make_problem(scene, scene.spectrum.wavelengths_nm).camera.altitude_km, 4.5, 1e-3)
      << "and on the crest";
}

TEST(Heights, LeaveLayersThatAddUpToTheFrame) {
  ProceduralSurface world;
  world.relief_km = 6;
  for (const char* method : {"raymarch", "hillaire", "moments"}) {
    Scene scene = scene_on(world, 5, 15, method);
    scene.camera.pitch_deg = -10;
    scene.image.format = ImageFormat::exr;
    scene.image.layers = {true, true, true, true};
    scene.image.width = 48;
    scene.image.height = 27;
    Frame frame = device().render(scene);
    auto plane = [&](const std::string& name) {
      for (const Frame::Plane& each : frame.planes)
        if (each.channel == name) return each.samples;
      throw std::logic_error(name);
    };
    bool some_ground = false;
    for (int i = 0; i < 48 * 27; ++i) {
      double sum = plane("inscatter.G")[i] + plane("ground.G")[i] + plane("sun.G")[i];
      EXPECT_NEAR(plane("G")[i], sum, 1e-5 * sum) << method;
      some_ground = some_ground || plane("ground.G")[i] > 0;
      EXPECT_GE(plane("ground.G")[i], 0);
    }
    EXPECT_TRUE(some_ground) << method;
  }
}

TEST(Heights, NearTheCameraAreAsExactAsOnATinyPlanet) {
  PrecisionTrial trial("llvmpipe");  // whose rounding can be turned
  Scene scene = read_scene({{"preset", "earth_mountains"},
                            {"image", {{"width", 320}, {"height", 180}}},
                            {"spectrum", {{"wavelengths_nm", {550}}}}});
  EXPECT_LT(trial.measure(scene, "raymarch", {}).error, 5e-3);
}

TEST(Heights, DoNotDependOnHowTheWorkIsCut) {
  ProceduralSurface world;
  world.relief_km = 6;
  Scene scene = scene_on(world, 3, 15, "hillaire");
  Engine slicing({.device = "", .longest_dispatch_ms = 1e-4});
  EXPECT_EQ(slicing.radiance(scene, downwards(), false).radiance,
            radiance_of(scene, downwards()));
}

// ---- Maps

TEST(Maps, OfOneColourAreUniformGround) {
  Maps maps;
  maps.write("grey.exr", grey_map(0.25));
  Scene scene = scene_on(MapSurface{"grey.exr", "", 8}, 2, 30, "bruneton");
  EXPECT_LT(largest_difference(radiance_of(scene, downwards()),
                               radiance_of(uniform(scene, 0.25), downwards())),
            3e-3);
}

TEST(Maps, HaveLongitude0InTheMiddleAndNorthAtTheTop) {
  Maps maps;
  maps.write("parts.exr", map_file(64, {"R", "G", "B"}, [](int x, int y) {
               return x < 32 ? (y < 16 ? 0.1 : 0.2) : (y < 16 ? 0.3 : 0.4);
             }));
  Scene scene = without_air(scene_on(MapSurface{"parts.exr", "", 8}, 1, 90));
  auto at = [&](double latitude, double longitude) {
    scene.camera.latitude_deg = latitude;
    scene.camera.longitude_deg = longitude;
    return radiance_of(scene, {{-90, 0}})[0][1] * std::numbers::pi;
  };
  EXPECT_NEAR(at(40, -90), 0.1, 1e-3);
  EXPECT_NEAR(at(-40, -90), 0.2, 1e-3);
  EXPECT_NEAR(at(40, 90), 0.3, 1e-3);
  EXPECT_NEAR(at(-40, 90), 0.4, 1e-3);
}

/// Why a scene on a map is refused, and where.
SceneError refusal_of(const MapSurface& map) {
  try {
    make_problem(scene_on(map, 1, 30), {680, 550, 440});
  } catch (const SceneError& error) {
    return error;
  }
  return {"", "", "", "accepted"};
}

TEST(Maps, AreRefusedWithTheMemberWhereTheyAreNotThere) {
  EXPECT_EQ(refusal_of({"a.exr", "", 8}).pointer, "/planet/surface/albedo");
  EXPECT_THAT(refusal_of({"a.exr", "", 8}).what(), HasSubstr("no folder"));
  Maps maps;
  maps.write("grey.exr", grey_map(0.25));
  EXPECT_THAT(refusal_of({"a.exr", "", 8}).what(), HasSubstr("no such file"));
  EXPECT_EQ(refusal_of({"grey.exr", "a.exr", 8}).pointer, "/planet/surface/height");
  maps.write("text.png", "not an image");
  EXPECT_THAT(refusal_of({"text.png", "", 8}).what(), HasSubstr("PNG cannot be read"));
  maps.write("square.exr", cyanometer::testing::picture_file(8, 8,
                                                             {{"R", std::vector<float>(64)},
                                                              {"G", std::vector<float>(64)},
                                                              {"B", std::vector<float>(64)}}));
  EXPECT_THAT(refusal_of({"square.exr", "", 8}).what(), HasSubstr("twice as wide"));
  maps.write("bright.exr", grey_map(1.5));
  EXPECT_THAT(refusal_of({"bright.exr", "", 8}).what(), HasSubstr("from 0 to 1"));
}

TEST(Maps, AreNotReadOutsideTheirFolder) {
  Maps maps;
  cyanometer::testing::TemporaryFolder elsewhere;
  std::ofstream(elsewhere / "grey.exr", std::ios::binary) << grey_map(0.25);
  fs::create_symlink(elsewhere / "grey.exr", maps.folder / "link.exr");
  fs::create_directory(maps.folder / "folder.exr");
  // A neighbour whose name begins as the folder's own does.
  const fs::path beside = maps.folder.path().string() + "-beside.exr";
  std::ofstream(beside, std::ios::binary) << grey_map(0.25);
  fs::create_symlink(beside, maps.folder / "beside.exr");
  EXPECT_THAT(refusal_of({"link.exr", "", 8}).what(), HasSubstr("out of the folder"));
  EXPECT_THAT(refusal_of({"beside.exr", "", 8}).what(), HasSubstr("out of the folder"));
  EXPECT_THAT(refusal_of({"folder.exr", "", 8}).what(), HasSubstr("no such file"));
  fs::remove(beside);
}

// As Kubernetes mounts a ConfigMap: grey.exr -> ..data/grey.exr, ..data -> ..2024_05_01.
TEST(Maps, MayBeLinksWithinTheirFolderToFilesOfAnyName) {
  Maps maps;
  fs::create_directory(maps.folder / "..2024_05_01");
  fs::create_directory_symlink("..2024_05_01", maps.folder / "..data");
  maps.write("..2024_05_01/grey.exr", grey_map(0.25));
  maps.write("..2024_05_01/blob", grey_map(0.25));
  fs::create_symlink("..data/grey.exr", maps.folder / "grey.exr");
  fs::create_symlink("..data/blob", maps.folder / "blob.exr");
  fs::create_symlink("..data/grey.exr", maps.folder / "grey.png");
  EXPECT_THAT(refusal_of({"grey.exr", "", 8}).what(), HasSubstr("accepted"));
  EXPECT_THAT(refusal_of({"blob.exr", "", 8}).what(), HasSubstr("accepted"));
  EXPECT_THAT(refusal_of({"grey.png", "", 8}).what(), HasSubstr("PNG cannot be read"));
}

/// The header of a PNG of so many pixels, and nothing else.
std::string png_of_size(std::uint32_t width, std::uint32_t height) {
  std::string bytes = "\x89PNG\r\n\x1a\n" + std::string("\0\0\0\rIHDR", 8);
  auto append = [&](std::uint32_t v) {
    for (int shift : {24, 16, 8, 0}) bytes += static_cast<char>(v >> shift & 255);
  };
  append(width);
  append(height);
  bytes += std::string("\x08\x02\0\0\0", 5);
  std::uint32_t crc = ~0u;
  for (std::size_t i = 12; i < bytes.size(); ++i) {
    crc ^= static_cast<unsigned char>(bytes[i]);
    for (int k = 0; k < 8; ++k) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
  }
  append(~crc);
  return bytes + std::string("\0\0\0\0IDAT\x35\xaf\x06\x1e", 12);
}

TEST(Maps, ThatAreTooLargeAreRefusedBeforeAnythingIsAllocatedForThem) {
  Maps maps;
  maps.write("bomb.png", png_of_size(100000, 50000));
  EXPECT_THAT(refusal_of({"bomb.png", "", 8}).what(), HasSubstr("100000 x 50000"));
}

// ---- The document

TEST(SurfaceDocument, TakesNamesAndNoPaths) {
  for (const char* name : {"../earth.png", "a/b.png", "/etc/passwd", "earth", "earth.gif",
                           "earth.png.exe", ".png", "e arth.png", ""}) {
    Json document = with("/planet/surface", {{"type", "map"}, {"albedo", name}});
    auto error = refusal(document);
    ASSERT_TRUE(error) << name;
    EXPECT_EQ(error->pointer, "/planet/surface/albedo");
  }
}

TEST(SurfaceDocument, IsReplacedWholeWhereItsTypeChanges) {
  Json base = with("/planet/surface", {{"type", "procedural"}, {"seed", 7}});
  Json patch = with("/planet/surface", {{"type", "map"}, {"albedo", "earth.png"}});
  EXPECT_EQ(merge(base, patch)["planet"]["surface"], patch["planet"]["surface"]);
  Json more = with("/planet/surface/relief_km", 3);
  EXPECT_EQ(merge(base, more)["planet"]["surface"],
            (Json{{"type", "procedural"}, {"seed", 7}, {"relief_km", 3}}));
}

TEST(SurfaceDocument, LeavesTheUniformAlbedoIdle) {
  Scene scene =
      read_scene({{"planet", {{"ground_albedo", 0.5}, {"surface", {{"type", "procedural"}}}}}});
  EXPECT_FALSE(canonical(scene)["planet"].contains("ground_albedo"));
  EXPECT_EQ(read_scene(canonical(scene)), scene);
}

TEST(SurfaceDocument, IsRefusedWhereItsHeightsStandOutOfTheAir) {
  ProceduralSurface high;
  high.relief_km = 100;
  try {
    make_problem(scene_on(high, 1, 30), {680, 550, 440});
    FAIL() << "accepted";
  } catch (const SceneError& error) {
    EXPECT_EQ(error.pointer, "/planet/surface/relief_km");
  }
}

TEST(SurfaceDocument, SharesTablesWhereOnlyWhatIsSeenOfItDiffers) {
  Scene scene = scene_on(ProceduralSurface{}, 10, 30), turned = scene;
  turned.camera.longitude_deg += 50;
  EXPECT_EQ(atmosphere_key(scene), atmosphere_key(turned));
}

// ---- What is kept of maps

const MapSurface grey{"grey.exr", "", 8}, other{"other.exr", "", 8};

/// Other bytes, which are no image, that pass for the same file: who reads them is refused.
void spoil(const fs::path& file) {
  const auto time = fs::last_write_time(file);
  const auto size = fs::file_size(file);
  std::ofstream(file, std::ios::binary) << std::string(size, 'x');
  fs::last_write_time(file, time);
}

TEST(Maps, LargerThanTheRoomForThemAreReadOnceWhileTheyLive) {
  Maps maps(0);
  maps.write("grey.exr", grey_map(0.5));
  maps.write("other.exr", grey_map(0.2));
  const Problem problem = make_problem(scene_on(grey, 1, 30), {550});
  surface_images(other);
  spoil(maps.folder / "grey.exr");
  EXPECT_EQ(make_problem(scene_on(grey, 1, 30), {550}).ground->images, problem.ground->images);
}

TEST(Maps, LargerThanTheRoomForThemAreKeptUntilAnotherIsUsed) {
  Maps maps(0);
  maps.write("grey.exr", grey_map(0.5));
  maps.write("other.exr", grey_map(0.2));
  for (int i = 0; i < 3; ++i) {
    EXPECT_THAT(refusal_of(grey).what(), HasSubstr("accepted")) << i;
    spoil(maps.folder / "grey.exr");
  }
  surface_images(other);
  EXPECT_THAT(refusal_of(grey).what(), HasSubstr("EXR"));
}

TEST(Maps, AreReadOnceForAllWhoAskAtATime) {
  Maps maps(0);
  maps.write("grey.exr", map_file(1024, {"R", "G", "B"}, [](int, int) { return 0.5; }));
  maps.write("other.exr", grey_map(0.2));
  std::vector<std::future<std::shared_ptr<const SurfaceImages>>> asked;
  std::latch all_are_there(4);
  for (int i = 0; i < 4; ++i) {
    asked.push_back(std::async(std::launch::async, [&] {
      all_are_there.arrive_and_wait();
      auto images = surface_images(grey);
      surface_images(other);
      return images;
    }));
  }
  const auto first = asked.front().get();
  for (std::size_t i = 1; i < asked.size(); ++i) EXPECT_EQ(asked[i].get(), first) << i;
}

// Others may wait for a map that is being read, so its reader takes up no job that may wait for
// them.
TEST(Maps, AreReadWithoutGivingWay) {
  Maps maps;
  maps.write("grey.exr", grey_map(0.5));
  int looks = 0;
  Watch watch;
  watch.gone = [&] { return ++looks > 0; };
  const Attention attention(watch);
  EXPECT_NE(surface_images(grey), nullptr);
  EXPECT_EQ(looks, 0);
}

TEST(Maps, ThatWereReadAreNotReadAgainForTheKeyOfTheirAtmosphere) {
  Maps maps(0);
  maps.write("grey.exr", grey_map(0.5));
  maps.write("other.exr", grey_map(0.2));
  const Scene scene = scene_on(grey, 1, 30);
  const std::string key = atmosphere_key(scene);
  surface_images(other);
  spoil(maps.folder / "grey.exr");
  EXPECT_EQ(atmosphere_key(scene), key);
  EXPECT_NE(atmosphere_key(scene_on(other, 1, 30)), key);
}

}  // namespace
}  // namespace cyanometer::surface_testing
