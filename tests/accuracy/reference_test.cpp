#include "engine/accuracy/reference.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/accuracy/error.h"
#include "engine/scene/document.h"
#include "tests/accuracy/temporary_folder.h"
#include "tests/device.h"
#include "tests/surface/testing.h"

namespace cyanometer {
namespace {

using testing::TemporaryFolder;

Scene green_scene(const nlohmann::json& more = nlohmann::json::object()) {
  nlohmann::json document{{"spectrum", {{"wavelengths_nm", {550}}}},
                          {"image", {{"width", 32}, {"height", 18}}}};
  document.merge_patch(more);
  return read_scene(document);
}

std::filesystem::path only_file(const TemporaryFolder& folder) {
  return std::filesystem::directory_iterator(folder.path())->path();
}

TEST(Reference, IsTwoHalvesWithNothingInCommonThatGetCloserWithTheWalks) {
  TemporaryFolder folder;
  Reference few = make_reference(device(), green_scene(), {64, 1e-9, 256}, folder.path());
  Reference many = make_reference(device(), green_scene(), {64, 1e-9, 4096}, folder.path());
  EXPECT_EQ(few.walks, 256);
  EXPECT_EQ(many.walks, 4096);
  EXPECT_NE(many.halves[0], many.halves[1]);
  // 16 times the walks are a quarter of the noise; that itself is known to a third.
  EXPECT_LT(many.noise, few.noise / 2);
}

TEST(Reference, SharesNoWalksWithThePathThatIsHeldAgainstIt) {
  Reference few = make_reference(device(), green_scene(), {64, 1e-9, 256}, "");
  Plan plan;
  plan.method = "path";
  plan.wavelengths_nm = {550};
  plan.options = {{"samples_per_pixel", 256}, {"seed", 0}};
  auto seen = device().radiance(green_scene(), few.directions, false, plan).relative;
  const double apart = measure_error(few.halves[0], few.halves[1]).error;
  for (const auto& half : few.halves) EXPECT_GT(measure_error(seen, half).error, apart / 2);
}

TEST(Reference, StopsWhenItIsGoodEnough) {
  TemporaryFolder folder;
  Reference reference =
      make_reference(device(), green_scene(), {64, 0.5, 1 << 20}, folder.path());
  EXPECT_EQ(reference.walks, 256);
}

TEST(Reference, OfOneOrderHasNoNoise) {
  TemporaryFolder folder;
  Scene single = green_scene({{"method", {{"scattering_orders", 1}}}});
  Reference reference = make_reference(device(), single, {64, 1e-9, 1 << 20}, folder.path());
  EXPECT_EQ(reference.noise, 0);
  EXPECT_EQ(reference.walks, 256);
}

TEST(Reference, GoesOnWhereItWasStoppedAndIsTheSame) {
  TemporaryFolder folder, other;
  Watch watch;
  watch.gone = [&] { return !std::filesystem::is_empty(folder.path()); };
  EXPECT_THROW(make_reference(device(), green_scene(), {64, 1e-9, 1024}, folder.path(), watch),
               Cancelled);
  ASSERT_FALSE(std::filesystem::is_empty(folder.path())) << "the first pass was lost";
  Reference resumed = make_reference(device(), green_scene(), {64, 1e-9, 1024}, folder.path());
  Reference at_once = make_reference(device(), green_scene(), {64, 1e-9, 1024}, other.path());
  EXPECT_EQ(resumed.halves, at_once.halves);
}

TEST(Reference, DoesNotBelieveAFileThatIsNotItsOwn) {
  TemporaryFolder folder;
  Reference whole = make_reference(device(), green_scene(), {64, 1e-9, 256}, folder.path());
  std::filesystem::path file = only_file(folder);
  for (const char* text : {"", "{", "{\"identity\": 1}", "[]"}) {
    std::ofstream(file) << text;
    EXPECT_EQ(make_reference(device(), green_scene(), {64, 1e-9, 256}, folder.path()).halves,
              whole.halves);
  }
  std::ifstream in(file);
  nlohmann::json kept = nlohmann::json::parse(in);
  kept["halves"][0].erase(3);
  std::ofstream(file) << kept;
  EXPECT_EQ(make_reference(device(), green_scene(), {64, 1e-9, 256}, folder.path()).halves,
            whole.halves);
}

TEST(Reference, DoesNotDependOnMethodAndDisplay) {
  TemporaryFolder folder;
  make_reference(device(), green_scene(), {64, 0.5, 256}, folder.path());
  make_reference(
      device(),
      green_scene({{"method", {{"name", "nishita"}}}, {"image", {{"exposure_ev", 3}}}}),
      {64, 0.5, 256}, folder.path());
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(Reference, OfAMapIsAnotherOnceItsFileIs) {
  TemporaryFolder folder;
  surface_testing::Maps maps;
  Scene over_map =
      green_scene({{"planet", {{"surface", {{"type", "map"}, {"albedo", "m.exr"}}}}}});
  auto files = [&](double grey) {
    maps.write("m.exr", surface_testing::grey_map(grey));
    make_reference(device(), over_map, {16, 0.5, 256}, folder.path());
    return std::distance(std::filesystem::directory_iterator(folder.path()), {});
  };
  EXPECT_EQ(files(0.2), 1);
  EXPECT_EQ(files(0.25), 2);
}

}  // namespace
}  // namespace cyanometer
