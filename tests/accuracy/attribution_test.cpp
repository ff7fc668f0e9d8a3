// Where errors come from: settings that are bad in one known way.
#include "engine/accuracy/attribution.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/scene/document.h"
#include "tests/device.h"

namespace cyanometer {
namespace {

using nlohmann::json;

Attribution attribution_of(const json& method, const json& more = json::object()) {
  json document{{"preset", "earth_noon"},
                {"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
                {"image", {{"width", 64}, {"height", 36}}},
                {"method", method}};
  document.update(more, true);
  return attribute(device(), read_scene(document),
                   {.rays = 64, .noise = 0.003, .most_walks = 1024}, {});
}

std::optional<double> share(const Attribution& found, const std::string& cause) {
  const auto at = std::ranges::find(found.shares, cause, &ErrorShare::cause);
  return at == found.shares.end() ? std::nullopt : std::optional(at->error);
}

TEST(Attribution, FewSamplesAreQuadratureAndNothingElse) {
  const Attribution found = attribution_of({{"name", "nishita"},
                                            {"scattering_orders", 1},
                                            {"view_samples", 16},
                                            {"light_samples", 8}});
  // Midpoint rules are of order two: what is left out of the change is a sixteenth.
  EXPECT_NEAR(*share(found, "quadrature"), found.error.measure.error,
              0.2 * found.error.measure.error);
  EXPECT_LT(*share(found, "model"), 0.2 * found.error.measure.error);
  EXPECT_EQ(share(found, "orders"), std::nullopt);
  EXPECT_EQ(share(found, "tables"), std::nullopt);
  EXPECT_EQ(share(found, "wavelengths"), std::nullopt);
  EXPECT_EQ(share(found, "walks"), std::nullopt);
}

TEST(Attribution, OneOrderOfAllIsOrdersLeftOut) {
  const Attribution found = attribution_of({{"name", "raymarch"}});
  EXPECT_NEAR(*share(found, "orders"), found.error.measure.error,
              0.01 * found.error.measure.error);
  EXPECT_LT(*share(found, "quadrature"), 1e-3);
  EXPECT_LT(*share(found, "model"), 1e-3);
}

TEST(Attribution, SmallTablesAreTables) {
  const Attribution found = attribution_of(
      {{"name", "moments"}, {"degree", 4}, {"sky_elevations", 8}, {"sky_azimuths", 4}});
  EXPECT_GT(*share(found, "tables"), 0.7 * found.error.measure.error);
  EXPECT_LT(*share(found, "model"), 0.5 * found.error.measure.error);
  EXPECT_LT(*share(found, "quadrature"), 0.3 * *share(found, "tables"));
}

TEST(Attribution, EvenLightOfHigherOrdersIsTheModel) {
  const Attribution found = attribution_of({{"name", "hillaire"}});
  EXPECT_NEAR(*share(found, "model"), found.error.measure.error,
              0.3 * found.error.measure.error);
  EXPECT_LT(*share(found, "tables"), *share(found, "model"));
  EXPECT_LT(*share(found, "quadrature"), *share(found, "model"));
}

TEST(Attribution, FewWalksAreNoise) {
  const Attribution found = attribution_of({{"name", "path"}, {"samples_per_pixel", 16}});
  EXPECT_NEAR(*share(found, "walks"), found.error.measure.error,
              0.5 * found.error.measure.error);
  EXPECT_EQ(share(found, "model"), std::nullopt);
}

TEST(Attribution, FewWavelengthsOfAColourAreWavelengths) {
  json document{{"preset", "earth_noon"},
                {"image", {{"width", 64}, {"height", 36}}},
                {"method", {{"name", "raymarch"}, {"scattering_orders", 1}}}};
  const Attribution found = attribute(device(), read_scene(document),
                                      {.rays = 32, .noise = 0.01, .most_walks = 256}, {});
  ASSERT_TRUE(share(found, "wavelengths"));
  // The plan has those that its error allows.
  EXPECT_LT(*share(found, "wavelengths"), 0.02);
  EXPECT_GT(*share(found, "wavelengths"), 0);
}

}  // namespace
}  // namespace cyanometer
