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

/// What a quantity came to.
struct Measured {
  Measured(double value_) : value(value_), least(value_) {}
  Measured(double value_, double noise_) : value(value_), least(value_), noise(noise_) {}
  Measured(const EstimatedError& error)
      : value(error.measure.error), least(error.low), noise(error.high - error.measure.error) {}
  double value, least;  ///< `least` is what of it is beyond the noise of its reference
  double noise = 0;     ///< so much more of it may chance have hidden
  double stated = 0;    ///< the error that `auto` stated for what it was measured on
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

  /// Renders a frame of the scene by the plan, as a picture with all that it shows.
  /// @param width  in pixels, the height being 9/16 of it or what the projection takes
  /// @throws BrokenFrame where a pixel is not finite, and as `look` does
  void picture(const nlohmann::json& scene, int width, const Plan& plan);

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
  std::optional<Measured> error(const nlohmann::json& scene,
                                const std::vector<Direction>& directions);
  /// The largest of the channels' own errors.
  std::optional<Measured> error_by_channel(const nlohmann::json& scene,
                                           const std::vector<Direction>& directions);
  /// That of the channels' shares of their sum, which a frame's brightness does not enter.
  std::optional<Measured> error_of_hue(const nlohmann::json& scene,
                                       const std::vector<Direction>& directions);

  /// The error that `auto` stated for what was seen; 0 of a named method.
  double stated(const Radiances& seen) const;

 private:
  Scene scene_of(nlohmann::json document) const;
  Plan plan_of(const Scene& scene, std::size_t directions) const;
  struct Halves {
    std::vector<std::vector<double>> values, a, b;
    double stated = 0;
  };
  std::optional<Halves> compared(const nlohmann::json& scene,
                                 const std::vector<Direction>& directions);

  Engine& engine_;
  std::string method_;
  std::filesystem::path references_;
  double most_work_;
  const Watch& watch_;
};

}  // namespace cyanometer
