// What varies from frame to frame, and that nothing else does.
#include "server/load/variation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "engine/scene/document.h"

namespace cyanometer::testing {
namespace {

using nlohmann::json;

constexpr std::size_t far_on = std::size_t{1} << 30;  ///< as far as a run may begin

/// The parts of the whole scene that are not as they are in the first frame.
std::set<std::string> changed(const Motion& motion, std::size_t number) {
  const json before = canonical(read_scene(motion.frame(0)));
  const json after = canonical(read_scene(motion.frame(number)));
  std::set<std::string> parts;
  for (const auto& [part, value] : before.items()) {
    if (after.at(part) != value) parts.insert(part);
  }
  return parts;
}

TEST(Variation, EachChangesItsPartAlone) {
  using Parts = std::set<std::string>;
  const std::map<std::string, Parts> expected{{"nothing", {}},
                                              {"exposure", {"image"}},
                                              {"camera", {"camera"}},
                                              {"sun", {"sun"}},
                                              {"atmosphere", {"atmosphere"}},
                                              {"everything", {"atmosphere", "camera", "sun"}}};
  ASSERT_EQ(expected.size(), variation_names().size());
  for (const auto& [name, parts] : expected) {
    EXPECT_EQ(changed({{{"preset", "mars"}}, variation_of(name)}, 40), parts) << name;
  }
}

TEST(Variation, NamesReadBack) {
  for (const std::string& name : variation_names()) {
    EXPECT_EQ(name_of(variation_of(name)), name);
  }
}

TEST(Variation, NoTwoFramesOfAMotionAreEqual) {
  for (const char* format : {"png", "exr"}) {
    for (const std::string& name : variation_names()) {
      if (name == "nothing") continue;
      const Motion motion({{"image", {{"format", format}}}}, variation_of(name));
      std::set<std::string> seen;
      for (const std::size_t first : {std::size_t{0}, far_on}) {
        for (std::size_t i = 0; i < 260; ++i) {
          seen.insert(canonical(read_scene(motion.frame(first + i))).dump());
        }
      }
      EXPECT_EQ(seen.size(), 520u) << name << ", " << format;
    }
  }
}

TEST(Variation, EveryFrameOfEveryPresetIsAScene) {
  for (const Preset& preset : presets()) {
    for (const std::string& name : variation_names()) {
      const Motion motion({{"preset", preset.name}}, variation_of(name));
      for (std::size_t i = 0; i < 250; i += 7) {
        EXPECT_NO_THROW(read_scene(motion.frame(i)))
            << preset.name << ", " << name << ", " << i;
      }
    }
  }
}

TEST(Variation, AnglesStayWithinWhatScenesMaySay) {
  const json edge{{"sun", {{"elevation_deg", 90}, {"azimuth_deg", -360}}},
                  {"camera", {{"heading_deg", 360}, {"pitch_deg", -90}, {"altitude_km", 1e6}}}};
  const Motion motion(edge, Variation::everything);
  for (std::size_t i = 0; i < 250; ++i) EXPECT_NO_THROW(read_scene(motion.frame(i))) << i;
}

TEST(Variation, MotionIsSmooth) {
  const Motion motion(json::object(), Variation::sun);
  const auto elevation = [&](std::size_t i) {
    return motion.frame(i).at("sun").at("elevation_deg").get<double>();
  };
  double least = 90, most = -90;
  for (std::size_t i = 0; i < 250; ++i) {
    EXPECT_LT(std::fabs(elevation(i + 1) - elevation(i)), 0.2) << i;
    least = std::min(least, elevation(i));
    most = std::max(most, elevation(i));
  }
  EXPECT_NEAR(least, 20, 0.2);
  EXPECT_NEAR(most, 40, 0.2);
}

/// All amounts of all constituents by the same factor, in whichever form they are given.
TEST(Variation, TheAirBecomesThinnerAndNothingElse) {
  const json constituents = json::parse(R"({
    "air": {"pressure_pa": 50000},
    "aerosol": {"optical_depth": {"wavelengths_nm": [400, 700], "values": [0.2, 0.1]}},
    "ozone": {"dobson_units": 200},
    "fog": {"type": "particles", "visibility_km": 8, "single_scattering_albedo": 0.9,
            "phase": {"type": "henyey_greenstein", "g": 0.8},
            "profile": {"type": "exponential", "scale_height_km": 1}}})");
  const Motion motion({{"atmosphere", {{"constituents", constituents}}}},
                      Variation::atmosphere);
  const json thick = motion.frame(0).at("atmosphere").at("constituents");
  const json thin = motion.frame(121).at("atmosphere").at("constituents");
  const auto ratio = [&](const std::string& pointer) {
    const json::json_pointer at(pointer);
    return thin.at(at).get<double>() / thick.at(at).get<double>();
  };
  const double share = ratio("/air/pressure_pa");
  EXPECT_NEAR(share, 0.8, 0.01);
  for (const char* amount : {"/aerosol/optical_depth/values/0",
                             "/aerosol/optical_depth/values/1", "/ozone/dobson_units"}) {
    EXPECT_NEAR(ratio(amount), share, 1e-12) << amount;
  }
  EXPECT_NEAR(ratio("/fog/visibility_km"), 1 / share, 1e-12);
  for (const char* other : {"/fog/single_scattering_albedo", "/fog/phase/g",
                            "/aerosol/optical_depth/wavelengths_nm/0", "/air/temperature_k"}) {
    EXPECT_EQ(ratio(other), 1) << other;
  }
}

}  // namespace
}  // namespace cyanometer::testing
