#include "engine/surface/world.h"

#include <numbers>

#include "engine/optics/colour.h"
#include "engine/surface/ground.h"
#include "engine/surface/pack_ground.h"
#include "engine/surface/upsampling.h"
#include "tests/surface/testing.h"

namespace cyanometer::surface_testing {
namespace {

P physics_of(const ProceduralSurface& surface) {
  P p = pack<double>(make_problem(scene_on(surface, 1, 30), {680, 550, 440}));
  tell_places_from_centre(p);
  return p;
}

/// Places spread over the whole sphere.
std::vector<glm::dvec3> places(int count) {
  std::vector<glm::dvec3> all;
  for (int i = 0; i < count; ++i) {
    double z = 1 - (2 * i + 1.0) / count, rim = std::sqrt(1 - z * z), angle = 2.39996323 * i;
    all.emplace_back(rim * std::cos(angle), rim * std::sin(angle), z);
  }
  return all;
}

TEST(World, HasAsMuchSeaAsAskedForWhateverItsSeed) {
  for (int seed : {1, 2, 77}) {
    for (double sea : {0.0, 0.3, 0.7, 1.0}) {
      ProceduralSurface surface;
      surface.seed = seed;
      surface.sea_fraction = sea;
      surface.ice_latitude_deg = 90;
      P p = physics_of(surface);
      double under = 0;
      std::vector<glm::dvec3> all = places(5000);
      for (const glm::dvec3& n : all) under += p.terrain_at(n, 20).land < 0;
      EXPECT_NEAR(under / 5000, sea, 0.015) << "seed " << seed;
    }
  }
}

TEST(World, IsTheSameForASeedAndAnotherForAnother) {
  ProceduralSurface one, other;
  other.seed = 2;
  P p = physics_of(one), again = physics_of(one), q = physics_of(other);
  int different = 0;
  for (const glm::dvec3& n : places(200)) {
    EXPECT_EQ(p.terrain_at(n, 5).continent, again.terrain_at(n, 5).continent);
    different += std::abs(p.terrain_at(n, 5).continent - q.terrain_at(n, 5).continent) > 0.01;
  }
  EXPECT_GT(different, 190);
}

TEST(World, IsMadeOfSharesThatAddUpToOne) {
  ProceduralSurface surface;
  surface.relief_km = 8;
  P p = physics_of(surface);
  for (const glm::dvec3& n : places(2000)) {
    double share[P::MATTERS], sum = 0;
    P::Terrain terrain = p.terrain_at(n, 3);
    p.matter_of(n, terrain, share);
    for (double each : share) {
      EXPECT_GE(each, -1e-12);
      sum += each;
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_GE(terrain.height, 0);
    EXPECT_LE(terrain.height, 1);
    if (terrain.land <= 0) {
      EXPECT_EQ(terrain.height, 0) << "seas are level";
    }
  }
}

// What a footprint shows changes with its size by little at a time: nothing pops.
TEST(World, FadesDetailInAsAPlaceComesNearer) {
  P p = physics_of({});
  for (const glm::dvec3& n : places(40)) {
    double last = p.terrain_at(n, 300).continent;
    for (double footprint = 300; footprint > 0.05; footprint /= 1.02) {
      double now = p.terrain_at(n, footprint).continent;
      EXPECT_NEAR(now, last, 0.03);
      last = now;
    }
  }
}

// And nothing finer than a footprint is there to flicker.
TEST(World, ShowsNothingFinerThanAFootprint) {
  P p = physics_of({});
  constexpr double footprint_km = 50;
  for (const glm::dvec3& n : places(60)) {
    glm::dvec3 across = glm::normalize(glm::cross(n, glm::dvec3(0.3, 0.5, 0.8)));
    double step = 0.1 * footprint_km / 6360;
    auto at = [&](double k) {
      return p.terrain_at(glm::normalize(n + across * (k * step)), footprint_km).continent;
    };
    // Second differences of a wave of two footprints' length, at the amplitude it has there.
    double bend = at(1) - 2 * at(0) + at(-1);
    EXPECT_LT(std::abs(bend), 0.1 * 0.1 * std::numbers::pi * std::numbers::pi * 0.1);
  }
}

TEST(World, IceCoversAllOrNoneWhereAsked) {
  ProceduralSurface cold, warm;
  cold.ice_latitude_deg = 0;
  warm.ice_latitude_deg = 90;
  EXPECT_EQ(world_of(cold).mean_share[P::ICE], 1);
  EXPECT_LT(world_of(warm).mean_share[P::ICE], 0.01);
}

// ---- The sea

/// Over all directions of light.
template <class Function>
double over_hemisphere(Function f) {
  constexpr int rings = 500, spokes = 500;
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    for (int k = 0; k < spokes; ++k) {
      double mu = (i + 0.5) / rings, azimuth = 2 * std::numbers::pi * (k + 0.5) / spokes,
             sine = std::sqrt(1 - mu * mu);
      sum += f(glm::dvec3(sine * std::cos(azimuth), sine * std::sin(azimuth), mu)) * mu;
    }
  }
  return sum * 2 * std::numbers::pi / (rings * spokes);
}

TEST(Sea, ReflectsNoMoreThanThereIsAndAsMuchAsItsTableSays) {
  for (double wind : {2.0, 7.0, 20.0}) {
    ProceduralSurface surface;
    surface.wind_m_per_s = wind;
    P p = physics_of(surface);
    for (double mu : {0.05, 0.2, 0.5, 0.9}) {
      glm::dvec3 eye(std::sqrt(1 - mu * mu), 0, mu);
      double mirrored = over_hemisphere([&](auto l) { return p.sea_glint(l, eye); });
      double below = over_hemisphere([&](auto l) { return p.under_water(l.z, mu); });
      EXPECT_NEAR(mirrored, p.sea_reflectance(mu), 0.003 + 0.01 * mirrored)
          << wind << ", " << mu;
      EXPECT_NEAR(mirrored + below, 1, 0.006) << "white water, " << wind << ", " << mu;
    }
  }
}

TEST(Sea, WithoutWindReflectsAsFresnelSays) {
  ProceduralSurface calm;
  calm.wind_m_per_s = 0;
  P p = physics_of(calm);
  for (double mu : {0.3, 0.5, 0.8}) {
    EXPECT_NEAR(p.sea_reflectance(mu), p.fresnel_of_water(mu), 0.05 * p.fresnel_of_water(mu));
  }
  EXPECT_NEAR(p.fresnel_of_water(1), std::pow(0.34 / 2.34, 2), 1e-12);
}

TEST(Sea, IsTheSameWithLightAndEyeExchanged) {
  P p = physics_of({});
  glm::dvec3 a = oracle::towards(20, 10), b = oracle::towards(35, 170);
  EXPECT_NEAR(p.sea_glint(a, b), p.sea_glint(b, a), 1e-12);
}

// ---- Colours

/// CIE standard illuminant D65 from 380 to 780 nm, every 10 nm [ISO/CIE 11664-2].
constexpr std::array<double, 41> d65{
    49.9755, 54.6482, 82.7549, 91.486,  93.4318, 86.6823, 104.865, 117.008, 117.812,
    114.861, 115.923, 108.811, 109.354, 107.802, 104.79,  107.689, 104.405, 104.046,
    100.0,   96.3342, 95.788,  88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992,
    80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.349,  61.604,  69.8856,
    75.087,  63.5927, 46.4182, 66.8054, 63.3828};

Triple seen_under_d65(const Triple& rgb) {
  Triple xyz{};
  double white = 0;
  for (int nm = 380; nm <= 780; ++nm) {
    int low = std::min((nm - 380) / 10, 39);
    double light = std::lerp(d65[low], d65[low + 1], (nm - 380 - 10 * low) / 10.0);
    auto basis = reflectance_basis(nm);
    double reflected = 0;
    for (std::size_t c = 0; c < 3; ++c) reflected += rgb[c] * basis[c];
    Triple matching = colour_matching(nm);
    white += light * matching[1];
    for (std::size_t c = 0; c < 3; ++c) xyz[c] += light * reflected * matching[c];
  }
  for (double& value : xyz) value /= white;
  return rec709_from_xyz() * xyz;
}

TEST(Upsampling, GivesReflectancesThatLookAsTheirColoursDo) {
  for (double r : {0.0, 0.2, 1.0}) {
    for (double g : {0.0, 0.5, 1.0}) {
      for (double b : {0.0, 0.3, 1.0}) {
        Triple seen = seen_under_d65({r, g, b});
        EXPECT_NEAR(seen[0], r, 3e-3);
        EXPECT_NEAR(seen[1], g, 3e-3);
        EXPECT_NEAR(seen[2], b, 3e-3);
      }
    }
  }
}

TEST(Upsampling, StaysBetweenNothingAndAll) {
  for (double nm = 300; nm < 900; nm += 2.5) {
    auto basis = reflectance_basis(nm);
    EXPECT_NEAR(basis[0] + basis[1] + basis[2], 1, 1e-12);
    for (double each : basis) EXPECT_GE(each, 0) << nm;
  }
}

}  // namespace
}  // namespace cyanometer::surface_testing
