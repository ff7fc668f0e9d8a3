// The engine: scene in, frame out. It owns the Vulkan device and knows no HTTP. All members
// must be called from one thread; frames may be read and encoded on any other.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/image/picture.h"
#include "engine/scene/scene.h"

namespace cyanometer {

/// Work that was given up because nobody waits for it any more, or because its time is over.
struct Cancelled : std::runtime_error {
  enum class Reason { client_gone, deadline } reason;
  explicit Cancelled(Reason r);
};
/// The Vulkan device went away; the engine must be made again.
struct DeviceLost : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// The device has no memory for the work now; it may have when other frames are gone.
struct OutOfDeviceMemory : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// A sound request that is over a limit of this engine.
struct OverLimit : std::runtime_error {
  OverLimit(std::string pointer_, const std::string& detail);
  std::string pointer;  ///< the scene member that is over it
};

/// Looked at between tiles of work.
struct Watch {
  /// True when the result is no longer wanted; called every few tens of milliseconds. It may
  /// use the engine for other work meanwhile.
  std::function<bool()> gone = [] { return false; };
  std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max();
  /// Share of the work done, 0 to 1.
  std::function<void(double)> progress = [](double) {};
  /// @throws Cancelled
  void check() const;
};

/// What will be done for a scene, decided from the scene, the version and the device alone.
struct Plan {
  std::string method;
  std::map<std::string, double> options;
  std::vector<double> wavelengths_nm;
  double expected_error = 1;  ///< bound that holds in 95 % of frames, in the contract's measure
  double expected_ms = 0;     ///< device time
  bool met = true;            ///< false where max_error or max_ms cannot be kept
  std::string why;            ///< in words
};

/// {"method", "options", "wavelengths_nm", "error"}: as in files and answers.
nlohmann::json plan_document(const Plan& plan);

/// A rendered frame: linear planes and, where the format shows them, displayed pixels.
struct Frame {
  int width = 0, height = 0;
  struct Plane {
    std::string channel;   ///< EXR channel name: "R", "550,5nm", "transmittance.B"
    const float* samples;  ///< height rows of width, from the top; valid while the frame lives
  };
  /// Image channels first, then layers; none where pixels were interpolated as displayed.
  std::vector<Plane> planes;
  const unsigned char* rgbx = nullptr;  ///< 4 bytes a pixel, sRGB; null where not asked for
  double exposure_ev = 0;
  double white_luminance = 0;  ///< cd/m^2 of 1.0, 0 where the planes are radiances
  double prepare_ms = 0;       ///< plan and tables
  double render_ms = 0;        ///< the rest of the time on the device
  Plan plan;
  std::string description;  ///< JSON: canonical scene, method, error, version: makes it again
  std::shared_ptr<void> storage;  ///< keeps the pixels alive
};

struct Direction {
  double elevation_deg = 0;
  double azimuth_deg = 0;  ///< clockwise from north
};
struct Radiances {
  std::vector<double> wavelengths_nm;
  std::vector<std::vector<double>> radiance;  ///< [direction][wavelength], scene units
  /// The same per unit of the sun's irradiance, 1/sr. Colours are made of this: the light
  /// between two wavelengths is known also where the sun has none at the wavelengths
  /// themselves.
  std::vector<std::vector<double>> relative;
  std::vector<std::vector<double>> transmittance;  ///< to ground or top
  std::optional<std::vector<std::vector<double>>> standard_error;
  struct Irradiance {
    std::vector<double> direct, diffuse_down, diffuse_up;  ///< by wavelength, horizontal plane
  };
  std::optional<Irradiance> irradiance;
  double prepare_ms = 0;  ///< plan and tables
  double render_ms = 0;   ///< the rest of the time on the device
  Plan plan;
};

struct Panels;

/// Tables kept between requests.
struct TableUse {
  std::size_t bytes = 0;  ///< held now
  double making_ms = 0;   ///< spent on all that were made so far
};

/// Kernels as compiled for a form of scene: constituents, wavelengths, orders, projection.
struct KernelUse {
  std::size_t kept = 0;
  std::uint64_t compiled = 0;  ///< since the engine was made
};

/// For tests: what is to go wrong with the device.
struct EngineFaults {
  int lose_at_submission = 0;    ///< that one from now and all after it fail; 0: none
  std::size_t memory_bytes = 0;  ///< of all buffers together; 0: what there is
};

/// What of a method's error is less where an option is larger.
enum class ErrorSource { none, quadrature, tables, orders, walks };

/// One thing a method can be told, as data: the schema, the page and the documentation read it.
struct MethodOption {
  std::string name, title, description, unit;
  double minimum = 0, maximum = 0, default_value = 0;
  bool integer = true, logarithmic = false;
  ErrorSource lessens = ErrorSource::none;
  std::optional<double> finest = {};  ///< of a switch; of what counts none: more is finer
};

/// What of a scene decides whether it comes near a method's limits.
struct SceneTraits {
  double sun_deg = 0;           ///< elevation at the camera's foot point
  double depth = 0;             ///< vertical, of extinction, where it is largest
  double haze = 0;              ///< vertical, of what particles scatter, where it is largest
  double asymmetry = 0;         ///< largest mean cosine of what scatters a hundredth and more
  double altitude_km = 0;       ///< of the camera
  double thickness_km = 0;      ///< of the air
  double sun_diameter_deg = 0;  ///< of the disc that light comes from; 0 a point
  int scattering_orders = -1;   ///< -1 all
  bool varied_ground = false;   ///< differs from place to place
  bool near_sun = false;        ///< rays of light spread from a point
};
struct MethodLimit {
  std::string words;
  /// Of the stability suite: those in which it shows.
  std::vector<int> rows = {};
  /// Whether a scene comes near it; none: every scene does.
  std::function<bool(const SceneTraits&)> near = {};
};
struct MethodDescription {
  std::string name, title, summary;
  int highest_order = -1;           ///< the highest order it computes; -1 all
  bool random = false;              ///< its values have standard errors
  std::vector<MethodLimit> limits;  ///< where it is not valid
  std::vector<MethodOption> options;
  /// Settings of all options that `auto` may choose from, cheapest first; none where tables
  /// take seconds, which only who knows that many frames will follow should spend.
  std::vector<std::map<std::string, double>> ladder = {};
  /// Changes of the defaults that are charted beside those, cheapest first.
  std::vector<std::map<std::string, double>> variations = {};
};
/// All methods there are, in the order of API.md; `auto` is not one of them.
const std::vector<MethodDescription>& methods();
/// The limits of the method that the scene comes near, in words.
std::vector<std::string> limits_near(const Scene& scene, const std::string& method);

struct DeviceDescription {
  std::string name, driver, api_version, type;
  bool chosen = false;
  std::string why;
};

/// How a software device rounds; see accuracy/precision.h.
enum class Rounding { nearest, up, down, towards_zero };

struct EngineOptions {
  std::string device;  ///< part of a device's name; empty: the best there is
  double longest_dispatch_ms = 50;
  std::size_t table_bytes = std::size_t{256} << 20;  ///< of tables kept between requests
  /// Compiled forms of all kernels that are kept; more for what goes through many scenes.
  std::size_t kernels = 192;
  static constexpr std::size_t kernels_for_many_scenes = 600;
  /// Where the paces of devices are kept (planner/profile.h); empty: nominal ones are reckoned
  /// with.
  std::filesystem::path profiles = {};
  Rounding rounding = Rounding::nearest;  ///< others do nothing on a device of silicon
};

class Engine {
 public:
  explicit Engine(const EngineOptions& options = {});
  ~Engine();
  Engine(Engine&&) noexcept;

  /// @throws OverLimit, Cancelled, DeviceLost
  Plan plan(const Scene& scene, const Watch& watch = {});
  Frame render(const Scene& scene, const Watch& watch = {});
  Radiances radiance(const Scene& scene, const std::vector<Direction>& directions,
                     bool irradiance, const Watch& watch = {});
  /// A client's picture of the frame's size as the scene's air leaves it, in the frame's light:
  /// what stands at the end of a ray hides ground, disc and stars behind it; where nothing
  /// does, the frame is the plain one, and the picture's background lies beyond the air, with
  /// the stars. The transmittance is exact to 1e-3 whatever is asked; the error is that of the
  /// air's light.
  Frame composite(const Scene& scene, const Picture& picture, const Watch& watch = {});
  Plan plan(const Scene& scene, const Picture& picture, const Watch& watch = {});
  Frame composite(const Scene& scene, const Picture& picture, const Plan& plan,
                  const Watch& watch = {});

  /// These two by a plan that is given: nothing is measured for them, and the error that they
  /// state is the plan's.
  Frame render(const Scene& scene, const Plan& plan, const Watch& watch = {});
  Radiances radiance(const Scene& scene, const std::vector<Direction>& directions,
                     bool irradiance, const Plan& plan, const Watch& watch = {});

  /// The tables of the scene's method, which is named, with its options, to be looked at; none
  /// where it shows none. Nothing is planned: the wavelengths are the scene's, or a few.
  /// @throws OverLimit, Cancelled, DeviceLost
  std::vector<Panels> table_panels(const Scene& scene, const Watch& watch = {});

  /// What a frame of the scene would take by such a plan, ms, as plans reckon it.
  double expected_ms(const Scene& scene, const Plan& plan);

  /// The device in use, as it enters an ETag and the logs.
  const DeviceDescription& device() const;
  TableUse tables() const;
  /// The device's memory in use; also from other threads.
  std::size_t device_bytes() const;
  /// Also from other threads.
  KernelUse kernels() const;
  void inject(const EngineFaults& faults);
  /// Drops all tables, as though no frame had been made yet.
  void forget_tables();
  /// Renders a small frame, so that first requests find compiled what most of them need; and
  /// at the first start on a device measures its profile, where profiles are kept.
  /// @throws Cancelled
  void warm(const Watch& watch = {});
  /// Device time of a frame whose tables are made anew. The first of its form compiles too.
  double frame_ms(const Scene& scene, const Plan& plan, const Watch& watch = {});
  /// The median time of a pass that only stores the pixels of such a frame, four at once: what
  /// frames are measured against.
  double store_ms(const Image& image, const Watch& watch = {});
  /// Measures how fast the device is, some seconds, keeps it, and plans by it from now on.
  /// @returns evaluations a millisecond by method
  std::map<std::string, double> measure_profile(const Watch& watch = {});

 private:
  Frame render(const Scene& scene, const Plan& plan, const Picture* picture,
               const Watch& watch);

  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Some `count` of the frame's pixels, those of an even grid's cells whose rays meet air or
/// ground, as errors are measured on; counted row by row from the top.
std::vector<int> sample_pixels(const Scene& scene, int count);
/// The rays through the centres of pixels that lie inside the camera's picture.
std::vector<Direction> pixel_directions(const Scene& scene, const std::vector<int>& pixels);
/// The rays of `sample_pixels`.
std::vector<Direction> sample_directions(const Scene& scene, int count);
/// [pixel] whether its ray meets air or ground: errors are taken over these.
std::vector<bool> measured_pixels(const Scene& scene);

/// All Vulkan devices of this machine, and which one would be used and why.
std::vector<DeviceDescription> list_devices(const EngineOptions& options = {});

/// Key of everything that tables may depend on: equal keys share tables.
std::string atmosphere_key(const Scene& scene);

/// The program's version, as in answers and files.
std::string version();

}  // namespace cyanometer
