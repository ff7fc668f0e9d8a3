// What a document may say, what follows from what it leaves out, and what is refused.
#include <limits>

#include "engine/engine.h"
#include "engine/optics/sun_position.h"
#include "scene_testing.h"
#include "server/routes/scene_request.h"

namespace cyanometer {
namespace {

const std::string in_aerosol = R"({"atmosphere": {"constituents": {"aerosol": )";
const std::string end = "}}}";

const Constituent& constituent(const Scene& scene, const std::string& name) {
  return scene.atmosphere.constituents.at(name);
}
template <class T>
const T& optics(const Scene& scene, const std::string& name = "aerosol") {
  return std::get<T>(std::get<Particles>(constituent(scene, name).matter).optics);
}

TEST(Reading, TheEmptyDocumentIsTheContractsEarth) {
  const Scene scene = scene_of("{}");
  EXPECT_EQ(scene.planet.radius_km, 6360);
  EXPECT_EQ(scene.planet.ground_albedo, Spectrum(0.1));
  EXPECT_EQ(scene.atmosphere.thickness_km, 100);
  ASSERT_EQ(scene.atmosphere.constituents.size(), 3u);
  const Constituent air{ExponentialProfile{8}, Molecules{Gas{"air", 101325, 288.15, {}}}};
  EXPECT_EQ(constituent(scene, "air"), air);
  const Constituent aerosol{
      ExponentialProfile{1.2},
      Particles{ParticleOpticalDepth{PowerLaw{0.1, 550, -1.3}, 0.92}, CornetteShanks{0.76}}};
  EXPECT_EQ(constituent(scene, "aerosol"), aerosol);
  const Constituent ozone{TentProfile{25, 15}, Absorber{Ozone{300}}};
  EXPECT_EQ(constituent(scene, "ozone"), ozone);

  EXPECT_EQ(scene.sun.elevation_deg, 30);
  EXPECT_EQ(scene.sun.azimuth_deg, 0);
  EXPECT_EQ(scene.sun.irradiance, Irradiance(MeasuredSunlight{}));
  EXPECT_EQ(scene.sun.angular_diameter_deg, 0.533);
  EXPECT_EQ(scene.sun.disc_samples, 1);
  EXPECT_FALSE(scene.sun.distance_km);
  EXPECT_TRUE(scene.sun.limb_darkening);
  EXPECT_EQ(scene.camera.altitude_km, 0.002);
  EXPECT_EQ(scene.camera.pitch_deg, 10);
  EXPECT_EQ(scene.camera.fov_deg, 60);
  EXPECT_EQ(scene.camera.projection, Projection::perspective);
  EXPECT_TRUE(scene.spectrum.wavelengths_nm.empty());
  EXPECT_EQ(scene.spectrum.colour, Colour::cie);
  EXPECT_EQ(scene.method.name, "auto");
  EXPECT_EQ(scene.method.max_error, 0.02);
  EXPECT_FALSE(scene.method.max_ms);
  EXPECT_FALSE(scene.method.verify);
  EXPECT_FALSE(scene.method.scattering_orders);
  EXPECT_EQ(scene.image.width, 1280);
  EXPECT_EQ(scene.image.height, 720);
  EXPECT_EQ(scene.image.format, ImageFormat::png);
  EXPECT_EQ(scene.image.tone_map, ToneMap::agx);
  EXPECT_FALSE(scene.image.exposure_ev);
  EXPECT_EQ(scene.image.show, (Show{true, true, true, false}));
}

TEST(Reading, DefaultsFollowTheProjection) {
  const Scene fisheye =
      scene_of(R"({"camera": {"projection": "fisheye"}, "image": {"width": 99}})");
  EXPECT_EQ(fisheye.camera.pitch_deg, 90);
  EXPECT_EQ(fisheye.camera.fov_deg, 180);
  EXPECT_EQ(fisheye.image.height, 99);
  const Scene panorama = scene_of(R"({"camera": {"projection": "equirectangular"}})");
  EXPECT_EQ(panorama.camera.pitch_deg, 0);
  EXPECT_EQ(panorama.image.height, 640);
  const Scene cubemap =
      scene_of(R"({"camera": {"projection": "cubemap"}, "image": {"width": 8}})");
  EXPECT_EQ(cubemap.image.height, 48);
}

TEST(Reading, ThreeWavelengthsAreChannelsInSunlightOfOne) {
  const Scene three = scene_of(R"({"spectrum": {"wavelengths_nm": [680, 550, 440]}})");
  EXPECT_EQ(three.spectrum.colour, Colour::channels);
  EXPECT_EQ(three.sun.irradiance, Irradiance(Spectrum(1.0)));
  const Scene cie =
      scene_of(R"({"spectrum": {"wavelengths_nm": [680, 550, 440], "colour": "cie"}})");
  EXPECT_EQ(cie.sun.irradiance, Irradiance(MeasuredSunlight{}));
  const Scene two = scene_of(R"({"spectrum": {"wavelengths_nm": [440, 550]}})");
  EXPECT_EQ(two.spectrum.colour, Colour::cie);
}

TEST(Reading, ATimeBudgetAloneAsksForNoError) {
  EXPECT_FALSE(scene_of(R"({"method": {"max_ms": 5}})").method.max_error);
  EXPECT_EQ(scene_of(R"({"method": {"max_ms": 5, "max_error": 0.1}})").method.max_error, 0.1);
}

TEST(Reading, OptionsOfTheNamedMethodAreCompleteAndThoseOfOthersIgnored) {
  const MethodDescription& nishita = methods().front();
  ASSERT_EQ(nishita.name, "nishita");
  const Scene named = scene_of(R"({"method": {"name": "nishita", "view_samples": 7}})");
  EXPECT_EQ(named.method.options.size(), nishita.options.size());
  EXPECT_EQ(named.method.options.at("view_samples"), 7);
  EXPECT_EQ(named.method.options.at("light_samples"), 16);
  EXPECT_TRUE(scene_of(R"({"method": {"view_samples": 7}})").method.options.empty());
  EXPECT_EQ(refused_at(R"({"method": {"view_samples": 2001}})"), "/method/view_samples");
  EXPECT_EQ(refused_at(R"({"method": {"name": "nishita", "view_samples": 1.5}})"),
            "/method/view_samples");
  EXPECT_EQ(refused_at(R"({"method": {"samples": 1}})"), "/method/samples");
}

TEST(Reading, ASpectrumHasFourForms) {
  const auto albedo = [](const std::string& form) {
    return scene_of(
               R"({"spectrum": {"wavelengths_nm": [700, 500]}, "planet": {"ground_albedo": )" +
               form + "}}")
        .planet.ground_albedo;
  };
  EXPECT_EQ(albedo("0.25"), Spectrum(0.25));
  EXPECT_EQ(albedo("[0.25, 1]"), Spectrum(PerWavelength{{0.25, 1}}));
  EXPECT_EQ(albedo(R"({"power_law": {"value": 0.5, "at_nm": 600, "exponent": 1}})"),
            Spectrum(PowerLaw{0.5, 600, 1}));
  EXPECT_EQ(albedo(R"({"wavelengths_nm": [400, 600], "values": [0, 1]})"),
            Spectrum(SampledSpectrum{{400, 600}, {0, 1}}));
}

TEST(Reading, AnArraySpectrumNeedsItsWavelengths) {
  EXPECT_EQ(refused_at(R"({"planet": {"ground_albedo": [0.1, 0.2]}})"),
            "/planet/ground_albedo");
  EXPECT_EQ(refused_at(R"({"spectrum": {"wavelengths_nm": [400, 500, 600]},
                           "planet": {"ground_albedo": [0.1, 0.2]}})"),
            "/planet/ground_albedo");
}

TEST(Reading, APowerLawStaysInRangeWhereItIsComputed) {
  const std::string steep =
      R"("planet": {"ground_albedo": {"power_law": {"value": 0.9, "at_nm": 550, "exponent": 4}}}})";
  EXPECT_EQ(refused_at("{" + steep), "/planet/ground_albedo/power_law");
  EXPECT_EQ(refused_at(R"({"spectrum": {"wavelengths_nm": [400, 560]}, )" + steep), "accepted");
}

TEST(Reading, SampledSpectraAscendAndHaveAValueForEachWavelength) {
  EXPECT_EQ(refused_at(R"({"planet": {"ground_albedo": {"wavelengths_nm": [500, 400],
                           "values": [0, 1]}}})"),
            "/planet/ground_albedo/wavelengths_nm/1");
  EXPECT_EQ(refused_at(R"({"planet": {"ground_albedo": {"wavelengths_nm": [400, 500],
                           "values": [0]}}})"),
            "/planet/ground_albedo/values");
}

TEST(Reading, WavelengthsRunOneWayWithinTheirRange) {
  const auto wavelengths = [](const std::string& list) {
    return refused_at(R"({"spectrum": {"wavelengths_nm": )" + list + "}}");
  };
  EXPECT_EQ(wavelengths("[10, 5000]"), "accepted");
  EXPECT_EQ(wavelengths("[700, 600, 500, 400]"), "accepted");
  EXPECT_EQ(wavelengths("[400, 400]"), "/spectrum/wavelengths_nm/1");
  EXPECT_EQ(wavelengths("[400, 600, 500]"), "/spectrum/wavelengths_nm/2");
  EXPECT_EQ(wavelengths("[600, 500, 550]"), "/spectrum/wavelengths_nm/2");
  EXPECT_EQ(wavelengths("[9.9]"), "/spectrum/wavelengths_nm/0");
  EXPECT_EQ(wavelengths("[]"), "/spectrum/wavelengths_nm");
  EXPECT_EQ(wavelengths("\"some\""), "/spectrum/wavelengths_nm");
  Json many = Json::array();
  for (int i = 0; i < 64; ++i) many.push_back(400 + i);
  EXPECT_EQ(wavelengths(many.dump()), "accepted");
  many.push_back(900);
  EXPECT_EQ(wavelengths(many.dump()), "/spectrum/wavelengths_nm");
}

TEST(Reading, ChannelsNeedThreeWavelengths) {
  EXPECT_EQ(refused_at(R"({"spectrum": {"colour": "channels"}})"), "/spectrum/colour");
  EXPECT_EQ(
      refused_at(R"({"spectrum": {"colour": "channels", "wavelengths_nm": [1000, 2000]}})"),
      "/spectrum/colour");
}

TEST(Reading, ParticlesTakeEachOfTheirForms) {
  EXPECT_EQ(optics<ParticleCoefficients>(
                scene_of(in_aerosol + R"({"scattering_per_km": 0.5})" + end)),
            (ParticleCoefficients{0.5, 0.0}));
  EXPECT_EQ(optics<Visibility>(scene_of(in_aerosol + R"({"visibility_km": 5})" + end)),
            (Visibility{5, 0.92}));
  const Scene mie = scene_of(in_aerosol + R"({"optical_depth": {"value": 0.3, "at_nm": 500},
      "phase": {"type": "mie", "radius_um": 0.2, "geometric_sigma": 2,
                "refractive_index": [1.5, 0.01]}})" +
                             end);
  EXPECT_EQ(optics<MieOpticalDepth>(mie), (MieOpticalDepth{0.3, 500}));
  EXPECT_EQ(std::get<Particles>(constituent(mie, "aerosol").matter).phase,
            Phase(MieSpheres{0.2, 2, {1.5, 0.01}}));
}

TEST(Reading, AnOpticalDepthAtOneWavelengthNeedsMieSpheres) {
  EXPECT_EQ(refused_at(in_aerosol + R"({"optical_depth": {"value": 0.3, "at_nm": 500}})" + end),
            "/atmosphere/constituents/aerosol/optical_depth");
}

TEST(Reading, AlternativeFormsGivenTwiceAreRefused) {
  EXPECT_EQ(refused_at(in_aerosol + R"({"optical_depth": 1, "visibility_km": 5})" + end),
            "/atmosphere/constituents/aerosol/visibility_km");
  EXPECT_EQ(refused_at(R"({"atmosphere": {"constituents": {"air": {
                "pressure_pa": 1, "scattering_per_km": 1}}}})"),
            "/atmosphere/constituents/air/scattering_per_km");
  EXPECT_EQ(refused_at(R"({"atmosphere": {"constituents": {"ozone": {
                "gas": "ozone", "absorption_per_km": 1}}}})"),
            "/atmosphere/constituents/ozone/gas");
  EXPECT_EQ(refused_at(R"({"sun": {"azimuth_deg": 5, "place": {"latitude_deg": 0,
                "longitude_deg": 0, "time": "2024-01-01T00:00:00Z"}}})"),
            "/sun/place");
}

TEST(Reading, AConstituentNeedsATypeAProfileAndOptics) {
  const auto dust = [](const std::string& text) {
    return refused_at(R"({"atmosphere": {"constituents": {"dust": )" + text + "}}}");
  };
  const std::string at = "/atmosphere/constituents/dust";
  EXPECT_EQ(dust("{}"), at + "/type");
  EXPECT_EQ(dust(R"({"type": "dust"})"), at + "/type");
  EXPECT_EQ(dust(R"({"type": "absorber", "dobson_units": 1})"), at + "/profile");
  EXPECT_EQ(dust(R"({"type": "absorber", "profile": {"type": "uniform"}})"),
            at + "/absorption_per_km");
  EXPECT_EQ(dust(R"({"type": "particles", "profile": {"type": "quadratic"}})"),
            at + "/scattering_per_km");
  EXPECT_EQ(dust(R"({"type": "molecules", "profile": {"type": "quadratic"}})"), "accepted");
  EXPECT_EQ(dust(R"({"type": "molecules", "profile": {"type": "uniform"}, "g": 0})"),
            at + "/g");
}

TEST(Reading, TablesAscendAndTheirListsBelongTogether) {
  const std::string at = "/atmosphere/constituents/aerosol";
  const auto profile = [](const std::string& lists) {
    return refused_at(in_aerosol + R"({"profile": {"type": "table", )" + lists + "}}" + end);
  };
  EXPECT_EQ(profile(R"("altitude_km": [0, 5, 9], "density": [1, 3, 0])"), "accepted");
  EXPECT_EQ(profile(R"("altitude_km": [0, 5], "density": [1, 3, 0])"), at + "/profile/density");
  EXPECT_EQ(profile(R"("altitude_km": [0, 0], "density": [1, 3])"),
            at + "/profile/altitude_km/1");
  EXPECT_EQ(profile(R"("altitude_km": [0, 1], "density": [0, 0])"), at + "/profile/density");
  EXPECT_EQ(profile(R"("density": [1, 1])"), at + "/profile/altitude_km");
  const auto phase = [](const std::string& lists) {
    return refused_at(in_aerosol + R"({"phase": {"type": "table", )" + lists + "}}" + end);
  };
  EXPECT_EQ(phase(R"("angle_deg": [0, 90, 180], "values": [3, 1, 2])"), "accepted");
  EXPECT_EQ(phase(R"("angle_deg": [0, 90], "values": [3, 1])"), at + "/phase/angle_deg");
  EXPECT_EQ(phase(R"("angle_deg": [1, 180], "values": [3, 1])"), at + "/phase/angle_deg");
  EXPECT_EQ(phase(R"("angle_deg": [0, 180], "values": [3, 0])"), at + "/phase/values/1");
}

TEST(Reading, AtMostThirtyTwoConstituentsHavePlainNames) {
  Json document = Json::object();
  Json& constituents = document["atmosphere"]["constituents"];
  const Json uniform = {
      {"type", "absorber"}, {"absorption_per_km", 0.1}, {"profile", {{"type", "uniform"}}}};
  for (int i = 0; i < 29; ++i) constituents["x" + std::to_string(i)] = uniform;
  EXPECT_FALSE(refusal(document));
  constituents["one_more"] = uniform;
  EXPECT_EQ(refusal(document)->pointer, "/atmosphere/constituents");
  constituents["air"] = nullptr;
  EXPECT_FALSE(refusal(document));

  const std::string longest = "a" + std::string(31, '0');
  EXPECT_FALSE(refusal(with("/atmosphere/constituents/" + longest, uniform)));
  for (const std::string& name : {longest + "0", std::string("Air"), std::string("0a"),
                                  std::string(100000, 'a'), std::string()}) {
    Json named = Json::object();
    named["atmosphere"]["constituents"][name] = uniform;
    EXPECT_EQ(refusal(named)->pointer, "/atmosphere/constituents/" + name);
  }
}

TEST(Reading, PanoramasKeepTheirShape) {
  const auto image = [](const std::string& projection, const std::string& size) {
    return refused_at(R"({"camera": {"projection": ")" + projection + R"("}, "image": {)" +
                      size + "}}");
  };
  EXPECT_EQ(image("equirectangular", R"("width": 64, "height": 32)"), "accepted");
  EXPECT_EQ(image("equirectangular", R"("width": 64, "height": 33)"), "/image/height");
  EXPECT_EQ(image("equirectangular", R"("width": 65)"), "/image/width");
  EXPECT_EQ(image("cubemap", R"("width": 10, "height": 60)"), "accepted");
  EXPECT_EQ(image("cubemap", R"("width": 10, "height": 59)"), "/image/height");
}

TEST(Reading, AJpegHasNoMoreRowsThanItsLibraryMakes) {
  const auto image = [](const std::string& members) {
    return refused_at(R"({"image": {"width": 8, )" + members + "}}");
  };
  EXPECT_EQ(image(R"("height": 65500, "format": "jpeg")"), "accepted");
  EXPECT_EQ(image(R"("height": 65501, "format": "jpeg")"), "/image/height");
  EXPECT_EQ(image(R"("height": 65501, "format": "png")"), "accepted");
  EXPECT_EQ(refused_at(R"({"camera": {"projection": "cubemap"},
                           "image": {"width": 16384, "format": "jpeg"}})"),
            "/image/height");
}

// As the daemon does for the Accept header.
TEST(Reading, AFormatThatIsSetBesideTheDocumentHasItsLimitsToo) {
  const Json document{{"image", {{"width", 8}, {"height", 65501}}}};
  EXPECT_FALSE(refusal(document));
  const auto error = refusal(with_usual_format(document, "jpeg"));
  ASSERT_TRUE(error);
  EXPECT_EQ(error->pointer, "/image/height");
  EXPECT_EQ(error->allowed, "at most 65500");
}

TEST(Reading, TheSunIsOutsideTheAir) {
  EXPECT_EQ(refused_at(R"({"sun": {"distance_km": 6460}})"), "/sun/distance_km");
  EXPECT_EQ(refused_at(R"({"sun": {"distance_km": 6461}})"), "accepted");
}

TEST(Reading, APerspectiveSeesLessThanHalfOfEverything) {
  EXPECT_EQ(refused_at(R"({"camera": {"fov_deg": 180}})"), "/camera/fov_deg");
  EXPECT_EQ(refused_at(R"({"camera": {"fov_deg": 360, "projection": "fisheye"}})"), "accepted");
}

TEST(Reading, LayersAndSpectraGoOnlyIntoFilesThatHoldThem) {
  EXPECT_EQ(refused_at(R"({"image": {"layers": ["sun"]}})"), "/image/layers");
  EXPECT_EQ(refused_at(R"({"image": {"layers": ["sun"], "format": "npy"}})"), "/image/layers");
  EXPECT_EQ(refused_at(R"({"image": {"layers": ["sun", "inscatter"], "format": "exr"}})"),
            "accepted");
  EXPECT_EQ(refused_at(R"({"image": {"layers": []}})"), "accepted");
  EXPECT_EQ(refused_at(R"({"image": {"channels": "spectral", "format": "hdr"}})"),
            "/image/channels");
  EXPECT_EQ(refused_at(R"({"image": {"channels": "spectral", "format": "npy"}})"), "accepted");
  EXPECT_NE(std::string(refusal(with("/image/layers", Json::array({"sun"})))->what())
                .find("only EXR"),
            std::string::npos);
  EXPECT_EQ(refused_at(R"({"image": {"show": ["sun", "sun"]}})"), "/image/show/1");
}

TEST(Reading, IdleMembersAreValidatedThenIgnored) {
  const Scene panorama =
      scene_of(R"({"camera": {"projection": "equirectangular", "fov_deg": 20}})");
  EXPECT_EQ(panorama, scene_of(R"({"camera": {"projection": "equirectangular"}})"));
  EXPECT_EQ(refused_at(R"({"camera": {"projection": "equirectangular", "fov_deg": 0}})"),
            "/camera/fov_deg");
  EXPECT_EQ(scene_of(R"({"method": {"name": "nishita", "max_error": 0.5}})"),
            scene_of(R"({"method": {"name": "nishita"}})"));
  EXPECT_EQ(scene_of(R"({"image": {"format": "exr", "tone_map": "aces"}})"),
            scene_of(R"({"image": {"format": "exr"}})"));
}

TEST(Reading, AnUnknownNameIsRefusedWithThoseThatThereAre) {
  for (const char* member : {"/method/name", "/planet/surface/type", "/camera/projection"}) {
    const auto error = refusal(with(member, "magic"));
    ASSERT_TRUE(error) << member;
    EXPECT_EQ(error->pointer, member);
    EXPECT_EQ(error->given, "\"magic\"");
    EXPECT_NE(error->allowed.find(" or "), std::string::npos) << error->allowed;
  }
}

TEST(Reading, ARefusalSaysWhereWhatAndWhatIsAllowed) {
  const auto error = refusal(with("/sun/elevation_deg", 91.5));
  ASSERT_TRUE(error);
  EXPECT_EQ(error->pointer, "/sun/elevation_deg");
  EXPECT_EQ(error->given, "91.5");
  EXPECT_EQ(error->allowed, "a number from -90 to 90");
  const auto large = refusal(with("/planet/radius_km", 0));
  EXPECT_EQ(large->allowed, "a number from 1 to 1e7");
  Json strange = Json::object();
  strange["a/b~c"] = std::string(1000, 'x');
  EXPECT_EQ(refusal(strange)->pointer, "/a~1b~0c");
  EXPECT_LE(refusal(strange)->given.size(), 80u);
}

TEST(Reading, NumbersThatAreNotFiniteAreRefused) {
  for (const double bad :
       {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    for (const char* at : {"/sun/elevation_deg", "/image/width", "/planet/ground_albedo",
                           "/method/view_samples"})
      EXPECT_EQ(refusal(with(at, bad))->pointer, at);
}

TEST(Reading, AWholeNumberMayBeWrittenAsAFraction) {
  EXPECT_EQ(scene_of(R"({"image": {"width": 64.0}})").image.width, 64);
  EXPECT_EQ(scene_of(R"({"image": {"width": 1e3}})").image.width, 1000);
  EXPECT_EQ(refused_at(R"({"image": {"width": 64.5}})"), "/image/width");
  EXPECT_EQ(refused_at(R"({"image": {"width": 1e300}})"), "/image/width");
  EXPECT_EQ(refused_at(R"({"image": {"width": "64"}})"), "/image/width");
}

TEST(Reading, APlaceSaysWhereTheSunAndTheCameraStand) {
  const std::string place = R"("sun": {"place": {"latitude_deg": 39.742476,
      "longitude_deg": -105.1786, "time": "2003-10-17T12:30:30-07:00"}})";
  const Scene scene = scene_of("{" + place + "}");
  EXPECT_NEAR(scene.sun.azimuth_deg, 194.340, 0.001);
  EXPECT_NEAR(scene.sun.elevation_deg, 39.872, 0.001);
  EXPECT_EQ(scene.camera.latitude_deg, 39.742476);
  EXPECT_EQ(scene.camera.longitude_deg, -105.1786);
  EXPECT_EQ(scene.camera.sidereal_time_deg, sidereal_time_deg("2003-10-17T12:30:30-07:00"));
  const Scene elsewhere = scene_of(R"({"camera": {"latitude_deg": 5}, )" + place + "}");
  EXPECT_EQ(elsewhere.camera.latitude_deg, 5);
  EXPECT_EQ(elsewhere.sun, scene.sun);
  EXPECT_EQ(refused_at(R"({"sun": {"place": {"latitude_deg": 1, "longitude_deg": 2,
                           "time": "today"}}})"),
            "/sun/place/time");
  EXPECT_EQ(refused_at(R"({"sun": {"place": {"latitude_deg": 1, "longitude_deg": 2}}})"),
            "/sun/place/time");
}

}  // namespace
}  // namespace cyanometer
