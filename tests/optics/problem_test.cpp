#include "engine/problem.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/optics/colour.h"
#include "engine/optics/phase.h"
#include "engine/optics/profile.h"
#include "engine/scene/document.h"

namespace cyanometer {
namespace {

using std::numbers::pi;

Scene with(const std::string& name, Constituent constituent) {
  Scene scene;
  scene.atmosphere.constituents[name] = std::move(constituent);
  return scene;
}

double vertical_optical_depth(const Problem& problem, std::size_t medium, std::size_t w) {
  const Medium& m = problem.media.at(medium);
  return (m.scattering_per_km[w] + m.absorption_per_km[w]) *
         column_km(m.profile, problem.thickness_km);
}

// Bodhaine et al. 1999, table 4: 0.0973 at 550 nm for the US Standard Atmosphere at sea level;
// 8 km of scale height instead of the true 8.43 km lose 5 %.
TEST(Problem, EarthsAirHasItsOpticalDepth) {
  const Problem problem =
      make_problem(with("air", {ExponentialProfile{8}, Molecules{Gas{}}}), {550});
  EXPECT_NEAR(vertical_optical_depth(problem, 0, 0), 0.0973 * 8 / 8.43, 0.0005);
  EXPECT_GT(std::get<RayleighPhase>(problem.media[0].phase).gamma[0], 0.01);
}

TEST(Problem, VerticalOpticalDepthsAreKeptForEveryProfile) {
  const std::vector<Profile> profiles{ExponentialProfile{1.2}, TentProfile{3, 8},
                                      QuadraticProfile{}, UniformProfile{},
                                      TableProfile{{0, 2, 50}, {3, 9, 0.1}}};
  for (const Profile& profile : profiles) {
    const Particles particles{ParticleOpticalDepth{PowerLaw{0.1, 550, -1.3}, 0.92},
                              CornetteShanks{}};
    Scene scene = with("aerosol", {profile, particles});
    scene.atmosphere.thickness_km = 30;
    const Problem problem = make_problem(scene, {400, 550});
    EXPECT_NEAR(vertical_optical_depth(problem, 0, 1), 0.1, 1e-12);
    EXPECT_NEAR(vertical_optical_depth(problem, 0, 0), 0.1 * std::pow(400.0 / 550, -1.3),
                1e-12);
    const Medium& m = problem.media[0];
    EXPECT_NEAR(m.scattering_per_km[0] / (m.scattering_per_km[0] + m.absorption_per_km[0]),
                0.92, 1e-12);
  }
}

TEST(Problem, OzoneIsACountOfMolecules) {
  const Problem problem =
      make_problem(with("ozone", {TentProfile{25, 15}, Absorber{Ozone{300}}}), {605, 5000});
  // 300 Dobson units times 5.019e-25 m^2 [Serdyuchenko et al. 2014].
  EXPECT_NEAR(vertical_optical_depth(problem, 0, 0), 300 * 2.687e20 * 5.019e-25, 1e-12);
  EXPECT_EQ(problem.media[0].scattering_per_km[0], 0);
  EXPECT_EQ(problem.media[0].absorption_per_km[1], 0);
}

TEST(Problem, VisibilityIsKoschmieders) {
  const Particles fog{Visibility{2, 0.9}, HenyeyGreenstein{0.8}};
  const Medium medium = make_problem(with("fog", {UniformProfile{}, fog}), {400, 700}).media[0];
  for (std::size_t w = 0; w < 2; ++w) {
    EXPECT_NEAR(medium.scattering_per_km[w], 0.9 * 3.912 / 2, 1e-12);
    EXPECT_NEAR(medium.absorption_per_km[w], 0.1 * 3.912 / 2, 1e-12);
  }
}

TEST(Problem, MieSpheresGiveSpectrumAlbedoAndPhase) {
  const MieSpheres spheres{0.15, 1.8, {1.45, 0.005}};
  const Particles haze{MieOpticalDepth{0.3, 550}, spheres};
  const Problem problem =
      make_problem(with("haze", {ExponentialProfile{2}, haze}), {440, 550, 870});
  EXPECT_NEAR(vertical_optical_depth(problem, 0, 1), 0.3, 1e-3);
  EXPECT_GT(vertical_optical_depth(problem, 0, 0), 0.3);
  EXPECT_LT(vertical_optical_depth(problem, 0, 2), 0.3);
  EXPECT_GT(problem.media[0].absorption_per_km[1], 0);
  const auto& phase = std::get<TabulatedPhase>(problem.media[0].phase);
  ASSERT_EQ(phase.values.size(), 3);
  for (const auto& values : phase.values)
    EXPECT_NEAR(sphere_integral(phase.angle_rad, values), 1, 1e-12);
}

TEST(Problem, MieVisibilityHoldsAt550Nm) {
  const Particles haze{Visibility{10, 1.0}, MieSpheres{0.15, 1.8, {1.45, 0}}};
  const Medium m =
      make_problem(with("haze", {ExponentialProfile{2}, haze}), {550, 870}).media[0];
  EXPECT_NEAR(m.scattering_per_km[0], 0.3912, 1e-3);
  EXPECT_LT(m.scattering_per_km[1], 0.3912);
}

TEST(Problem, PhaseTablesAreInRadiansAndNormalised) {
  const Particles dust{ParticleCoefficients{1.0, 0.0}, PhaseTable{{0, 90, 180}, {8, 2, 2}}};
  const Medium m = make_problem(with("dust", {UniformProfile{}, dust}), {500, 600}).media[0];
  const auto& phase = std::get<TabulatedPhase>(m.phase);
  EXPECT_DOUBLE_EQ(phase.angle_rad.back(), pi);
  EXPECT_NEAR(phase.values[1][0] / phase.values[1][1], 4, 1e-12);
  EXPECT_NEAR(sphere_integral(phase.angle_rad, phase.values[1]), 1, 1e-12);
}

TEST(Problem, WhatDoesNothingIsLeftOut) {
  Scene scene = with("vacuum", {ExponentialProfile{8}, Molecules{Gas{"air", 0, 288.15, {}}}});
  scene.atmosphere.constituents["grey"] = {UniformProfile{},
                                           Absorber{AbsorptionCoefficient{0.01}}};
  const Problem problem = make_problem(scene, {550});
  ASSERT_EQ(problem.media.size(), 1);
  EXPECT_EQ(problem.media[0].name, "grey");
}

TEST(Problem, AnOpticalDepthNeedsSomethingDense) {
  const Particles particles{ParticleOpticalDepth{0.1, 1.0}, HenyeyGreenstein{}};
  const Constituent above_the_top{TentProfile{200, 10}, particles};
  try {
    make_problem(with("dust", above_the_top), {550});
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_EQ(error.pointer, "/atmosphere/constituents/dust/optical_depth");
  }
  const Particles none{ParticleOpticalDepth{0.0, 1.0}, HenyeyGreenstein{}};
  EXPECT_TRUE(make_problem(with("dust", {TentProfile{200, 10}, none}), {550}).media.empty());
}

TEST(Problem, SpheresOfNothingHaveNoOpticalDepth) {
  const MieSpheres nothing{0.1, 1.5, {1, 0}};
  const Particles particles{MieOpticalDepth{0.1, 550}, nothing};
  EXPECT_THROW(make_problem(with("haze", {UniformProfile{}, particles}), {550}), SceneError);
}

TEST(Problem, APhaseTableNeedsAValue) {
  const Particles particles{ParticleCoefficients{1.0, 0.0}, PhaseTable{{0, 180}, {0, 0}}};
  EXPECT_THROW(make_problem(with("dust", {UniformProfile{}, particles}), {550}), SceneError);
}

TEST(Problem, TheSunStandsWhereItsAnglesSay) {
  Scene scene;
  scene.sun.elevation_deg = 30;
  scene.sun.azimuth_deg = 90;
  const auto east = make_problem(scene, {550}).sun_direction;
  EXPECT_NEAR(east[0], std::cos(pi / 6), 1e-15);
  EXPECT_NEAR(east[1], 0, 1e-15);
  EXPECT_NEAR(east[2], 0.5, 1e-15);
}

// ---- Output

TEST(Output, OfAPerfectWhiteCardIsWhiteCard) {
  for (const std::vector<double>& nm :
       {std::vector<double>{550}, {650, 550, 450}, {400, 500}}) {
    const Output output = make_output(Scene{}, nm);
    double luminance = 0;
    for (double y : output.xyz[1]) luminance += y / pi;
    EXPECT_NEAR(luminance, output.white_card, 1e-12);
    EXPECT_NEAR(output.white_card, 133.1 / pi, 0.3);  // klx
  }
}

TEST(Output, OrderOfWavelengthsDoesNotMatter) {
  const Output up = make_output(Scene{}, {450, 550, 650}),
               down = make_output(Scene{}, {650, 550, 450});
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t w = 0; w < 3; ++w) EXPECT_DOUBLE_EQ(up.rgb[c][w], down.rgb[c][2 - w]);
}

TEST(Output, IsExactForAPolyline) {
  // 1 nm apart or at its bends only: a radiance with bends at 450 and 600 nm has the same
  // colour.
  const auto radiance = [](double l) { return l < 450 ? 1 : l < 600 ? 1 + (l - 450) / 50 : 4; };
  std::vector<double> every_nm;
  for (double l = 360; l <= 830; ++l) every_nm.push_back(l);
  Triple coarse{}, fine{};
  const std::vector<double> bends{450, 600};
  const Output few = make_output(Scene{}, bends), many = make_output(Scene{}, every_nm);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t w = 0; w < bends.size(); ++w)
      coarse[c] += few.xyz[c][w] * radiance(bends[w]);
    for (std::size_t w = 0; w < every_nm.size(); ++w)
      fine[c] += many.xyz[c][w] * radiance(every_nm[w]);
    EXPECT_NEAR(coarse[c] / fine[c], 1, 1e-12);
  }
}

TEST(Output, OfChannelsIsTheRadiancesThemselves) {
  Scene scene;
  scene.spectrum.wavelengths_nm = {680, 550, 440};
  scene.spectrum.colour = Colour::channels;
  scene.sun.irradiance = Spectrum(PerWavelength{{1, 2, 3}});
  const Output output = make_output(scene, scene.spectrum.wavelengths_nm);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t w = 0; w < 3; ++w)
      EXPECT_EQ(output.rgb[c][w], c == w ? static_cast<double>(c + 1) : 0);
  EXPECT_EQ(output.xyz, output.rgb);
  EXPECT_DOUBLE_EQ(output.white_card, 2 / pi);
}

TEST(Output, WhiteBalanceTurnsItsLightWhite) {
  Scene scene;
  scene.image.white.kind = WhitePoint::Kind::sun;
  for (Colour colour : {Colour::cie, Colour::channels}) {
    scene.spectrum.colour = colour;
    scene.sun.irradiance = Spectrum(SampledSpectrum{{400, 700}, {1, 3}});
    const Output output = make_output(scene, {650, 550, 450});
    Triple light{};
    for (std::size_t c = 0; c < 3; ++c)
      for (double value : output.rgb[c]) light[c] += value;
    const Triple white = output.white_balance * light;
    EXPECT_NEAR(white[0] / white[1], 1, 1e-12);
    EXPECT_NEAR(white[2] / white[1], 1, 1e-12);
  }
}

TEST(Output, AWarmerWhitePointCoolsThePicture) {
  Scene scene;
  scene.image.white = {WhitePoint::Kind::kelvin, 3000};
  const Triple grey = make_output(scene, {550}).white_balance * Triple{1, 1, 1};
  EXPECT_GT(grey[2], 1.5 * grey[0]);
  scene.image.white.kind = WhitePoint::Kind::d65;
  EXPECT_EQ(make_output(scene, {550}).white_balance, (Matrix{1, 0, 0, 0, 1, 0, 0, 0, 1}));
}

TEST(Output, SunlightThatIsKnownAtOneAuFallsWithTheSquareOfTheDistance) {
  const auto light = [](const Irradiance& irradiance, double au) {
    Scene scene;
    scene.sun.irradiance = irradiance;
    scene.sun.solar_distance_au = au;
    return make_output(scene, {550}).irradiance.front();
  };
  for (const Irradiance& known : {Irradiance(MeasuredSunlight{}), Irradiance(Blackbody{4000})})
    EXPECT_NEAR(light(known, 10), light(known, 1) / 100, 1e-12);
  EXPECT_EQ(light(Spectrum(3.0), 10), 3);
}

TEST(Output, NoLightIsNoWhite) {
  Scene scene;
  scene.sun.irradiance = Spectrum(0.0);
  EXPECT_EQ(make_output(scene, {550}).white_card, 1);
  scene.image.white.kind = WhitePoint::Kind::sun;
  EXPECT_THROW(make_output(scene, {550}), SceneError);
}

}  // namespace
}  // namespace cyanometer
