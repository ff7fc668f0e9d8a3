// Laws of the stars: how many and how bright, and how they turn.
#include "engine/sky/stars.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/scene/document.h"
#include "engine/sky/pixel.h"

namespace cyanometer {
namespace {

using P = Physics<double>;

Scene seen_from(double latitude_deg, double longitude_deg, const std::string& time) {
  return read_scene({{"sun",
                      {{"place",
                        {{"latitude_deg", latitude_deg},
                         {"longitude_deg", longitude_deg},
                         {"time", time}}}}}});
}

/// Where the sun stands among the stars.
glm::dvec3 sun_among_stars(const Scene& scene) {
  std::array<double, 3> d = make_problem(scene, {550}).sun_direction;
  return glm::transpose(sky_to_local(scene.camera)) * glm::dvec3(d[0], d[1], d[2]);
}

TEST(Stars, AreAsManyAsANakedEyeSees) {
  const auto& stars = star_catalogue();
  auto brighter = [&](double magnitude) {
    return std::count_if(stars.begin(), stars.end(),
                         [&](const Star& s) { return s.magnitude < magnitude; });
  };
  EXPECT_NEAR(static_cast<double>(brighter(6.5)), 8500, 900);
  EXPECT_NEAR(static_cast<double>(brighter(3)), 150, 40);
}

TEST(Stars, OfMagnitudeZeroAreFiftyBillionTimesFainterThanTheSun) {
  Star star{{0, 0, 1}, 0, 5772};
  EXPECT_NEAR(1 / star_irradiance(star, 550), 4.97e10, 0.02e10);  // 10^(0.4 * 26.74)
  EXPECT_NEAR(star_irradiance(star, 440), star_irradiance(star, 680), 1e-18);
  star.temperature_k = 12000;
  EXPECT_GT(star_irradiance(star, 440), star_irradiance(star, 680));
}

TEST(Stars, AreFloatsAtAllWavelengthsAndNothingBeyondTheLymanLimit) {
  StarLight light;
  for (double wavelength_nm : {10.0, 91.0, 92.0, 200.0, 1e5}) {
    for (float star : light.at(wavelength_nm)) {
      EXPECT_TRUE(std::isfinite(star)) << wavelength_nm;
      EXPECT_EQ(star > 0, wavelength_nm > 91.18) << wavelength_nm;
    }
  }
}

TEST(Stars, TurnAboutAPoleThatStandsInTheNorthAtTheLatitude) {
  for (double latitude : {-90.0, -33.0, 0.0, 48.0, 90.0}) {
    for (const char* time : {"2024-06-20T02:00:00Z", "2024-06-20T09:30:00Z"}) {
      glm::dvec3 pole =
          sky_to_local(seen_from(latitude, 11, time).camera) * glm::dvec3(0, 0, 1);
      double phi = glm::radians(latitude);
      EXPECT_NEAR(glm::distance(pole, glm::dvec3(0, std::cos(phi), std::sin(phi))), 0, 1e-12);
    }
  }
}

// The sun's place comes from the Earth's orbit: among the stars it is one point wherever it is
// seen from, but for its parallax.
TEST(Stars, StandAroundTheSameSunWhereverItIsSeenFrom) {
  const std::string time = "2024-08-09T05:40:00Z";
  glm::dvec3 there = sun_among_stars(seen_from(0, 0, time));
  for (double latitude : {-70.0, 20.0, 60.0}) {
    for (double longitude : {-150.0, 45.0, 170.0}) {
      glm::dvec3 here = sun_among_stars(seen_from(latitude, longitude, time));
      EXPECT_LT(glm::degrees(glm::distance(here, there)), 0.01);
    }
  }
}

// Meeus, table 27.E: the equinox of March 1996, 62 s of terrestrial time taken off.
TEST(Stars, HaveTheVernalEquinoxWhereTheSunIsAtTheEquinox) {
  glm::dvec3 sun = sun_among_stars(seen_from(52, 13, "1996-03-20T08:03:05Z"));
  EXPECT_LT(glm::degrees(glm::distance(sun, glm::dvec3(1, 0, 0))), 0.01);
}

TEST(Stars, TurnWestwardsWithTheSunThroughADay) {
  glm::dvec3 first = sun_among_stars(seen_from(48, 2, "2024-06-20T00:00:00Z"));
  for (const char* time : {"2024-06-20T06:00:00Z", "2024-06-20T13:00:00Z"}) {
    glm::dvec3 later = sun_among_stars(seen_from(48, 2, time));
    EXPECT_LT(glm::degrees(glm::distance(first, later)), 0.6) << time;
  }
}

TEST(Stars, AreBackAfterASiderealDayAndTheSunIsADegreeFurtherEast) {
  Scene first = seen_from(48, 2, "2024-06-20T00:00:00Z");
  Scene later = seen_from(48, 2, "2024-06-20T23:56:04.0905Z");
  glm::dvec3 star(0.36, 0.48, 0.8);
  EXPECT_LT(glm::distance(sky_to_local(first.camera) * star, sky_to_local(later.camera) * star),
            1e-7);
  glm::dvec3 before = sun_among_stars(first), after = sun_among_stars(later);
  EXPECT_NEAR(glm::degrees(glm::distance(before, after)), 0.95, 0.03);
  EXPECT_GT(glm::cross(before, after).z, 0);
}

TEST(Stars, OfAFrameTurnWithTheTimeAndComeBack) {
  StarLight light;
  auto pixels = [&](const char* time) {
    Problem problem = make_problem(seen_from(48, 2, time), {550});
    P camera = pack<double>(problem);
    return star_pixels(problem, camera, light).pixels;
  };
  EXPECT_NE(pixels("2024-06-20T00:10:00Z"), pixels("2024-06-20T00:00:00Z"));
  EXPECT_EQ(pixels("2024-06-20T23:56:04.0905Z"), pixels("2024-06-20T00:00:00Z"));
}

/// Whatever pixels they fall on, and at any wavelengths, however many were asked for before;
/// as a share of the sun's light, which is a ninth at three times the distance.
TEST(Stars, OfAWholeSphereSendWhatTheCatalogueSends) {
  Scene scene = seen_from(48, 2, "2024-06-20T00:00:00Z");
  scene.camera.projection = Projection::equirectangular;
  scene.image.width = 256;
  scene.image.height = 128;
  scene.sun.solar_distance_au = 3;
  StarLight light;
  for (double nm = 360; nm < 440; ++nm) light.at(nm);
  std::vector<double> wavelengths = {400, 440, 500, 550, 680};
  Problem problem = make_problem(scene, wavelengths);
  P camera = pack<double>(problem);
  StarPixels lit = star_pixels(problem, camera, light);
  ASSERT_EQ(lit.radiance.size(), 2 * lit.pixels.size());
  for (std::size_t w = 0; w < wavelengths.size(); ++w) {
    double sum = 0, expected = 0;
    for (std::size_t k = 0; k < lit.pixels.size(); ++k) {
      sum += lit.radiance[2 * k + w / 4][static_cast<int>(w % 4)] *
             pixel_solid_angle(camera, lit.pixels[k]);
    }
    for (const Star& star : star_catalogue())
      expected += 9 * star_irradiance(star, wavelengths[w]);
    EXPECT_NEAR(sum / expected, 1, 1e-5) << wavelengths[w];
  }
}

}  // namespace
}  // namespace cyanometer
