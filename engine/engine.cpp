#include "engine/engine.h"

#include <algorithm>
#include <array>
#include <cfenv>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>
#include <unordered_map>

#include "engine/display/compositor.h"
#include "engine/fingerprint.h"
#include "engine/image/encode.h"
#include "engine/irradiance.h"
#include "engine/methods/method.h"
#include "engine/optics/colour.h"
#include "engine/planner/nearby.h"
#include "engine/planner/planner.h"
#include "engine/planner/profile.h"
#include "engine/problem.h"
#include "engine/scene/document.h"
#include "engine/surface/surface_pass.h"

namespace cyanometer {
namespace {

using Clock = std::chrono::steady_clock;
/// Rays on which a plan's errors are measured.
constexpr int probes = 512;
using Samples = std::vector<std::vector<double>>;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

glm::dvec3 unit_vector(const Direction& d) {
  double elevation = glm::radians(d.elevation_deg), azimuth = glm::radians(d.azimuth_deg);
  return {std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth),
          std::sin(elevation)};
}

bool meets_air_or_ground(Physics<double>& camera, int pixel) {
  auto ray = camera.pixel_ray(pixel);
  return ray.inside && camera.meets_planet(camera.path_from_camera(ray.direction));
}

/// One pixel from each cell of an even grid, off its centre so that no row or column of the
/// picture is looked at twice as often as another; those that meet air or ground.
std::vector<int> pixels_of_grid(Physics<double>& camera, int columns, int rows) {
  int width = camera.scene.width, height = camera.scene.height;
  std::vector<int> pixels;
  for (int cell = 0; cell < columns * rows; ++cell) {
    // Additive recurrence on the plastic number: evenly spread offsets without a random number.
    double u = std::fmod(0.5 + cell * 0.7548776662466927, 1.0);
    double v = std::fmod(0.5 + cell * 0.5698402909980532, 1.0);
    int x = static_cast<int>((cell % columns + u) / columns * width);
    int y = static_cast<int>((cell / columns + v) / rows * height);
    int pixel = std::min(y, height - 1) * width + std::min(x, width - 1);
    if (meets_air_or_ground(camera, pixel)) pixels.push_back(pixel);
  }
  return pixels;
}

/// At least `count` of the frame's pixels that meet air or ground, or nearly all that do.
std::vector<int> stratified_pixels(Physics<double>& camera, int count) {
  constexpr int finest = 1024;
  int width = camera.scene.width, height = camera.scene.height;
  for (int side = static_cast<int>(std::lround(std::sqrt(count)));;) {
    std::vector<int> pixels =
        pixels_of_grid(camera, std::min(side, width), std::min(side, height));
    auto found = static_cast<int>(pixels.size());
    if (found >= count || side >= std::min(finest, std::max(width, height))) return pixels;
    double finer = std::sqrt(static_cast<double>(count) / std::max(found, 1));
    side = std::min(std::max(side + 1, static_cast<int>(1.03 * finer * side)), finest);
  }
}

template <class T>
void append_bytes(std::string& key, const std::vector<T>& values) {
  auto bytes = std::as_bytes(std::span(values));
  key.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

/// Rays that are traced by themselves, as from a list.
struct Rays {
  std::vector<glm::dvec3> directions;
  std::vector<float> ends_km = {};   ///< none where all go on as far as they can
  std::vector<Triple> colours = {};  ///< of what stands at the ends, R, G, B
};

/// @param picture  where the rays of all pixels end, if anywhere
Rays stratified_rays(Physics<double>& camera, int count, const Picture* picture) {
  Rays rays;
  for (int pixel : stratified_pixels(camera, count)) {
    rays.directions.push_back(camera.pixel_ray(pixel).direction);
    if (!picture) continue;
    auto at = static_cast<std::size_t>(pixel);
    const auto& rgb = picture->rgb;
    rays.ends_km.push_back(picture->distance_km[at]);
    rays.colours.push_back({rgb[0][at], rgb[1][at], rgb[2][at]});
  }
  return rays;
}

/// Radiance of the channels in which errors are measured: X, Y, Z or the wavelengths
/// themselves.
Samples in_error_channels(const Samples& radiance, const Scene& scene, const Output& output) {
  if (scene.spectrum.colour != Colour::cie) return radiance;
  Samples result;
  for (const std::vector<double>& ray : radiance) {
    std::vector<double>& xyz = result.emplace_back(3, 0.0);
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t w = 0; w < ray.size(); ++w) xyz[c] += output.xyz[c][w] * ray[w];
    }
  }
  return result;
}

/// Wavelengths that hold the transmittance of a channel to 1e-3 (tests/composite).
constexpr int transmittance_wavelengths = 24;

std::vector<double> wavelengths_of_transmittance(const Scene& scene) {
  return scene.spectrum.wavelengths_nm.empty() ? colour_wavelengths(transmittance_wavelengths)
                                               : scene.spectrum.wavelengths_nm;
}

/// What stands at the ends of rays, as the air before it leaves it, in the channels in which
/// errors are measured.
Samples picture_light(const Scene& scene, const Rays& rays) {
  std::vector<double> wavelengths = wavelengths_of_transmittance(scene);
  Output output = make_output(scene, wavelengths);
  auto rows = transmittance_rows(scene, wavelengths);
  Physics<double> p = pack<double>(make_problem(scene, wavelengths));
  set_directions(p, rays.directions);
  p.ends_km.assign(rays.ends_km.begin(), rays.ends_km.end());
  p.scene.ends = static_cast<int>(p.ends_km.size());
  Samples light;
  for (std::size_t i = 0; i < rays.directions.size(); ++i) {
    int ray = static_cast<int>(i);
    auto path = p.path_of_ray(ray, p.pixel_ray(ray));
    double column[Physics<double>::MEDIA_SIZE];
    p.columns_along(path.altitude_km, path.mu, path.length_km, column);
    Triple seen{};
    for (std::size_t w = 0; !path.meets_ground && w < wavelengths.size(); ++w) {
      int group = static_cast<int>(w / 4), lane = static_cast<int>(w % 4);
      double transmittance = p.transmittance_of(column, group)[lane];
      for (std::size_t c = 0; c < 3; ++c) {
        seen[c] += rows[c][w] * transmittance * rays.colours[i][c];
      }
    }
    bool cie = scene.spectrum.colour == Colour::cie;
    if (cie) seen = xyz_from_rec709() * seen;
    for (std::size_t c = 0; !cie && c < 3; ++c) seen[c] /= output.irradiance[c];
    light.emplace_back(seen.begin(), seen.end());
  }
  return light;
}

/// The scene's wavelengths, or a few where it leaves the choice.
std::vector<double> some_wavelengths_of(const Scene& scene) {
  return scene.spectrum.wavelengths_nm.empty() ? colour_wavelengths(4)
                                               : scene.spectrum.wavelengths_nm;
}

std::string describe(const Scene& scene, const Plan& plan) {
  nlohmann::json document = plan_document(plan);
  document["scene"] = canonical(scene);
  document["version"] = version();
  return document.dump();
}

/// Threads begin with the rounding of the one that makes them: those of a driver that
/// calculates on the processor keep what is set while the device is made.
class RoundingOfNewThreads {
 public:
  explicit RoundingOfNewThreads(Rounding rounding) : before_(std::fegetround()) {
    constexpr std::array modes{FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
    std::fesetround(modes[static_cast<std::size_t>(rounding)]);
  }
  ~RoundingOfNewThreads() { std::fesetround(before_); }
  RoundingOfNewThreads(const RoundingOfNewThreads&) = delete;

 private:
  int before_;
};

vulkan::Device make_device(const EngineOptions& options) {
  const RoundingOfNewThreads scope(options.rounding);
  return vulkan::Device(options.device);
}

}  // namespace

nlohmann::json plan_document(const Plan& plan) {
  nlohmann::json options = nlohmann::json::object();
  for (auto [name, value] : plan.options) {
    if (value == std::floor(value)) {
      options[name] = static_cast<std::int64_t>(value);
    } else {
      options[name] = value;
    }
  }
  return {{"method", plan.method},
          {"options", options},
          {"wavelengths_nm", plan.wavelengths_nm},
          {"error", plan.expected_error}};
}

Cancelled::Cancelled(Reason r)
    : std::runtime_error(r == Reason::deadline ? "the deadline has passed"
                                               : "nobody waits for the result"),
      reason(r) {}

OverLimit::OverLimit(std::string pointer_, const std::string& detail)
    : std::runtime_error(detail), pointer(std::move(pointer_)) {}

void Watch::check() const {
  if (gone()) throw Cancelled(Cancelled::Reason::client_gone);
  if (Clock::now() > deadline) throw Cancelled(Cancelled::Reason::deadline);
}

/// What lives as long as the device.
struct Engine::Parts {
  explicit Parts(const EngineOptions& options)
      : device(make_device(options)),
        commands(device),
        longest_dispatch_ms(options.longest_dispatch_ms),
        tables(options.table_bytes),
        methods(make_methods(device)),
        compositor(device),
        surface(device),
        profiles(options.profiles) {
    const vulkan::DeviceInfo& info = device.info();
    identity = info.name + ", " + info.driver + ", " + info.api_version + ", " + version();
    if (auto kept = load_profile(profiles, identity)) profile = *kept;
    device.keep_pipelines(options.kernels);
  }

  vulkan::Device device;
  vulkan::Commands commands;
  double longest_dispatch_ms;
  /// By method: what one counts as an evaluation takes another time than what others do.
  std::unordered_map<std::string, Pacer> pacers;
  TableCache tables;
  std::vector<std::unique_ptr<Method>> methods;
  Compositor compositor;
  SurfacePass surface;
  std::filesystem::path profiles;
  std::string identity;  ///< of the device and the version
  DeviceProfile profile;
  DeviceDescription description;
  std::unordered_map<std::string, Plan> plans;  ///< by the scene that stands for those alike

  Method& method(const std::string& name) {
    for (auto& m : methods) {
      if (m->description().name == name) return *m;
    }
    throw std::logic_error("no method is called " + name);
  }

  struct Traced {
    Samples radiance, transmittance;  ///< [ray][wavelength], radiance per unit irradiance
    Samples standard_error;           ///< of random methods, else empty
    double device_ms = 0;
  };

  /// Some of the wavelengths of a problem, on the device.
  struct Batch {
    std::size_t first;  ///< wavelength
    UploadedScene scene;
    /// The same over black ground, where both are needed (SurfacePass::Left::tables).
    std::optional<UploadedScene> black = std::nullopt;

    std::size_t wavelengths() const { return scene.problem().wavelengths_nm.size(); }
  };

  /// @param work  a method's name, or any other work's
  Tracer tracer(const std::string& work, const Watch& watch) {
    Pacer& pacer = pacers.try_emplace(work, longest_dispatch_ms).first->second;
    return {device, commands, pacer, tables, watch};
  }

  /// All wavelengths; the rays are those given, or the camera's where no directions are.
  /// @param most  wavelengths of a batch
  std::vector<Batch> upload(const Problem& problem, const Rays& rays = {},
                            std::size_t most = wavelengths_at_once, GroundBuffers ground = {}) {
    auto ends =
        rays.ends_km.empty() ? nullptr : std::make_shared<const RayEnds>(device, rays.ends_km);
    std::vector<Batch> batches;
    std::size_t count = problem.wavelengths_nm.size();
    for (std::size_t first = 0; first < count; first += most) {
      Problem part = at_wavelengths(problem, first, std::min(most, count - first));
      batches.push_back({first, UploadedScene(device, part, rays.directions, ends, ground)});
    }
    return batches;
  }

  GroundBuffers ground_before(const Problem& problem, const Rays& rays, const Watch& watch) {
    Tracer tracer = this->tracer("surface", watch);
    int count = rays.directions.empty() ? problem.width * problem.height
                                        : static_cast<int>(rays.directions.size());
    GroundBuffers ground{surface.texels(tracer, *problem.ground), nullptr};
    UploadedScene scene(device, at_wavelengths(problem, 0, 1), rays.directions, nullptr,
                        ground);
    ground.distances_km =
        std::make_shared<const vulkan::Buffer>(surface.distances(tracer, scene, count));
    return ground;
  }

  /// What of a client's picture stands before the ground's heights, and these, black.
  Picture before_heights(const Problem& problem, Picture picture, const Watch& watch) {
    if (!has_heights(problem)) return picture;
    GroundBuffers ground = ground_before(problem, {}, watch);
    auto ground_km = ground.distances_km->as<const float>();
    for (std::size_t i = 0; i < ground_km.size(); ++i) {
      if (ground_km[i] >= picture.distance_km[i]) continue;
      picture.distance_km[i] = ground_km[i];
      for (std::vector<float>& plane : picture.rgb) plane[i] = 0;
    }
    return picture;
  }

  /// The same for a method, where the ground may differ from place to place. Heights end rays
  /// as objects do.
  std::vector<Batch> upload_with_ground(const Problem& problem, Rays rays,
                                        const std::string& name, const Watch& watch) {
    if (!problem.ground) return upload(problem, rays);
    GroundBuffers ground = ground_before(problem, rays, watch);
    if (has_heights(problem)) end_at(ground.distances_km->as<const float>(), rays);
    std::vector<Batch> batches = upload(problem, rays, wavelengths_at_once, ground);
    if (left_by(method(name), problem) != SurfacePass::Left::tables) return batches;
    Problem black = problem;
    std::ranges::fill(black.ground_albedo, 0.0);
    std::vector<Batch> over_black = upload(black, rays, wavelengths_at_once, ground);
    for (std::size_t b = 0; b < batches.size(); ++b) {
      batches[b].black = std::move(over_black[b].scene);
    }
    return batches;
  }

  static SurfacePass::Left left_by(const Method& method, const Problem& problem) {
    if (method.reflects()) return SurfacePass::Left::walks;
    int orders = problem.scattering_orders;
    bool one = orders == 0 || orders == 1 || method.description().highest_order == 1;
    return one ? SurfacePass::Left::order_one : SurfacePass::Left::tables;
  }

  static void end_at(std::span<const float> ground_km, Rays& rays) {
    if (rays.ends_km.empty()) {
      rays.ends_km.assign(ground_km.begin(), ground_km.end());
      return;
    }
    for (std::size_t i = 0; i < ground_km.size(); ++i) {
      rays.ends_km[i] = std::min(rays.ends_km[i], ground_km[i]);
    }
  }

  /// Calls `visit(batch, tile)` for every batch and tile once it is traced: all tiles of a
  /// batch one after the other, whose tables are held meanwhile.
  template <typename Visit>
  void trace_tiles(Tracer& tracer, const std::string& name, const MethodOptions& options,
                   const std::vector<Batch>& batches, int rays, Visit visit) {
    Method& m = method(name);
    Tracer on_ground = this->tracer("surface", tracer.watch);
    const UploadedScene& largest = batches.front().scene;
    int at_once = std::min(m.rays_at_once(largest, options, tracer.pacer), rays);
    vulkan::Buffer values(device, Tile::bytes(m.description(), largest.groups(), at_once),
                          vulkan::Memory::host);
    std::optional<vulkan::Buffer> black;
    if (batches.front().black) black.emplace(device, values.size(), vulkan::Memory::host);
    for (std::size_t b = 0; b < batches.size(); ++b) {
      const Batch& batch = batches[b];
      tracer.tables.give_up();
      for (int first = 0; first < rays; first += at_once) {
        Tile tile{first, std::min(at_once, rays - first), values};
        m.trace(tracer, batch.scene, options, tile);
        if (batch.black) m.trace(tracer, *batch.black, options, {first, tile.rays, *black});
        if (batch.scene.ground_km()) {
          surface.light(on_ground, batch.scene, left_by(m, batch.scene.problem()), tile,
                        black ? *black : values);
        }
        visit(b, tile);
        const double done = static_cast<double>(first + tile.rays) / rays;
        tracer.watch.progress((static_cast<double>(b) + done) /
                              static_cast<double>(batches.size()));
      }
    }
    tracer.device_ms += on_ground.device_ms;
  }

  Traced trace_rays(const Problem& problem, const Rays& rays, const std::string& method_name,
                    const MethodOptions& options, const Watch& watch) {
    Traced traced;
    const std::vector<glm::dvec3>& directions = rays.directions;
    if (directions.empty()) return traced;
    std::vector<double> dark(problem.wavelengths_nm.size(), 0.0);
    traced.radiance.assign(directions.size(), dark);
    traced.transmittance.assign(directions.size(), dark);
    bool random = method(method_name).description().random;
    if (random) traced.standard_error.assign(directions.size(), dark);
    std::vector<Batch> batches = upload_with_ground(problem, rays, method_name, watch);
    Tracer tracer = this->tracer(method_name, watch);
    auto read = [&](std::size_t b, const Tile& tile) {
      const Batch& batch = batches[b];
      auto values = tile.values.as<const glm::vec4>();
      for (std::size_t w = 0; w < batch.wavelengths(); ++w) {
        for (int ray = 0; ray < tile.rays; ++ray) {
          auto value = [&](int quantity) -> double {
            std::size_t plane = quantity * batch.scene.groups() + w / 4;
            return values[plane * tile.rays + ray][static_cast<int>(w % 4)];
          };
          std::size_t at = tile.first_ray + ray;
          if (problem.scattering_orders != 0) {
            traced.radiance[at][batch.first + w] = value(0) + value(1);
          }
          traced.transmittance[at][batch.first + w] = value(2);
          if (random) traced.standard_error[at][batch.first + w] = value(3);
        }
      }
    };
    trace_tiles(tracer, method_name, options, batches, static_cast<int>(directions.size()),
                read);
    traced.device_ms = tracer.device_ms;
    return traced;
  }

  /// @param probes  some of the rays
  Plan plan(const Scene& scene, const Rays& probes, Extent extent, const Watch& watch) {
    bool parts = !probes.ends_km.empty();
    Samples light = parts ? picture_light(scene, probes) : Samples{};
    TraceProbe probe = [&](const std::string& name, const MethodOptions& options,
                           const std::vector<double>& wavelengths) {
      Problem problem = make_problem(scene, wavelengths);
      Watch quiet = watch;
      quiet.progress = [](double) {};
      Traced traced = trace_rays(problem, probes, name, options, quiet);
      Samples seen = in_error_channels(traced.radiance, scene, make_output(scene, wavelengths));
      for (std::size_t i = 0; i < light.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) seen[i][c] += light[i][c];
      }
      return seen;
    };
    return make_plan({scene, extent, methods, profile, probe,
                      parts || has_heights(make_problem(scene, some_wavelengths_of(scene)))});
  }

  /// Of frames that are nearly alike one is planned for all, unless this very one is to be
  /// verified.
  Plan plan_frame(const Scene& scene, const Watch& watch) {
    if (scene.method.verify) return plan_this_frame(scene, watch);
    Scene alike = nearby(scene);
    return known_plan(canonical(alike).dump() + ground_revision(alike),
                      [&] { return plan_this_frame(alike, watch); });
  }

  /// The plan of one picture holds for no other.
  Plan plan_composite(const Scene& scene, const Picture& picture, const Watch& watch) {
    Rays rays = probes_of(scene, &picture);
    std::string key = canonical(scene).dump() + ground_revision(scene);
    append_bytes(key, rays.ends_km);
    append_bytes(key, rays.colours);
    return known_plan(key, [&] { return plan(scene, rays, extent_of(scene), watch); });
  }

  template <class Make>
  Plan known_plan(const std::string& key, Make make) {
    constexpr std::size_t most_plans = 4096, longest_key = 1 << 14;
    if (auto known = plans.find(key); known != plans.end()) return known->second;
    if (plans.size() >= most_plans) plans.clear();
    Plan plan = make();
    if (key.size() > longest_key) return plan;  // spectra of thousands of numbers fill a memory
    return plans[key] = std::move(plan);
  }

  /// The share of pixels that meet something is told from some of them.
  static Extent extent_of(const Scene& scene) {
    constexpr int side = 48;
    Physics<double> camera = pack<double>(make_problem(scene, some_wavelengths_of(scene)));
    const int columns = std::min(side, scene.image.width),
              rows = std::min(side, scene.image.height);
    const auto met = static_cast<double>(pixels_of_grid(camera, columns, rows).size());
    const double pixels = static_cast<double>(scene.image.width) * scene.image.height;
    return {pixels * met / (columns * rows), pixels};
  }

  static Rays probes_of(const Scene& scene, const Picture* picture) {
    Physics<double> camera = pack<double>(make_problem(scene, some_wavelengths_of(scene)));
    return stratified_rays(camera, probes, picture);
  }

  Plan plan_this_frame(const Scene& scene, const Watch& watch) {
    return plan(scene, probes_of(scene, nullptr), extent_of(scene), watch);
  }

  void trace_frame(const Problem& problem, const Plan& plan,
                   const std::vector<PlaneGroup>& groups, const Picture* picture,
                   const Watch& watch, Frame& frame, FrameStore& store);
  void overlay(const Scene& scene, const std::vector<PlaneGroup>& groups,
               const Picture& picture, const Watch& watch, Frame& frame, FrameStore& store);
  void display(const Scene& scene, const Output& output, const Watch& watch, Frame& frame,
               FrameStore& store);
};

Engine::Engine(const EngineOptions& options) : parts_(std::make_unique<Parts>(options)) {
  const vulkan::DeviceInfo& info = parts_->device.info();
  parts_->description = {info.name, info.driver, info.api_version, info.type, true, info.why};
}
Engine::~Engine() = default;
Engine::Engine(Engine&&) noexcept = default;

const DeviceDescription& Engine::device() const { return parts_->description; }

Plan Engine::plan(const Scene& scene, const Watch& watch) {
  return parts_->plan_frame(scene, watch);
}

double Engine::expected_ms(const Scene& scene, const Plan& plan) {
  return cyanometer::expected_ms(parts_->profile, parts_->method(plan.method), plan.options,
                                 make_problem(scene, some_wavelengths_of(scene)),
                                 Parts::extent_of(scene), plan.wavelengths_nm.size());
}

namespace {

/// The camera's rays, as a picture ends them.
Rays rays_of(const Picture* picture) {
  return picture ? Rays{{}, picture->distance_km} : Rays{};
}

}  // namespace

void Engine::Parts::trace_frame(const Problem& problem, const Plan& plan,
                                const std::vector<PlaneGroup>& groups, const Picture* picture,
                                const Watch& watch, Frame& frame, FrameStore& store) {
  std::vector<Batch> batches =
      upload_with_ground(problem, rays_of(picture), plan.method, watch);
  std::vector<Compositor::Job> jobs;
  for (const Batch& batch : batches) {
    jobs.push_back(compositor.prepare(device, batch.scene, groups, batch.first,
                                      problem.wavelengths_nm.size()));
  }
  Tracer tracer = this->tracer(plan.method, watch);
  auto compose = [&](std::size_t b, const Tile& tile) {
    compositor.compose(commands, jobs[b], tile, store);
    tracer.submit();
  };
  trace_tiles(tracer, plan.method, plan.options, batches, static_cast<int>(store.pixels),
              compose);
  frame.render_ms += tracer.device_ms;
}

void Engine::Parts::overlay(const Scene& scene, const std::vector<PlaneGroup>& groups,
                            const Picture& picture, const Watch& watch, Frame& frame,
                            FrameStore& store) {
  std::vector<double> wavelengths = wavelengths_of_transmittance(scene);
  std::vector<UploadedScene> scenes;
  Problem problem = make_problem(scene, wavelengths);
  Picture shown = before_heights(problem, picture, watch);
  for (Batch& batch : upload(problem, rays_of(&shown), transmittance_wavelengths)) {
    scenes.push_back(std::move(batch.scene));
  }
  std::array<double, 3> luminance{1. / 3, 1. / 3, 1. / 3};
  if (scene.spectrum.colour == Colour::cie) {
    std::ranges::copy_n(xyz_from_rec709().begin() + 3, 3, luminance.begin());
  }
  Tracer tracer = this->tracer("overlay", watch);
  compositor.overlay(tracer, scenes, transmittance_rows(scene, wavelengths), shown, groups,
                     luminance, store);
  frame.render_ms += tracer.device_ms;
}

void Engine::Parts::display(const Scene& scene, const Output& output, const Watch& watch,
                            Frame& frame, FrameStore& store) {
  frame.exposure_ev = scene.image.exposure_ev
                          ? *scene.image.exposure_ev
                          : automatic_exposure_ev(store.samples(0, 3), output.white_card);
  if (store.rgbx.empty()) return;
  Tracer tracer = this->tracer("display", watch);
  compositor.display(tracer, scene.image, output, frame.exposure_ev, store);
  frame.rgbx = store.rgbx.front().as<const unsigned char>().data();
  frame.render_ms += tracer.device_ms;
}

Frame Engine::render(const Scene& scene, const Watch& watch) {
  auto start = Clock::now();
  Plan plan = parts_->plan_frame(scene, watch);
  double planning_ms = ms_since(start);
  Frame frame = render(scene, plan, watch);
  frame.prepare_ms += planning_ms;
  return frame;
}

Frame Engine::render(const Scene& scene, const Plan& plan, const Watch& watch) {
  return render(scene, plan, nullptr, watch);
}

Plan Engine::plan(const Scene& scene, const Picture& picture, const Watch& watch) {
  return parts_->plan_composite(scene, picture, watch);
}

Frame Engine::composite(const Scene& scene, const Picture& picture, const Watch& watch) {
  auto start = Clock::now();
  Plan plan = this->plan(scene, picture, watch);
  double planning_ms = ms_since(start);
  Frame frame = composite(scene, picture, plan, watch);
  frame.prepare_ms += planning_ms;
  return frame;
}

Frame Engine::composite(const Scene& scene, const Picture& picture, const Plan& plan,
                        const Watch& watch) {
  return render(scene, plan, &picture, watch);
}

Frame Engine::render(const Scene& scene, const Plan& plan, const Picture* picture,
                     const Watch& watch) {
  auto start = Clock::now();
  Frame frame;
  frame.width = scene.image.width;
  frame.height = scene.image.height;
  frame.plan = plan;
  Problem problem = make_problem(scene, frame.plan.wavelengths_nm);
  Output output = make_output(scene, frame.plan.wavelengths_nm);
  std::vector<PlaneGroup> groups =
      picture ? composite_groups(scene, problem, output) : plane_groups(scene, problem, output);
  auto store = std::make_shared<FrameStore>(
      parts_->device, static_cast<std::size_t>(frame.width) * frame.height, groups.size(),
      encoding(scene.image.format).displayed);
  frame.prepare_ms = ms_since(start);
  auto rendering = Clock::now();
  double tables_before = parts_->tables.making_ms();
  parts_->trace_frame(problem, frame.plan, groups, picture, watch, frame, *store);
  if (picture) parts_->overlay(scene, groups, *picture, watch, frame, *store);
  double tables_ms = parts_->tables.making_ms() - tables_before;
  parts_->display(scene, output, watch, frame, *store);
  frame.prepare_ms += tables_ms;
  frame.render_ms = ms_since(rendering) - tables_ms;
  bool rgb = scene.image.channels == Channels::rgb;
  for (std::size_t g = rgb ? 0 : 1; g < groups.size(); ++g) {
    for (std::size_t k = 0; k < groups[g].channels.size(); ++k) {
      frame.planes.push_back({groups[g].channels[k], store->samples(g, k).data()});
    }
  }
  frame.white_luminance =
      rgb && scene.spectrum.colour == Colour::cie ? output.white_luminance : 0;
  frame.description = describe(scene, frame.plan);
  frame.storage = store;
  return frame;
}

namespace {

/// Of one point of the sun's disc: where it stands, and the irradiance that it gives a
/// horizontal plane at the camera, per unit of the sun's and by wavelength, through no air.
struct LitPoint {
  glm::dvec3 direction;
  std::vector<double> irradiance;
};

/// The points of the disc that neither the ground nor its heights hide from the camera.
std::vector<LitPoint> lit_points(Physics<double>& physics, std::size_t wavelengths) {
  double altitude_km = physics.scene.camera_altitude_km;
  glm::dvec3 camera(0, 0, physics.scene.planet_radius_km + altitude_km);
  double visible = 1;
  if (physics.SURFACE_KIND != Physics<double>::SURFACE_UNIFORM) {
    constexpr double detail = 1e-4;  // of the planet's radius, as raymarch.comp
    visible = physics.sun_over_heights(camera, altitude_km,
                                       physics.sun_ray(camera, glm::dvec3(0)).direction,
                                       detail * physics.scene.planet_radius_km);
  }
  std::vector<LitPoint> points;
  for (int k = 0; k < physics.scene.disc_points; ++k) {
    auto sun = physics.sun_ray(camera, physics.sun_offset(k));
    if (!(sun.direction.z > 0) || physics.path_from_camera(sun.direction).meets_ground)
      continue;
    LitPoint& point = points.emplace_back(LitPoint{sun.direction, {}});
    for (std::size_t w = 0; w < wavelengths; ++w) {
      double weight = physics.sun_weight(k, static_cast<int>(w / 4))[static_cast<int>(w % 4)];
      point.irradiance.push_back(visible * weight * sun.irradiance * sun.direction.z);
    }
  }
  return points;
}

std::vector<double> weighted_sum(const Samples& radiance, const std::vector<double>& weights,
                                 std::size_t wavelengths) {
  std::vector<double> sum(wavelengths, 0.0);
  for (std::size_t i = 0; i < radiance.size(); ++i) {
    for (std::size_t w = 0; w < wavelengths; ++w) sum[w] += weights[i] * radiance[i][w];
  }
  return sum;
}

void scale_by(const std::vector<double>& irradiance, Samples& radiance) {
  for (auto& ray : radiance) {
    for (std::size_t w = 0; w < ray.size(); ++w) ray[w] *= irradiance[w];
  }
}

}  // namespace

namespace {

std::vector<glm::dvec3> unit_vectors(const std::vector<Direction>& directions) {
  std::vector<glm::dvec3> vectors;
  for (const Direction& d : directions) vectors.push_back(unit_vector(d));
  return vectors;
}

/// As many as a plan looks at.
std::vector<glm::dvec3> evenly_from(const std::vector<glm::dvec3>& rays) {
  std::size_t count = std::min<std::size_t>(probes, rays.size());
  std::vector<glm::dvec3> some;
  for (std::size_t i = 0; i < count; ++i) some.push_back(rays[i * rays.size() / count]);
  return some;
}

}  // namespace

Radiances Engine::radiance(const Scene& scene, const std::vector<Direction>& directions,
                           bool irradiance, const Watch& watch) {
  auto start = Clock::now();
  // Errors of radiances are always by wavelength.
  Scene spectral = scene;
  spectral.spectrum.colour = Colour::channels;
  if (scene.spectrum.wavelengths_nm.empty()) {
    spectral.spectrum.wavelengths_nm = colour_wavelengths(16);
  }
  std::vector<glm::dvec3> rays = unit_vectors(directions);
  Plan plan =
      parts_->plan(spectral, {evenly_from(rays)}, {static_cast<double>(rays.size())}, watch);
  double planning_ms = ms_since(start);
  Radiances result = radiance(scene, directions, irradiance, plan, watch);
  result.prepare_ms += planning_ms;
  return result;
}

Radiances Engine::radiance(const Scene& scene, const std::vector<Direction>& directions,
                           bool irradiance, const Plan& plan, const Watch& watch) {
  auto start = Clock::now();
  std::vector<glm::dvec3> rays = unit_vectors(directions);
  Radiances result;
  result.plan = plan;
  result.wavelengths_nm = plan.wavelengths_nm;
  Problem problem = make_problem(scene, result.wavelengths_nm);
  std::vector<double> sunlight = make_output(scene, result.wavelengths_nm).irradiance;
  result.prepare_ms = ms_since(start);
  auto rendering = Clock::now();
  double tables_before = parts_->tables.making_ms();
  auto trace = [&](const std::vector<glm::dvec3>& towards) {
    return parts_->trace_rays(problem, {towards}, result.plan.method, result.plan.options,
                              watch);
  };
  Parts::Traced traced = trace(rays);
  result.radiance = result.relative = std::move(traced.radiance);
  result.transmittance = std::move(traced.transmittance);
  scale_by(sunlight, result.radiance);
  if (!traced.standard_error.empty()) {
    scale_by(sunlight, traced.standard_error);
    result.standard_error = std::move(traced.standard_error);
  }
  if (irradiance) {
    Physics<double> physics = pack<double>(problem);
    auto direct_irradiance = [&] {
      std::vector<LitPoint> points = lit_points(physics, sunlight.size());
      std::vector<glm::dvec3> towards;
      for (const LitPoint& point : points) towards.push_back(point.direction);
      std::vector<double> sum(sunlight.size(), 0.0);
      if (points.empty()) return sum;
      Samples transmittance = trace(towards).transmittance;
      for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t w = 0; w < sum.size(); ++w)
          sum[w] += points[i].irradiance[w] * transmittance[i][w];
      }
      return sum;
    };
    HemisphereRule sky = hemisphere_rule(problem, true),
                   below = hemisphere_rule(problem, false);
    std::size_t count = sunlight.size();
    Samples fluxes{direct_irradiance(),
                   weighted_sum(trace(sky.directions).radiance, sky.weights, count),
                   weighted_sum(trace(below.directions).radiance, below.weights, count)};
    scale_by(sunlight, fluxes);
    result.irradiance = {fluxes[0], fluxes[1], fluxes[2]};
  }
  double tables_ms = parts_->tables.making_ms() - tables_before;
  result.prepare_ms += tables_ms;
  result.render_ms = ms_since(rendering) - tables_ms;
  return result;
}

std::vector<Panels> Engine::table_panels(const Scene& scene, const Watch& watch) {
  Problem problem = make_problem(scene, some_wavelengths_of(scene));
  Method& method = parts_->method(scene.method.name);
  Tracer tracer = parts_->tracer(scene.method.name, watch);
  std::vector<Panels> all;
  for (const Parts::Batch& batch : parts_->upload(problem)) {
    std::vector<Panels> part = method.tables(tracer, batch.scene, scene.method.options);
    if (all.empty()) {
      all = std::move(part);
    } else {
      for (std::size_t i = 0; i < all.size(); ++i) append_wavelengths(part[i], all[i]);
    }
  }
  return all;
}

void Engine::forget_tables() { parts_->tables.clear(); }

std::size_t Engine::device_bytes() const { return parts_->device.allocated_bytes(); }

KernelUse Engine::kernels() const {
  const vulkan::PipelineUse use = parts_->device.pipelines();
  return {use.kept, use.made};
}

void Engine::inject(const EngineFaults& faults) {
  if (faults.lose_at_submission > 0) {
    parts_->device.lose_at_submission(faults.lose_at_submission);
  }
  if (faults.memory_bytes > 0) parts_->device.limit_memory(faults.memory_bytes);
}

TableUse Engine::tables() const { return {parts_->tables.bytes(), parts_->tables.making_ms()}; }

namespace {

Physics<double> camera_of(const Scene& scene) {
  return pack<double>(make_problem(scene, some_wavelengths_of(scene)));
}

}  // namespace

std::vector<int> sample_pixels(const Scene& scene, int count) {
  Physics<double> camera = camera_of(scene);
  return stratified_pixels(camera, count);
}

std::vector<Direction> pixel_directions(const Scene& scene, const std::vector<int>& pixels) {
  Physics<double> camera = camera_of(scene);
  std::vector<Direction> directions;
  for (int pixel : pixels) {
    glm::dvec3 ray = camera.pixel_ray(pixel).direction;
    directions.push_back({glm::degrees(std::atan2(ray.z, std::hypot(ray.x, ray.y))),
                          glm::degrees(std::atan2(ray.x, ray.y))});
  }
  return directions;
}

std::vector<Direction> sample_directions(const Scene& scene, int count) {
  return pixel_directions(scene, sample_pixels(scene, count));
}

std::vector<bool> measured_pixels(const Scene& scene) {
  Physics<double> camera = camera_of(scene);
  std::vector<bool> measured(static_cast<std::size_t>(scene.image.width) * scene.image.height);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    measured[i] = meets_air_or_ground(camera, static_cast<int>(i));
  }
  return measured;
}

void Engine::warm(const Watch& watch) {
  using nlohmann::json;
  json small{{"image", {{"width", 16}, {"height", 16}}}};
  for (const char* projection : {"perspective", "fisheye"}) {
    small["camera"]["projection"] = projection;
    render(read_scene(small), watch);
  }
  if (!parts_->profiles.empty() && parts_->profile.evaluations_per_ms.empty())
    measure_profile(watch);
}

double Engine::frame_ms(const Scene& scene, const Plan& plan, const Watch& watch) {
  forget_tables();
  const double before = tables().making_ms;
  const double ms = render(scene, plan, watch).render_ms;
  return ms + tables().making_ms - before;
}

namespace {

/// The median of some times of a frame without others in between, once it is compiled; of one
/// that is long, its one.
double median_ms(Engine& engine, const Scene& scene, const Plan& plan, const Watch& watch) {
  constexpr std::size_t repeats = 3;
  constexpr double long_ms = 500;
  engine.frame_ms(scene, plan, watch);
  std::vector<double> times;
  do {
    watch.check();
    times.push_back(engine.frame_ms(scene, plan));
  } while (times.size() < repeats && times.front() < long_ms);
  std::ranges::sort(times);
  return times[times.size() / 2];
}

/// A scene of which every pixel shows the air, or none does.
Scene profiled_scene(bool air) {
  return read_scene({{"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
                     {"camera", {{"altitude_km", air ? 0.002 : 1e5}, {"pitch_deg", 45}}},
                     {"image", {{"width", 320}, {"height", 180}}}});
}

}  // namespace

std::map<std::string, double> Engine::measure_profile(const Watch& watch) {
  Plan plan;
  plan.wavelengths_nm = {680, 550, 440};
  plan.method = "raymarch";
  for (const MethodDescription& method : methods()) {
    if (method.name == plan.method) plan.options = method.ladder.front();
  }
  const double frame_ms = median_ms(*this, profiled_scene(false), plan, watch);
  const Scene scene = profiled_scene(true);
  const Extent extent = Parts::extent_of(scene);
  DeviceProfile profile;
  profile.evaluations_per_ms[DeviceProfile::frame] =
      extent.pixels * DeviceProfile::evaluations_per_pixel / frame_ms;
  for (const MethodDescription& method : methods()) {
    if (method.ladder.empty()) continue;
    plan.method = method.name;
    plan.options = method.ladder.front();
    const double method_ms = median_ms(*this, scene, plan, watch) - frame_ms,
                 expected =
                     cyanometer::expected_ms({}, parts_->method(method.name), plan.options,
                                             make_problem(scene, plan.wavelengths_nm),
                                             {extent.rays}, plan.wavelengths_nm.size());
    profile.evaluations_per_ms[method.name] =
        expected * DeviceProfile::nominal / std::max(method_ms, 0.1 * frame_ms);
  }
  parts_->profile = profile;
  parts_->plans.clear();
  // Where nothing can be written it holds until the end of the process.
  save_profile(parts_->profiles, parts_->identity, profile);
  return profile.evaluations_per_ms;
}

std::vector<DeviceDescription> list_devices(const EngineOptions& options) {
  std::vector<DeviceDescription> devices;
  std::string chosen;
  try {
    chosen = vulkan::Device(options.device).info().id;
  } catch (const vulkan::NoDevice&) {
  }
  for (const vulkan::DeviceInfo& info : vulkan::list()) {
    devices.push_back(
        {info.name, info.driver, info.api_version, info.type, info.id == chosen, info.why});
  }
  return devices;
}

std::string atmosphere_key(const Scene& scene) {
  nlohmann::json document = canonical(scene);
  nlohmann::json& planet = document["planet"];
  // Of a ground that differs from place to place tables know the mean.
  if (auto mean = mean_albedo(scene, some_wavelengths_of(scene))) {
    planet = {{"radius_km", scene.planet.radius_km}, {"ground_albedo", *mean}};
  }
  nlohmann::json air{planet, document["atmosphere"], document["spectrum"]};
  return fingerprint(air.dump());
}

}  // namespace cyanometer
