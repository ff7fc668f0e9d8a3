// The interface behind which every method stands: told by data what it is and can be told, it
// traces rays through one uploaded scene. A new method is a folder beside this file and a line
// in methods.cpp.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/engine.h"
#include "engine/image/panels.h"
#include "engine/methods/pacer.h"
#include "engine/methods/table_cache.h"
#include "engine/methods/uploaded_scene.h"
#include "engine/problem.h"
#include "engine/vulkan/commands.h"

namespace cyanometer {

using MethodOptions = std::map<std::string, double>;

/// What a method leaves of each ray of a tile: inscattered radiance, ground radiance (as seen,
/// both per unit irradiance, 1/sr; where the ground is not the same everywhere, the sky's
/// irradiance on it, of which surface/surface_pass.h makes radiance), transmittance to ground
/// or space, and where the method is random the standard error of the two radiances' sum, in
/// this order, each as groups of four wavelengths, each of those a plane of `rays` vec4
/// (shaders/device.glsl).
struct Tile {
  static std::size_t bytes(const MethodDescription& method, int groups, int rays) {
    int quantities = method.random ? 4 : 3;
    return std::size_t{16} * quantities * groups * rays;
  }
  int first_ray = 0;
  int rays = 0;
  const vulkan::Buffer& values;
};

/// What all methods work with.
struct Tracer {
  vulkan::Device& device;
  vulkan::Commands& commands;
  Pacer& pacer;
  TablesInUse tables;
  const Watch& watch;
  double device_ms = 0;

  /// Submits what was recorded, keeps its time, and looks whether anybody still waits.
  /// @returns its time on the device, ms
  double submit();
};

class Method {
 public:
  virtual ~Method() = default;
  virtual const MethodDescription& description() const = 0;
  /// What so many rays cost, tables included, in evaluations as the pacer counts them; roughly,
  /// for plans.
  virtual double evaluations(const Problem& problem, const MethodOptions& options,
                             double rays) const = 0;
  /// Rays that are traced together, given the scene and the pace of the device.
  virtual int rays_at_once(const UploadedScene& scene, const MethodOptions& options,
                           const Pacer& pacer) const = 0;
  /// Leaves all quantities of the tile complete, with as many orders of scattering as the
  /// scene's problem asks for or, where the method knows fewer, those. Tables come from the
  /// tracer's cache. No dispatch is longer than the pacer allows.
  virtual void trace(Tracer& tracer, const UploadedScene& scene, const MethodOptions& options,
                     const Tile& tile) = 0;
  /// Whether it leaves the ground of a problem whose ground is not the same everywhere as the
  /// camera sees it, but for the sun's own light, and not its irradiance.
  virtual bool reflects() const { return false; }
  /// The tables that a frame of the scene is made from, to be looked at; none where the method
  /// has none or shows none.
  virtual std::vector<Panels> tables(Tracer& tracer, const UploadedScene& scene,
                                     const MethodOptions& options);
};

/// With what every method can be told that has no noise, and so values between its rays.
MethodDescription interpolated(MethodDescription description);

/// The methods, made for a device; in the order of `methods()`.
std::vector<std::unique_ptr<Method>> make_methods(vulkan::Device& device);

}  // namespace cyanometer
