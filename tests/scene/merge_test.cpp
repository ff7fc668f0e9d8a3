// RFC 7396 with the contract's additions.
#include "scene_testing.h"

namespace cyanometer {
namespace {

const std::string aerosol_at = "/atmosphere/constituents/aerosol";

Json merged(const std::string& document, const std::string& patch) {
  return merge(parse_json(document), parse_json(patch));
}
Scene patched(const std::string& patch) {
  return read_scene(merge(preset_document("earth"), parse_json(patch)));
}

TEST(Merge, MembersAreReplacedOneByOne) {
  EXPECT_EQ(
      merged(R"({"sun": {"elevation_deg": 1, "azimuth_deg": 2}, "image": {"width": 3}})",
             R"({"sun": {"azimuth_deg": 4}})"),
      parse_json(R"({"sun": {"elevation_deg": 1, "azimuth_deg": 4}, "image": {"width": 3}})"));
}

TEST(Merge, SpectraAndListsAreReplacedWhole) {
  EXPECT_EQ(
      merged(R"({"planet": {"ground_albedo": {"power_law": {"value": 1, "at_nm": 500,
                       "exponent": 0}}}, "image": {"show": ["sun", "stars"]}})",
             R"({"planet": {"ground_albedo": {"wavelengths_nm": [500], "values": [0]}},
                       "image": {"show": ["ground"]}})"),
      parse_json(R"({"planet": {"ground_albedo": {"wavelengths_nm": [500], "values": [0]}},
                           "image": {"show": ["ground"]}})"));
  EXPECT_EQ(merged(R"({"planet": {"ground_albedo": {"power_law": {"value": 1}}}})",
                   R"({"planet": {"ground_albedo": {"power_law": {"exponent": 1}}}})"),
            parse_json(R"({"planet": {"ground_albedo": {"power_law": {"exponent": 1}}}})"));
  EXPECT_EQ(merged(R"({"sun": {"irradiance": {"blackbody_k": 4000}}})",
                   R"({"sun": {"irradiance": {"wavelengths_nm": [5], "values": [1]}}})"),
            parse_json(R"({"sun": {"irradiance": {"wavelengths_nm": [5], "values": [1]}}})"));
}

TEST(Merge, AnObjectWhoseTypeChangesIsReplacedWhole) {
  const Scene scene =
      patched(R"({"atmosphere": {"constituents": {"aerosol": {"phase": {"type": "mie"}}}}})");
  const auto& matter = std::get<Particles>(scene.atmosphere.constituents.at("aerosol").matter);
  EXPECT_EQ(matter.phase, Phase(MieSpheres{}));
  const Json document =
      merge(preset_document("earth"),
            with(aerosol_at, {{"type", "absorber"}, {"absorption_per_km", 1}}));
  EXPECT_EQ(document[Json::json_pointer(aerosol_at)],
            (Json{{"type", "absorber"}, {"absorption_per_km", 1}}));
}

TEST(Merge, TheSameTypeOrNoneMergesMembers) {
  const Scene scene = patched(R"({"atmosphere": {"constituents": {
      "aerosol": {"phase": {"g": 0.5}, "profile": {"type": "exponential", "scale_height_km": 3}},
      "ozone": {"type": "absorber", "dobson_units": 10, "profile": {"centre_km": 20}}}}})");
  const auto& aerosol = scene.atmosphere.constituents.at("aerosol");
  EXPECT_EQ(std::get<Particles>(aerosol.matter).phase, Phase(CornetteShanks{0.5}));
  EXPECT_EQ(aerosol.profile, Profile(ExponentialProfile{3}));
  const auto& ozone = scene.atmosphere.constituents.at("ozone");
  EXPECT_EQ(ozone.profile, Profile(TentProfile{20, 15}));
  EXPECT_EQ(ozone.matter, decltype(ozone.matter)(Absorber{Ozone{10}}));
}

TEST(Merge, AFormThatIsGivenDropsTheOneInherited) {
  const Json clear = merge(preset_document("earth"), with(aerosol_at + "/visibility_km", 9));
  const Json& optics = clear[Json::json_pointer(aerosol_at)];
  EXPECT_FALSE(optics.contains("optical_depth"));
  EXPECT_EQ(optics["single_scattering_albedo"], 0.92) << "which both forms have";
  EXPECT_FALSE(refusal(clear));

  const Json coefficients = merge(clear, with(aerosol_at + "/absorption_per_km", 9));
  EXPECT_FALSE(coefficients[Json::json_pointer(aerosol_at)].contains("visibility_km"));
  EXPECT_FALSE(
      coefficients[Json::json_pointer(aerosol_at)].contains("single_scattering_albedo"));
  EXPECT_FALSE(refusal(coefficients));

  const std::string place =
      R"({"sun": {"place": {"latitude_deg": 1, "longitude_deg": 2, "time": "2024-01-01T00:00:00Z"}}})";
  const std::string angles = R"({"sun": {"elevation_deg": 5}})";
  EXPECT_EQ(merged(angles, place), parse_json(place));
  EXPECT_EQ(merged(place, angles), parse_json(angles));

  const std::string coefficient =
      R"({"atmosphere": {"constituents": {"air": {"scattering_per_km": 0.01}}}})";
  EXPECT_EQ(patched(coefficient).atmosphere.constituents.at("air").matter,
            decltype(Constituent::matter)(Molecules{ScatteringCoefficient{0.01}}));
}

TEST(Merge, NullRestoresADefault) {
  const Json darker = parse_json(
      R"({"planet": {"radius_km": 5}, "sun": {"elevation_deg": 3}, "camera": {"pitch_deg": 0}})");
  EXPECT_EQ(read_scene(merge(darker, parse_json(R"({"planet": {"radius_km": null}, "sun": null,
                                                     "camera": {"pitch_deg": null}})"))),
            scene_of("{}"));
  EXPECT_EQ(scene_of(R"({"preset": "earth_sunset", "sun": null})").sun, scene_of("{}").sun);
  EXPECT_EQ(scene_of(R"({"preset": "mars", "atmosphere": null})").atmosphere,
            scene_of("{}").atmosphere);
}

TEST(Merge, NullRemovesAConstituentAlsoOneThatIsNotThere) {
  const Scene scene =
      scene_of(R"({"atmosphere": {"constituents": {"aerosol": null, "nothing": null}}})");
  EXPECT_EQ(scene.atmosphere.constituents.size(), 2u);
  EXPECT_FALSE(scene.atmosphere.constituents.contains("aerosol"));
}

TEST(Merge, ARemovalOutlivesAMergeOfDocuments) {
  const Json document = merge(parse_json(R"({"preset": "earth"})"), with(aerosol_at, nullptr));
  EXPECT_FALSE(read_scene(document).atmosphere.constituents.contains("aerosol"));
}

/// The scene of a document and a patch.
Scene scene_of_both(const Json& document, const std::string& patch) {
  return read_scene(document, parse_json(patch));
}
Particles aerosol_of(const Scene& scene) {
  return std::get<Particles>(scene.atmosphere.constituents.at("aerosol").matter);
}
Particles aerosol_of(const Json& own, const Json& patch) {
  return aerosol_of(read_scene(with(aerosol_at, own), with(aerosol_at, patch)));
}

TEST(Patch, KnowsTheTypeThatOnlyThePresetTells) {
  const Particles thick = aerosol_of({{"optical_depth", 0.2}}, {{"visibility_km", 10}});
  EXPECT_EQ(thick.optics, decltype(thick.optics)(Visibility{10, 0.92}));

  const Json law{{"power_law", {{"value", 0.3}, {"at_nm", 500}, {"exponent", -1}}}};
  const Json table{{"wavelengths_nm", {400, 700}}, {"values", {0.3, 0.2}}};
  const Particles sampled = aerosol_of({{"optical_depth", law}}, {{"optical_depth", table}});
  EXPECT_EQ(std::get<ParticleOpticalDepth>(sampled.optics).optical_depth,
            Spectrum(SampledSpectrum{{400, 700}, {0.3, 0.2}}));

  const Json mie{{"phase", {{"type", "mie"}}}};
  EXPECT_EQ(aerosol_of({{"phase", {{"g", 0.5}}}}, mie).phase, Phase(MieSpheres{}));
}

TEST(Patch, NullRestoresTheDefaultAndNotThePresets) {
  const Json none{{"single_scattering_albedo", nullptr}};
  const Particles white = aerosol_of({{"optical_depth", 0.3}}, none);
  EXPECT_EQ(white.optics, decltype(white.optics)(ParticleOpticalDepth{0.3, 1.0}));

  const Json dark{{"preset", "earth_sunset"}, {"sun", nullptr}};
  Sun sun;
  sun.azimuth_deg = 10;
  EXPECT_EQ(scene_of_both(dark, R"({"sun": {"azimuth_deg": 10}})").sun, sun);
}

TEST(Patch, APresetThatItNamesStandsForTheDocuments) {
  const Json document = parse_json(R"({"preset": "earth_sunset", "sun": {"azimuth_deg": 7},
                                       "image": {"width": 33}})");
  const Json own =
      parse_json(R"({"preset": "mars", "sun": {"azimuth_deg": 7, "elevation_deg": 5},
                                  "image": {"width": 33}})");
  EXPECT_EQ(scene_of_both(document, R"({"preset": "mars", "sun": {"elevation_deg": 5}})"),
            read_scene(own));
  EXPECT_THROW(scene_of_both(document, R"({"preset": "nowhere"})"), SceneError);
  EXPECT_THROW(scene_of_both(parse_json("[1, 2]"), R"({"preset": "mars"})"), SceneError);
  EXPECT_EQ(scene_of_both(document, "{}"), read_scene(document));
}

TEST(Merge, WhatIsUnknownIsKeptToBeRefused) {
  EXPECT_EQ(refusal(with(aerosol_at + "/phase/h", 1))->pointer, aerosol_at + "/phase/h");
  EXPECT_EQ(refusal(with("/sun/colour", 1))->pointer, "/sun/colour");
}

}  // namespace
}  // namespace cyanometer
