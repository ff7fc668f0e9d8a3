// A method that is asked about scenes, and what is true of them.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/accuracy/error.h"
#include "engine/engine.h"

namespace cyanometer {

/// A radiance or transmittance that is not finite, or negative, or above 1, or more light than
/// there is.
struct BrokenFrame : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Rows of directions: [elevation][azimuth].
std::vector<Direction> fan(const std::vector<double>& elevations_deg,
                           const std::vector<double>& azimuths_deg);
/// `count` values from `first` to `last`, both of them among them.
std::vector<double> spaced(double first, double last, int count);

/// The scene's own, or three where it leaves them to the planner.
std::vector<double> wavelengths_of(const Scene& scene);

class Trial {
 public:
  /// @param method  one of `methods()`, or `auto`
  /// @param references  folder in which they are kept; empty: nowhere
  /// @param most_work  random walks that a reference may take, all its rays together
  Trial(Engine& engine, std::string method, std::filesystem::path references, double most_work,
        const Watch& watch);

  const std::string& method() const { return method_; }
  bool first_order_only() const;
  /// Whether references of all orders are made by it.
  bool is_reference() const { return method_ == "path"; }
  const Watch& watch() const { return watch_; }
  double most_work() const { return most_work_; }
  Engine& engine() { return engine_; }

  /// The scene by the method; of one order where it has but one. `scattering_orders` of the
  /// document is kept where it is given.
  /// @throws BrokenFrame, SceneError, OverLimit, Cancelled
  Radiances look(const nlohmann::json& scene, const std::vector<Direction>& directions,
                 bool irradiance = false);
  /// By a plan that is given.
  Radiances look(const nlohmann::json& scene, const std::vector<Direction>& directions,
                 const Plan& plan);

  /// Renders a small frame of the scene, as a picture with all that it shows.
  /// @throws BrokenFrame where a pixel is not finite, and as `look` does
  void picture(const nlohmann::json& scene);

  /// Order one in double (adaptive.h), [direction][wavelength], the sun's irradiance being 1:
  /// radiances, or transmittances to the ground or the top.
  std::vector<std::vector<double>> first_order(const nlohmann::json& scene,
                                               const std::vector<Direction>& directions);
  std::vector<std::vector<double>> transmittance(const nlohmann::json& scene,
                                                 const std::vector<Direction>& directions);

  /// As many orders as the method has, without noise: order one in double, or the finest tables
  /// that there are.
  std::vector<std::vector<double>> smooth_truth(const nlohmann::json& scene,
                                                const std::vector<Direction>& directions);

  /// The method's error in the contract's measure, against as many orders as it has: order one
  /// in double, or random walks. None for the method that makes the reference.
  std::optional<EstimatedError> error(const nlohmann::json& scene,
                                      const std::vector<Direction>& directions);
  /// The largest of the channels' own errors.
  std::optional<EstimatedError> error_by_channel(const nlohmann::json& scene,
                                                 const std::vector<Direction>& directions);

  /// The largest error that `auto` stated in any of its looks; 0 for a named method.
  double stated() const { return stated_; }

 private:
  Scene scene_of(nlohmann::json document) const;
  Plan plan_of(const Scene& scene, std::size_t directions) const;
  struct Halves {
    std::vector<std::vector<double>> values, a, b;
  };
  std::optional<Halves> compared(const nlohmann::json& scene,
                                 const std::vector<Direction>& directions);

  Engine& engine_;
  std::string method_;
  std::filesystem::path references_;
  double most_work_;
  const Watch& watch_;
  double stated_ = 0;
};

}  // namespace cyanometer
