// One scene, one document.
#include "random_document.h"
#include "scene_testing.h"

namespace cyanometer {
namespace {

void expect_reads_back(const Scene& scene) {
  const Json document = canonical(scene);
  const auto error = refusal(document);
  ASSERT_FALSE(error) << error->what() << "\n" << document;
  const Scene again = read_scene(document);
  EXPECT_EQ(again, scene) << document;
  EXPECT_EQ(canonical(again).dump(), document.dump());
}

TEST(Canonical, PresetsReadBackAsThemselves) {
  for (const Preset& preset : presets()) {
    SCOPED_TRACE(preset.name);
    expect_reads_back(read_scene({{"preset", preset.name}}));
  }
}

TEST(Canonical, RandomDocumentsReadBackAsThemselves) {
  RandomDocument random(scene_schema(), 1);
  int read = 0, tried = 0;
  for (; read < 1000 && tried < 20000; ++tried) {
    const Json document = random.next();
    if (const auto error = refusal(document)) {
      EXPECT_FALSE(error->allowed.empty()) << document;
      continue;
    }
    ++read;
    expect_reads_back(read_scene(document));
    if (HasFatalFailure() || HasNonfatalFailure()) FAIL() << document;
  }
  EXPECT_EQ(read, 1000) << "of " << tried;
}

TEST(Canonical, ADocumentIsTheSameInEveryOrderAndSpelling) {
  const std::string bytes = canonical(scene_of(R"({"sun": {"azimuth_deg": -0.0},
      "planet": {"radius_km": 6.36e3}, "image": {"width": 1280.0, "show": ["ground", "stars", "sun"]}})"))
                                .dump();
  EXPECT_EQ(bytes, canonical(scene_of("{}")).dump());
}

TEST(Canonical, NumbersAreWrittenAsShortAsTheyReadBack) {
  const std::string bytes =
      canonical(scene_of(R"({"planet": {"ground_albedo": 0.30000000000000004, "radius_km": 1e7},
                             "sun": {"elevation_deg": 1e-1}})"))
          .dump();
  EXPECT_NE(bytes.find(R"("ground_albedo":0.30000000000000004)"), std::string::npos) << bytes;
  EXPECT_NE(bytes.find(R"("radius_km":10000000)"), std::string::npos) << bytes;
  EXPECT_NE(bytes.find(R"("elevation_deg":0.1,)"), std::string::npos) << bytes;
}

TEST(Canonical, ItHasEveryMemberThatIsNotIdle) {
  const Json document = canonical(scene_of("{}"));
  EXPECT_FALSE(document.contains("preset"));
  EXPECT_EQ(document["sun"]["irradiance"], "solar");
  EXPECT_EQ(document["method"]["max_error"], 0.02);
  EXPECT_EQ(document["method"]["scattering_orders"], "all");
  EXPECT_EQ(document["image"]["exposure_ev"], "auto");
  EXPECT_EQ(document["spectrum"]["wavelengths_nm"], "auto");
  EXPECT_EQ(document["planet"]["surface"], (Json{{"type", "uniform"}}));

  const Json panorama = canonical(scene_of(
      R"({"camera": {"projection": "cubemap"}, "image": {"format": "exr"}, "method": {"name": "nishita"}})"));
  EXPECT_FALSE(panorama["camera"].contains("fov_deg"));
  EXPECT_FALSE(panorama["image"].contains("tone_map"));
  EXPECT_EQ(panorama["image"]["layers"], Json::array());
  EXPECT_FALSE(panorama["method"].contains("max_error"));
  EXPECT_EQ(panorama["method"]["view_samples"], 64);
}

TEST(Canonical, ConstituentsOfEarthThatAreNotThereAreNull) {
  const Json document =
      canonical(scene_of(R"({"atmosphere": {"constituents": {"ozone": null}}})"));
  const Json& constituents = document["atmosphere"]["constituents"];
  ASSERT_TRUE(constituents.contains("ozone"));
  EXPECT_TRUE(constituents["ozone"].is_null());
}

TEST(Canonical, APlaceIsResolvedToAngles) {
  const Json document =
      canonical(scene_of(R"({"sun": {"place": {"latitude_deg": 48, "longitude_deg": 2,
                                          "time": "2024-06-20T12:00:00Z"}}})"));
  EXPECT_FALSE(document["sun"].contains("place"));
  EXPECT_GT(document["sun"]["elevation_deg"], 60);
  EXPECT_EQ(document["camera"]["latitude_deg"], 48);
  EXPECT_NEAR(document["camera"]["sidereal_time_deg"], 89, 1);  // 6 h in the south at midday
}

}  // namespace
}  // namespace cyanometer
