// The scene document as a value: what a request asks for, before any physics is computed from
// it. Every member is the one of the same name in the scene document, with the same unit; a
// Scene that came out of `read_scene` is valid, complete and free of members that its own
// choices make idle.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace cyanometer {

// ---- Spectra

/// value (l / at_nm)^exponent at the wavelength l.
struct PowerLaw {
  double value = 0;
  double at_nm = 550;
  double exponent = 0;
  bool operator==(const PowerLaw&) const = default;
};

/// One value for each of `spectrum.wavelengths_nm`, in their order.
struct PerWavelength {
  std::vector<double> values;
  bool operator==(const PerWavelength&) const = default;
};

/// Linear between the wavelengths, constant beyond them. Ascending.
struct SampledSpectrum {
  std::vector<double> wavelengths_nm;
  std::vector<double> values;
  bool operator==(const SampledSpectrum&) const = default;
};

/// A number is the same at every wavelength.
using Spectrum = std::variant<double, PerWavelength, PowerLaw, SampledSpectrum>;

// ---- Constituents

/// exp(-h / scale_height): 1 at the ground.
struct ExponentialProfile {
  double scale_height_km = 8;
  bool operator==(const ExponentialProfile&) const = default;
};
/// max(0, 1 - |h - centre| / half_width).
struct TentProfile {
  double centre_km = 25;
  double half_width_km = 15;
  bool operator==(const TentProfile&) const = default;
};
/// (1 - h / thickness)^2.
struct QuadraticProfile {
  bool operator==(const QuadraticProfile&) const = default;
};
struct UniformProfile {
  bool operator==(const UniformProfile&) const = default;
};
/// Divided by its maximum; linear in log density, linear next to a zero; constant below the
/// first altitude, 0 above the last. Altitudes strictly ascending.
struct TableProfile {
  std::vector<double> altitude_km;
  std::vector<double> density;
  bool operator==(const TableProfile&) const = default;
};
using Profile = std::variant<ExponentialProfile, TentProfile, QuadraticProfile, UniformProfile,
                             TableProfile>;

struct HenyeyGreenstein {
  double g = 0;
  bool operator==(const HenyeyGreenstein&) const = default;
};
struct CornetteShanks {
  double g = 0;
  bool operator==(const CornetteShanks&) const = default;
};
/// Spheres with log-normally distributed radii.
struct MieSpheres {
  double radius_um = 0.1;        ///< number-median radius
  double geometric_sigma = 1.5;  ///< geometric standard deviation, 1 for one size
  std::array<double, 2> refractive_index{1.45,
                                         0};  ///< real part; imaginary, positive absorbing
  bool operator==(const MieSpheres&) const = default;
};
/// Angles 0 to 180, ascending; log-linear in angle; normalised on loading.
struct PhaseTable {
  std::vector<double> angle_deg;
  std::vector<double> values;
  bool operator==(const PhaseTable&) const = default;
};
using Phase = std::variant<HenyeyGreenstein, CornetteShanks, MieSpheres, PhaseTable>;

/// Coefficients given as they are, where the profile is 1.
struct ScatteringCoefficient {
  Spectrum scattering_per_km = 0.0;
  bool operator==(const ScatteringCoefficient&) const = default;
};
/// Coefficients from the gas itself. `refractive_index` names a gas with dispersion ("air",
/// "co2", "n2", "h2", "he", "ch4") or is a spectrum, and holds at 101325 Pa and 288.15 K.
struct Gas {
  std::variant<std::string, Spectrum> refractive_index = std::string("air");
  double pressure_pa = 101325;
  double temperature_k = 288.15;
  std::optional<double> king_factor;  ///< none: that of the named gas, 1 for a spectrum
  bool operator==(const Gas&) const = default;
};
struct Molecules {
  std::variant<Gas, ScatteringCoefficient> optics;
  bool operator==(const Molecules&) const = default;
};

struct ParticleCoefficients {
  Spectrum scattering_per_km = 0.0;
  Spectrum absorption_per_km = 0.0;
  bool operator==(const ParticleCoefficients&) const = default;
};
/// Vertical optical depth of extinction, ground to top.
struct ParticleOpticalDepth {
  Spectrum optical_depth = 0.0;
  Spectrum single_scattering_albedo = 1.0;
  bool operator==(const ParticleOpticalDepth&) const = default;
};
/// Vertical optical depth at one wavelength; the spectrum and the albedo follow from Mie
/// theory.
struct MieOpticalDepth {
  double value = 0;
  double at_nm = 550;
  bool operator==(const MieOpticalDepth&) const = default;
};
/// Extinction 3.912 / visibility at 550 nm where the profile is 1: with Mie spheres the
/// spectrum follows from Mie theory, with any other phase it is the same at every wavelength
/// (as of fog).
struct Visibility {
  double visibility_km = 20;
  Spectrum single_scattering_albedo = 1.0;
  bool operator==(const Visibility&) const = default;
};
struct Particles {
  std::variant<ParticleCoefficients, ParticleOpticalDepth, MieOpticalDepth, Visibility> optics;
  Phase phase = CornetteShanks{0.76};
  bool operator==(const Particles&) const = default;
};

struct AbsorptionCoefficient {
  Spectrum absorption_per_km = 0.0;
  bool operator==(const AbsorptionCoefficient&) const = default;
};
/// A column of ozone, ground to top; 1 Dobson unit is 2.687e20 molecules per square metre.
struct Ozone {
  double dobson_units = 300;
  bool operator==(const Ozone&) const = default;
};
struct Absorber {
  std::variant<AbsorptionCoefficient, Ozone> optics;
  bool operator==(const Absorber&) const = default;
};

struct Constituent {
  Profile profile;
  std::variant<Molecules, Particles, Absorber> matter;
  bool operator==(const Constituent&) const = default;
};

// ---- The parts of a scene

/// `ground_albedo` everywhere.
struct UniformSurface {
  bool operator==(const UniformSurface&) const = default;
};
/// Continents, seas, ice and mountains from a seed; what they are made of is a spectrum each.
struct ProceduralSurface {
  int seed = 1;
  double sea_fraction = 0.7;     ///< of the planet's area
  double relief_km = 0;          ///< of the highest peak that there could be
  double roughness = 0.5;        ///< of coasts and mountains, 0 to 1
  double ice_latitude_deg = 65;  ///< beyond which ice lies at the height of the sea
  double vegetation = 0.5;       ///< 0 none, 1 wherever no ice and no sea is
  double wind_m_per_s = 7;       ///< 12.5 m above the sea, which it roughens
  Spectrum sea = sea_albedo();   ///< of the water below its surface, which mirrors besides
  Spectrum plants = plants_albedo();
  Spectrum sand = sand_albedo();
  Spectrum rock = rock_albedo();
  Spectrum ice = ice_albedo();
  bool operator==(const ProceduralSurface&) const = default;

  static Spectrum sea_albedo(), plants_albedo(), sand_albedo(), rock_albedo(), ice_albedo();
};
/// Images of the operator's folder, equirectangular, longitude 0 in the middle.
struct MapSurface {
  std::string albedo = "albedo.png";  ///< a file's name; its colours are reflectances
  std::string height;                 ///< a file's name; empty: a smooth ball
  double height_km = 8;               ///< of its white, above its black
  bool operator==(const MapSurface&) const = default;
};
using Surface = std::variant<UniformSurface, ProceduralSurface, MapSurface>;

struct Planet {
  double radius_km = 6360;
  Spectrum ground_albedo = 0.1;
  Surface surface;
  bool operator==(const Planet&) const = default;
};

struct Atmosphere {
  double thickness_km = 100;
  std::map<std::string, Constituent> constituents;
  bool operator==(const Atmosphere&) const = default;
};

/// The spectrum measured above the Earth's air, W m^-2 nm^-1 at 1 au.
struct MeasuredSunlight {
  bool operator==(const MeasuredSunlight&) const = default;
};
/// A black body scaled to the real sun's total at 5772 K and 1 au.
struct Blackbody {
  double blackbody_k = 5772;
  bool operator==(const Blackbody&) const = default;
};
using Irradiance = std::variant<MeasuredSunlight, Blackbody, Spectrum>;

struct Sun {
  double elevation_deg = 30;  ///< at the camera's foot point; already that of `sun.place`
  double azimuth_deg = 0;     ///< clockwise from north
  Irradiance irradiance = MeasuredSunlight{};
  double solar_distance_au = 1;  ///< of the planet, for light that is known at 1 au
  double angular_diameter_deg = 0.533;
  int disc_samples = 1;
  std::optional<double> distance_km;  ///< from the planet's centre; none: parallel light
  bool limb_darkening = true;
  bool operator==(const Sun&) const = default;
};

enum class Projection { perspective, fisheye, equirectangular, cubemap };

struct Camera {
  double altitude_km = 0.002;
  double latitude_deg = 0;
  double longitude_deg = 0;
  double sidereal_time_deg = 0;  ///< at longitude 0; already that of `sun.place`
  double heading_deg = 0;
  double pitch_deg = 10;
  double roll_deg = 0;
  Projection projection = Projection::perspective;
  double fov_deg = 60;
  bool operator==(const Camera&) const = default;
};

enum class Colour { channels, cie };

struct SpectrumChoice {
  std::vector<double> wavelengths_nm;  ///< empty: "auto"
  Colour colour = Colour::cie;
  bool operator==(const SpectrumChoice&) const = default;
};

struct MethodChoice {
  std::string name = "auto";
  std::optional<double> max_error;
  std::optional<double> max_ms;
  bool verify = false;
  std::optional<int> scattering_orders;   ///< none: "all"
  std::map<std::string, double> options;  ///< of the named method, all of them; empty for auto
  bool operator==(const MethodChoice&) const = default;
};

enum class ImageFormat { png, exr, jpeg, hdr, npy };
enum class Channels { rgb, spectral };
enum class ToneMap { linear, reinhard, exponential, aces, agx };

struct WhitePoint {
  enum class Kind { d65, sun, kelvin } kind = Kind::d65;
  double kelvin = 6504;  ///< where kind is kelvin
  bool operator==(const WhitePoint&) const = default;
};
struct Layers {
  bool transmittance = false, inscatter = false, ground = false, sun = false;
  bool operator==(const Layers&) const = default;
};
struct Show {
  bool sun = true, stars = true, ground = true, clipped = false;
  bool operator==(const Show&) const = default;
};

struct Image {
  int width = 1280;
  int height = 720;
  ImageFormat format = ImageFormat::png;
  Channels channels = Channels::rgb;
  Layers layers;
  std::optional<double> exposure_ev;  ///< none: "auto"
  ToneMap tone_map = ToneMap::agx;
  WhitePoint white;
  Show show;
  bool operator==(const Image&) const = default;
};

struct Scene {
  Planet planet;
  Atmosphere atmosphere;
  Sun sun;
  Camera camera;
  SpectrumChoice spectrum;
  MethodChoice method;
  Image image;
  bool operator==(const Scene&) const = default;
};

}  // namespace cyanometer
