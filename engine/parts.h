// What of the engine lives as long as the device, and what its members have in common.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "engine/display/compositor.h"
#include "engine/engine.h"
#include "engine/methods/method.h"
#include "engine/planner/planner.h"
#include "engine/planner/profile.h"
#include "engine/problem.h"
#include "engine/rays.h"
#include "engine/surface/surface_pass.h"

namespace cyanometer {

using Samples = std::vector<std::vector<double>>;  ///< [ray][wavelength or channel]

/// A frame in the making.
struct FrameWork {
  const Scene& scene;
  const Problem& problem;
  const Output& output;
  const Plan& plan;
  const std::vector<PlaneGroup>& groups;
  const Picture* picture;  ///< a client's, null without one
  Frame& frame;
  FrameStore& store;
};

struct Engine::Parts {
  using Clock = std::chrono::steady_clock;

  explicit Parts(const EngineOptions& options);

  vulkan::Device device;
  vulkan::BufferPool buffers;  ///< of frames and tiles
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

  // ---- Rays, by a method (tracing.cpp)

  /// All wavelengths; the rays are those given, or the camera's where no directions are.
  /// @param most  wavelengths of a batch
  std::vector<Batch> upload(const Problem& problem, const Rays& rays = {},
                            std::size_t most = wavelengths_at_once, GroundBuffers ground = {});
  GroundBuffers ground_before(const Problem& problem, const Rays& rays, const Watch& watch);
  /// What of a client's picture stands before the ground's heights, and these, black.
  Picture before_heights(const Problem& problem, Picture picture, const Watch& watch);
  /// The same for a method, where the ground may differ from place to place. Heights end rays
  /// as objects do.
  std::vector<Batch> upload_with_ground(const Problem& problem, Rays rays,
                                        const std::string& name, const Watch& watch);
  /// Calls `visit(batch, tile)` for every batch and tile once it is traced: all tiles of a
  /// batch one after the other, whose tables are held meanwhile.
  void trace_tiles(Tracer& tracer, const std::string& name, const MethodOptions& options,
                   const std::vector<Batch>& batches, int rays,
                   const std::function<void(std::size_t, const Tile&)>& visit);
  static SurfacePass::Left left_by(const Method& method, const Problem& problem);
  Traced trace_rays(const Problem& problem, const Rays& rays, const std::string& method_name,
                    const MethodOptions& options, const Watch& watch);

  // ---- Plans (planning.cpp)

  /// @param probes  some of the rays
  Plan plan(const Scene& scene, const Rays& probes, Extent extent, const Watch& watch);
  /// Of frames that are nearly alike one is planned for all, unless this very one is to be
  /// verified.
  Plan plan_frame(const Scene& scene, const Watch& watch);
  /// The plan of one picture holds for no other.
  Plan plan_composite(const Scene& scene, const Picture& picture, const Watch& watch);
  Plan plan_this_frame(const Scene& scene, const Watch& watch);
  Plan known_plan(const std::string& key, const std::function<Plan()>& make);
  /// The share of pixels that meet something is told from some of them; how many rays it takes
  /// where values are interpolated from a small picture of order one.
  Extent extent_of(const Scene& scene, const Watch& watch);

  // ---- Frames (frames.cpp)

  /// All pixels by themselves.
  void make_pixel_by_pixel(const FrameWork& work, const Watch& watch);
  void trace_frame(const FrameWork& work, const Watch& watch);
  void overlay(const FrameWork& work, const Watch& watch);
  /// @param areas  as automatic_exposure_ev has them
  static double exposure_of(const FrameWork& work, std::span<const float> luminance,
                            std::span<const float> areas = {});
  /// Whether the plan interpolates, and the frame is one of which that can be done.
  static bool is_sparse(const FrameWork& work);
  /// As many pixels as it takes, and the others between them (sparse_frame.cpp).
  void make_sparsely(const FrameWork& work, const Watch& watch);
  /// As planner/planner.h has it (Extent); 0 of a frame that is not made so.
  double sparse_rays_of(const Scene& scene, const Watch& watch);
  class SparseFrame;
};

/// Rays on which a plan's errors are measured.
inline constexpr int plan_probes = 512;

inline double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

}  // namespace cyanometer
