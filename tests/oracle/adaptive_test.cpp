#include "engine/accuracy/adaptive.h"

#include <gtest/gtest.h>

#include "tests/oracle/scenes.h"

namespace cyanometer::oracle {
namespace {

TEST(AdaptiveOracle, AgreesWithPublishedSingleScatteringInTheSphericalShell) {
  double worst = 0;
  nlohmann::json reference = published("single_scattering.json");
  ASSERT_EQ(reference["rows"].size(), 272u);
  for (const auto& row : reference["rows"]) {
    Scene scene = reference_scene(row[0].get<double>() / 1000, row[1], 0.3);
    Problem problem = make_problem(scene, scene.spectrum.wavelengths_nm);
    Ray ray = Adaptive(pack<double>(problem)).trace(towards(row[2], row[3]));
    for (int w = 0; w < 3; ++w) {
      double radiance = row[4][w], transmittance = row[5][w];
      double ground = row[6].is_null() ? 0 : row[6][w].get<double>();
      EXPECT_NEAR(ray.inscatter[w], radiance, 1e-6 * radiance + 1e-12) << row;
      EXPECT_NEAR(ray.transmittance[w], transmittance, 1e-7 * transmittance + 1e-15) << row;
      EXPECT_NEAR(ray.ground[w], ground, 1e-7 * ground + 1e-15) << row;
      if (radiance > 1e-9) {
        worst = std::max(worst, std::abs(ray.inscatter[w] / radiance - 1));
      }
    }
  }
  RecordProperty("worst_relative_difference", std::to_string(worst));
  std::printf("worst relative difference %.2e\n", worst);
}

}  // namespace
}  // namespace cyanometer::oracle
