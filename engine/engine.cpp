#include "engine/engine.h"

#include <algorithm>
#include <array>
#include <cfenv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/fingerprint.h"
#include "engine/parts.h"
#include "engine/scene/document.h"

namespace cyanometer {
namespace {

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

/// Of frames' and tiles' memory that is kept while nobody uses it: two frames of 1920 x 1080.
constexpr std::size_t idle_bytes = std::size_t{192} << 20;

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
  if (std::chrono::steady_clock::now() > deadline) throw Cancelled(Cancelled::Reason::deadline);
}

Engine::Parts::Parts(const EngineOptions& options)
    : device(make_device(options)),
      buffers(device, idle_bytes),
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

Engine::Engine(const EngineOptions& options) : parts_(std::make_unique<Parts>(options)) {
  const vulkan::DeviceInfo& info = parts_->device.info();
  parts_->description = {info.name, info.driver, info.api_version, info.type, true, info.why};
}
Engine::~Engine() = default;
Engine::Engine(Engine&&) noexcept = default;

const DeviceDescription& Engine::device() const { return parts_->description; }

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

std::size_t Engine::device_bytes() const {
  const std::size_t idle = parts_->buffers.idle_bytes(), all = parts_->device.allocated_bytes();
  return all - std::min(idle, all);  // others free memory in between
}

KernelUse Engine::kernels() const {
  const vulkan::PipelineUse use = parts_->device.pipelines();
  return {use.kept, use.made};
}

void Engine::inject(const EngineFaults& faults) {
  if (faults.lose_at_submission > 0) {
    parts_->device.lose_at_submission(faults.lose_at_submission);
  }
  if (faults.memory_bytes > 0) {
    parts_->buffers.clear();
    parts_->device.limit_memory(faults.memory_bytes);
  }
}

TableUse Engine::tables() const { return {parts_->tables.bytes(), parts_->tables.making_ms()}; }

void Engine::warm(const Watch& watch) {
  // Large enough for its pixels to be interpolated: their rays are those of a list, which all
  // projections share.
  render(read_scene({{"image", {{"width", 160}, {"height", 120}}}}), watch);
  if (!parts_->profiles.empty() && parts_->profile.evaluations_per_ms.empty())
    measure_profile(watch);
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
