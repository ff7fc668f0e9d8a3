#include "engine/accuracy/attribution.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <sstream>

#include "engine/accuracy/finest.h"

namespace cyanometer {
namespace {

using Samples = std::vector<std::vector<double>>;
using Options = std::map<std::string, double>;

using Causes = std::initializer_list<ErrorSource>;

/// By how much options become larger.
struct Finer {
  double nodes = 4, tables = 2, orders = 2;
};

/// 0 stays where it leaves the choice to the method.
double refined(const MethodOption& option, double value, const Finer& times) {
  if (option.finest) return *option.finest;
  if (value == 0 && option.default_value == 0) return value;
  const double larger = option.lessens == ErrorSource::quadrature ? times.nodes
                        : option.lessens == ErrorSource::orders   ? times.orders
                                                                  : times.tables;
  return std::min(std::round(larger * value), option.maximum);
}

Options refined(const MethodDescription& method, Options options, Causes causes,
                const Finer& times) {
  for (const MethodOption& option : method.options) {
    if (std::ranges::find(causes, option.lessens) != causes.end())
      options.at(option.name) = refined(option, options.at(option.name), times);
  }
  return options;
}

/// "view_samples 16 to 64, light_samples 8 to 32".
std::string changes(const Options& from, const Options& to) {
  std::ostringstream words;
  for (const auto& [name, value] : from) {
    if (value == to.at(name)) continue;
    if (words.tellp() > 0) words << ", ";
    words << name << " " << value << " to " << to.at(name);
  }
  return words.str();
}

class Attributor {
 public:
  Attributor(Engine& engine, const Scene& scene, const ReferenceGoal& goal,
             const std::filesystem::path& references, const Watch& watch)
      : engine_(engine), scene_(scene), watch_(watch), quiet_(watch) {
    quiet_.progress = [](double) {};
    result_.plan = engine.plan(scene, quiet_);
    method_ = &*std::ranges::find(methods(), result_.plan.method, &MethodDescription::name);
    Scene given = scene;
    given.spectrum.wavelengths_nm = result_.plan.wavelengths_nm;
    colours_.emplace(scene, result_.plan.wavelengths_nm);
    const Reference reference =
        make_reference(engine, given, goal, references, part_of(watch, 0, reference_share));
    directions_ = reference.directions;
    result_.reference_noise = reference.noise;
    for (std::size_t half : {0, 1})
      truth_[half] = colours_->error_channels(reference.halves[half]);
  }

  Attribution all() {
    values_ = look(result_.plan);
    result_.error = measure_error(values_, truth_[0], truth_[1]);
    refine("quadrature", {ErrorSource::quadrature});
    refine("tables", {ErrorSource::tables});
    refine("orders", {ErrorSource::orders});
    against_the_reference();
    wavelengths();
    walks();
    return std::move(result_);
  }

 private:
  static constexpr double reference_share = 0.5, steps = 7;  // of the progress

  Samples look(const Plan& plan) {
    const RayColours colours(scene_, plan.wavelengths_nm);
    Samples seen = colours.error_channels(
        engine_.radiance(scene_, directions_, false, plan, quiet_).relative);
    looks_ += 1;
    watch_.progress(std::min(reference_share + (1 - reference_share) * looks_ / steps, 1.0));
    return seen;
  }

  Samples look(const Options& options) {
    Plan plan = result_.plan;
    plan.options = options;
    return look(plan);
  }

  void add(const std::string& cause, const ErrorMeasure& measure, const std::string& how) {
    result_.shares.push_back({cause, measure.error, how});
  }

  struct Refined {
    Options options;
    Samples values;
  };

  /// Sizes of tables are doubled where the device has room for such tables.
  Refined look_finer(Causes causes, Finer times = {}) {
    for (;; times.tables -= 0.25) {
      try {
        Options finer = refined(*method_, result_.plan.options, causes, times);
        Samples values = finer == result_.plan.options ? values_ : look(finer);
        return {std::move(finer), std::move(values)};
      } catch (const OverLimit&) {
        if (times.tables <= 1.25) throw;
      }
    }
  }

  void refine(const std::string& cause, Causes causes) {
    const Options& own = result_.plan.options;
    const Refined finer = look_finer(causes);
    if (finer.options != own)
      add(cause, measure_error(values_, finer.values), changes(own, finer.options));
  }

  void against_the_reference() {
    if (method_->random) return;  // which made it
    const bool of_order_one = method_->highest_order == 1;
    const bool one_of_many = of_order_one && scene_.method.scattering_orders.value_or(2) > 1;
    // What few nodes miss is not to be taken for the model; order one is quick.
    const Samples best =
        look_finer({ErrorSource::quadrature, ErrorSource::tables, ErrorSource::orders},
                   {.nodes = of_order_one ? 32.0 : 4.0})
            .values;
    if (!one_of_many) {
      add("model", measure_error(best, truth_[0], truth_[1]).measure,
          "refined, against random walks");
      return;
    }
    Scene first = scene_;
    first.method.scattering_orders = 1;
    const Samples order_one = look(finest_plan(first, result_.plan.wavelengths_nm));
    add("orders", measure_error(order_one, truth_[0], truth_[1]).measure,
        "order one, against random walks of all that are asked for");
    add("model", measure_error(best, order_one), "refined, against the finest of order one");
  }

  void wavelengths() {
    if (!scene_.spectrum.wavelengths_nm.empty()) return;
    const auto by = [&](const std::vector<double>& wavelengths_nm) {
      return look(finest_plan(scene_, wavelengths_nm));
    };
    const std::vector<double> many = converged_wavelengths(scene_);
    add("wavelengths", measure_error(by(result_.plan.wavelengths_nm), by(many)),
        std::to_string(result_.plan.wavelengths_nm.size()) + " to " +
            std::to_string(many.size()) + " wavelengths");
  }

  /// Two seeds differ by the noise of both.
  void walks() {
    if (!method_->random) return;
    Options other = result_.plan.options;
    other.at("seed") += 1;
    ErrorMeasure both = measure_error(values_, look(other));
    both.error /= std::numbers::sqrt2;
    add("walks", both, "another seed");
  }

  Engine& engine_;
  const Scene& scene_;
  const Watch& watch_;
  Watch quiet_;
  const MethodDescription* method_ = nullptr;
  std::optional<RayColours> colours_;
  std::vector<Direction> directions_;
  std::array<Samples, 2> truth_;  ///< [half][ray][channel]
  Samples values_;                ///< by the plan itself
  double looks_ = 0;
  Attribution result_;
};

}  // namespace

Attribution attribute(Engine& engine, const Scene& scene, const ReferenceGoal& goal,
                      const std::filesystem::path& references, const Watch& watch) {
  return Attributor(engine, scene, goal, references, watch).all();
}

}  // namespace cyanometer
