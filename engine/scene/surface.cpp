// The planet's surface: how the ground differs from place to place.
#include <regex>

#include "engine/scene/members.h"
#include "engine/scene/variant_object.h"

namespace cyanometer {

// ---- What procedural surfaces are made of: hemispherical reflectances, rounded from the
// spectra that the ECOSTRESS library [Meerdink et al. 2019] and the USGS library [Kokaly et al.
// 2017] hold of such matter

/// Water-leaving reflectance of clear ocean [Morel and Maritorena 2001, fig. 5, chlorophyll of
/// 0.1 to 0.3 mg/m^3].
Spectrum ProceduralSurface::sea_albedo() {
  return SampledSpectrum{{400, 440, 480, 520, 560, 600, 650, 700},
                         {0.046, 0.043, 0.036, 0.018, 0.009, 0.0035, 0.0015, 0.0006}};
}
/// Broad-leaved woods and grass, as a canopy with its shadows.
Spectrum ProceduralSurface::plants_albedo() {
  return SampledSpectrum{
      {400, 450, 500, 530, 555, 590, 630, 675, 700, 730, 760, 1000},
      {0.022, 0.024, 0.034, 0.062, 0.082, 0.058, 0.042, 0.03, 0.09, 0.24, 0.33, 0.36}};
}
/// Sand and dry soil, red with iron.
Spectrum ProceduralSurface::sand_albedo() {
  return SampledSpectrum{{400, 450, 500, 550, 600, 650, 700, 800, 1000},
                         {0.1, 0.135, 0.19, 0.275, 0.37, 0.42, 0.445, 0.48, 0.5}};
}
/// Granite and schist, weathered.
Spectrum ProceduralSurface::rock_albedo() {
  return SampledSpectrum{{400, 500, 600, 700, 1000}, {0.1, 0.135, 0.17, 0.19, 0.2}};
}
/// Snow of some age [Warren 1982, fig. 1: grains of 0.2 mm].
Spectrum ProceduralSurface::ice_albedo() {
  return SampledSpectrum{{400, 500, 600, 700, 800, 1000}, {0.84, 0.85, 0.83, 0.79, 0.73, 0.55}};
}

namespace {

Member<ProceduralSurface, Spectrum> matter(const char* name, Spectrum ProceduralSurface::*field,
                                           const char* title, const char* help) {
  return Member(name, field, spectrum(0, 1), title, help).slider(0, 1, 0.01);
}

ObjectOf<ProceduralSurface> procedural() {
  using S = ProceduralSurface;
  return object<S>(
      Member("seed", &S::seed, integer(0, 16777215), "Seed", "Another seed, another world.")
          .slider(0, 100, 1),
      Member("sea_fraction", &S::sea_fraction, number(0, 1), "Seas",
             "The share of the planet that lies under water.")
          .slider(0, 1, 0.01),
      Member("relief_km", &S::relief_km, number(0, 100), "Relief",
             "Height of the highest peaks above the sea; 0 is a smooth ball.")
          .slider(0, 12, 0.1),
      Member("roughness", &S::roughness, number(0, 1), "Roughness",
             "From rolling hills and smooth coasts to jagged ones.")
          .slider(0, 1, 0.01),
      Member("ice_latitude_deg", &S::ice_latitude_deg, number(0, 90), "Ice",
             "Latitude beyond which ice lies at the height of the sea; 90 leaves none there, 0 "
             "covers all. Mountains bear it nearer to the equator.")
          .slider(0, 90, 1),
      Member("vegetation", &S::vegetation, number(0, 1), "Vegetation",
             "From none to plants on all land without ice; what has none is sand and rock.")
          .slider(0, 1, 0.01),
      Member("wind_m_per_s", &S::wind_m_per_s, number(0, 30), "Wind",
             "Over the sea: the stronger, the wider and fainter the sun's glint.")
          .slider(0, 20, 0.5),
      matter("sea", &S::sea, "Water",
             "Albedo of the water itself; its surface mirrors besides."),
      matter("plants", &S::plants, "Plants", "Albedo of what grows."),
      matter("sand", &S::sand, "Sand", "Albedo of deserts."),
      matter("rock", &S::rock, "Rock", "Albedo of bare mountains."),
      matter("ice", &S::ice, "Ice and snow", "Albedo of ice and snow."));
}

/// The name of a file, and no path to one.
class ImageName final : public Spelling<std::string> {
 public:
  std::string read(const Json& given, const At& at) const override {
    static const std::regex name("[A-Za-z0-9_-]{1,64}\\.(png|jpg|exr)");
    if (!given.is_string() || !std::regex_match(given.get_ref<const std::string&>(), name)) {
      refuse(at, given, words());
    }
    return given;
  }
  Json write(const std::string& value) const override { return value; }
  Json schema(const Surroundings&) const override {
    return {{"type", "string"}, {"pattern", "^[A-Za-z0-9_-]{1,64}\\.(png|jpg|exr)$"}};
  }
  std::string words() const override {
    return "the name of an image in the server's folder: letters, digits, - and _, then .png, "
           ".jpg or .exr";
  }
  bool takes(const Json& given) const override { return given.is_string(); }
};

ObjectOf<MapSurface> map() {
  const Spelled<std::string> name = std::make_shared<ImageName>();
  return object<MapSurface>(
      Member("albedo", &MapSurface::albedo, name, "Colours",
             "Equirectangular image of what the ground reflects, longitude 0 in the middle."),
      Member("height", &MapSurface::height, keyword_or("none", name), "Heights",
             "Equirectangular image of heights; without one the ground is a smooth ball."),
      Member("height_km", &MapSurface::height_km, number(0, 100), "Relief",
             "Height of the heights' white above their black.")
          .slider(0, 20, 0.1)
          .idle_unless([](const MapSurface& map) { return !map.height.empty(); }));
}

}  // namespace

Spelled<Surface> surface() {
  return tagged<Surface>(
      cases<Surface>()
          .type("uniform", "The same everywhere", object<UniformSurface>())
          .type("procedural", "Continents and seas from a seed", procedural())
          .type("map", "Images of the server's folder", map()));
}

}  // namespace cyanometer
