#include "engine/planner/planner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <memory>
#include <optional>
#include <sstream>

#include "engine/accuracy/error.h"
#include "engine/methods/limits.h"
#include "engine/optics/colour.h"

namespace cyanometer {
namespace {

using Samples = std::vector<std::vector<double>>;

constexpr std::array<int, 7> wavelength_ladder{4, 6, 8, 12, 16, 24, 32};

/// What is measured on some hundreds of rays holds for the frame in 95 % of frames with this
/// factor; of a small frame a row at the horizon, which may be nearer to it than any of them,
/// is a larger share.
constexpr double frame_over_sample = 1.5, small_frame_over_sample = 1.8;
constexpr double small_frame = 1 << 14;  // pixels

double over_sample(const Extent& extent) {
  return extent.pixels < small_frame ? small_frame_over_sample : frame_over_sample;
}

/// Of the error of colour from few wavelengths, that of all orders and pixels over that of
/// single scattering on these rays.
constexpr double frame_over_single_scattering = 1.2;

/// What is left of the finest setting's error, over what its last step changed.
constexpr double over_last_step = 1.3;

/// The error of frames from interpolation alone, over how far a pixel may be off: a third on
/// all presets.
constexpr double frame_over_tolerance = 0.5;

/// Of all settings of the moments alike, by random walks on random planets (`audit`); over what
/// leaving out their part, light that was scattered more than once, would be.
constexpr double common_error = 0.006;
/// The same of rays that end after some metres or kilometres, where nearly all of their light
/// was scattered more than once: what is scattered about the camera alone is 4 % off in haze at
/// dusk, where whole rays are 1.5 % (tests/composite).
constexpr double common_error_of_parts = 0.05;

/// Of all methods that take the ground for one of the albedo that it has nearby, under an even
/// sky and air that heights do not shade, where it differs from place to place: by random walks
/// over a world of seas 4 to 15 %, most where coasts and the sky in the sea are looked at.
constexpr double common_error_of_ground = 0.12, common_error_of_heights = 0.15;

/// Walks that take longer, ms, are none that `auto` takes unless that much time is given: the
/// first before pictures and over a ground that differs from place to place, where every other
/// method may miss what is asked.
constexpr double longest_walks = 60000, longest_usual_walks = 10000;

/// Within a time that is asked for lies what is expected to take this much less: in 95 % of
/// random scenes it takes no longer than that (`audit`).
constexpr double time_to_spare = 1.3;

/// What a frame aims at where nothing else is asked.
constexpr double usual_error = 0.02;

/// Single scattering that is good enough to tell how many wavelengths colour needs.
const MethodOptions coarse_march{{"view_nodes", 3}};

struct Choice {
  const Method* method = nullptr;
  MethodOptions options;
  double ms = 0;
  double error = 1;  ///< bound, wavelengths aside

  const std::string& name() const { return method->description().name; }
};

struct Wavelengths {
  std::vector<double> nm;
  double error = 0;  ///< of colour, from using these and not more
};

bool single_scattering(const Scene& scene) {
  const auto& orders = scene.method.scattering_orders;
  return orders && *orders <= 1;
}

/// At most four, which every method computes at once.
std::vector<double> few_wavelengths(const Scene& scene) {
  constexpr std::size_t most = 4;
  const std::vector<double>& all = scene.spectrum.wavelengths_nm;
  if (all.empty()) return colour_wavelengths(most);
  if (all.size() <= most) return all;
  std::vector<double> few;
  for (std::size_t i = 0; i < most; ++i) few.push_back(all[i * (all.size() - 1) / (most - 1)]);
  return few;
}

/// Two estimates that have nothing in common, each of so many walks a ray.
std::array<Samples, 2> walk_twice(const TraceProbe& probe, MethodOptions options,
                                  const std::vector<double>& wavelengths_nm, double walks,
                                  double seed) {
  options.at("samples_per_pixel") = walks;
  std::array<Samples, 2> halves;
  for (Samples& half : halves) {
    options.at("seed") = seed++;
    half = probe("path", options, wavelengths_nm);
  }
  return halves;
}

/// Where all settings of the moments may be wrong alike by more than `common_error`: peaks that
/// none resolves, haze under a low sun, and air in which light is lost from order to order.
bool moments_may_fail(const SceneTraits& scene) {
  return scene.depth > 2 || scene.haze > 0.3 || (scene.asymmetry > 0.85 && scene.haze > 0.1);
}

/// Says how wrong what some rays show may be.
class Judge {
 public:
  virtual ~Judge() = default;
  virtual double bound(const Samples& samples) const = 0;
};

/// By the best solution that takes no longer than a frame, its own error told from the setting
/// before.
class QuickJudge final : public Judge {
 public:
  /// @param rung  of the method's ladder, at least 1
  QuickJudge(const Method& method, std::size_t rung, const PlanInputs& inputs,
             const std::vector<double>& wavelengths_nm)
      : over_sample_(over_sample(inputs.extent)) {
    const TraceProbe& probe = inputs.probe;
    const MethodDescription& description = method.description();
    best_ = probe(description.name, description.ladder[rung], wavelengths_nm);
    Samples coarser = probe(description.name, description.ladder[rung - 1], wavelengths_nm);
    // In haze errors fall by half from one setting to the next, and are a little more than what
    // the last step changes; what all settings have in common does not show there.
    best_error_ = over_last_step * measure_error(coarser, best_).error;
    if (description.highest_order == 1) return;
    Samples once = probe("raymarch", coarse_march, wavelengths_nm);
    double further = measure_error(once, best_).error;
    double common =
        inputs.parts ? std::max(common_error, common_error_of_parts * further) : common_error;
    best_error_ = std::hypot(best_error_, common * further);
  }

  /// Takes into account what random walks say of the best solution itself: no less than they
  /// leave room for.
  /// @returns whether they were enough to tell a third of what is asked
  bool check(const std::array<Samples, 2>& walks, double asked) {
    walked_error_ = measure_error(best_, walks[0], walks[1]).high;
    return walked_error_ <= std::max(best_error_, asked / 3);
  }

  double bound(const Samples& samples) const override {
    const double from_best = over_sample_ * measure_error(samples, best_).error;
    return std::hypot(from_best, best_error_, walked_error_);
  }

 private:
  double over_sample_;
  Samples best_;
  double best_error_ = 0, walked_error_ = 0;
};

/// By random walks, as many as it takes to see a third of what is asked, within some seconds.
class WalkJudge final : public Judge {
 public:
  WalkJudge(const MethodOptions& options, const TraceProbe& probe,
            const std::vector<double>& wavelengths_nm, double asked) {
    constexpr double first_walks = 64, most_walks = 8192;
    // Far from the seeds that a frame of the method itself may have.
    double seed = 1 << 30;
    for (double walks = first_walks; walks <= most_walks; walks *= 2, seed += 2) {
      halves_ = walk_twice(probe, options, wavelengths_nm, walks, seed);
      if (measure_error(halves_[0], halves_[1]).error / 2 <= asked / 3) break;
    }
  }

  double bound(const Samples& samples) const override {
    return measure_error(samples, halves_[0], halves_[1]).high;
  }

 private:
  std::array<Samples, 2> halves_;
};

class Planner {
 public:
  explicit Planner(const PlanInputs& inputs)
      : in_(inputs),
        few_(few_wavelengths(in_.scene)),
        problem_(make_problem(in_.scene, few_)),
        judge_(make_judge()) {}

  Choice as_asked(const Wavelengths& wavelengths) const {
    const MethodChoice& asked = in_.scene.method;
    return judged(choice(method(asked.name), asked.options, wavelengths));
  }

  /// The cheapest within the error and the time; otherwise the best that there is time for.
  Choice cheapest(const Wavelengths& wavelengths) const {
    const MethodChoice& asked = in_.scene.method;
    std::optional<Choice> best;
    const double longest = in_.parts || problem_.ground ? longest_walks : longest_usual_walks;
    bool but_for_ground = false;  // one meets what is asked, but for what none makes less
    for (const Choice& each : candidates(wavelengths)) {
      const bool random = each.method->description().random;
      if (best && asked.max_ms && is_late(each)) break;
      if (best && random && !asked.max_ms && each.ms > longest) continue;
      if (but_for_ground && !random) continue;
      Choice measured = judged_or_left(each);
      if (asked.max_error && stated(measured, wavelengths) <= *asked.max_error) return measured;
      // Walks that miss what was asked are long and no better to look at, but for those that
      // there is time for.
      const bool eligible = !best || !random || asked.max_ms;
      if (eligible && (!best || stated(measured, wavelengths) < stated(*best, wavelengths)))
        best = measured;
      but_for_ground |= asked.max_error && !random &&
                        std::hypot(measured.error, wavelengths.error) <= *asked.max_error;
    }
    return *best;
  }

  bool is_late(const Choice& choice) const {
    const auto& given = in_.scene.method.max_ms;
    return given && choice.ms * time_to_spare > *given;
  }

  /// What the plan of a choice says of its error.
  double stated(const Choice& choice, const Wavelengths& wavelengths) const {
    return std::min(1.0, std::hypot(choice.error, wavelengths.error) + error_on_ground(choice));
  }

  /// What no setting of the choice's method makes less: no reason to prefer another setting.
  double error_on_ground(const Choice& choice) const {
    if (in_.scene.method.verify || choice.method->description().random) return 0;
    if (single_scattering(in_.scene) || !problem_.ground) return 0;
    return has_heights(problem_) ? common_error_of_heights : common_error_of_ground;
  }

 private:
  const Method& method(const std::string& name) const {
    for (const auto& each : in_.methods) {
      if (each->description().name == name) return *each;
    }
    throw std::logic_error("no method is called " + name);
  }

  std::unique_ptr<Judge> make_judge() const {
    const SceneTraits traits = traits_of(problem_);
    // What all methods of tables do alike, the tables of `moments` can't tell: all further
    // light comes from the middle of a large sun.
    const bool walk = in_.scene.method.verify || traits.sun_diameter_deg > 1;
    if (walk && !single_scattering(in_.scene)) {
      return std::make_unique<WalkJudge>(method("path").description().ladder.front(), in_.probe,
                                         few_,
                                         in_.scene.method.max_error.value_or(usual_error));
    }
    const Method& best = method(single_scattering(in_.scene) ? "raymarch" : "moments");
    auto judge = quick_judge(best);
    if (!single_scattering(in_.scene) && moments_may_fail(traits))
      check_by_walks(*judge, traits.depth);
    return judge;
  }

  void check_by_walks(QuickJudge& judge, double depth) const {
    // Of all rays together, from some tenths of a second to some seconds: light leaves thick
    // air after about as many steps as the square of its depth.
    constexpr double fewest = 1 << 15;
    const double most = (1 << 18) / std::max(depth * depth / 4, 1.0);
    double seed = 1 << 30;
    for (double walks = fewest; walks <= std::max(most, fewest); walks *= 2, seed += 2) {
      double each = std::exp2(std::ceil(std::log2(walks / std::min(in_.extent.rays, 512.0))));
      if (judge.check(walk_twice(in_.probe, method("path").description().ladder.front(), few_,
                                 each, seed),
                      in_.scene.method.max_error.value_or(usual_error)))
        return;
    }
  }

  /// By the finest setting that is quick and within the device's limits in this scene.
  /// @throws OverLimit where none of its ladder is, but perhaps the first
  std::unique_ptr<QuickJudge> quick_judge(const Method& best) const {
    for (std::size_t rung = affordable_rung(best);; --rung) {
      try {
        return std::make_unique<QuickJudge>(best, rung, in_, few_);
      } catch (const OverLimit&) {
        if (rung == 1) throw;
      }
    }
  }

  /// The finest setting with which a judgement stays quick; of the first two, where none does.
  std::size_t affordable_rung(const Method& judge) const {
    constexpr double longest_ms = 1500;
    std::size_t rung = judge.description().ladder.size() - 1;
    auto ms = [&] {
      return expected_ms(in_.profile, judge, judge.description().ladder[rung], problem_, {512},
                         few_.size());
    };
    while (rung > 1 && ms() > longest_ms) --rung;
    return rung;
  }

  Choice choice(const Method& method, const MethodOptions& options,
                const Wavelengths& wavelengths) const {
    return {
        &method, options,
        expected_ms(in_.profile, method, options, problem_, in_.extent, wavelengths.nm.size()),
        1};
  }

  /// Cheapest first.
  std::vector<Choice> candidates(const Wavelengths& wavelengths) const {
    std::vector<Choice> all;
    for (const auto& each : in_.methods) {
      for (const MethodOptions& options : each->description().ladder) {
        all.push_back(choice(*each, options, wavelengths));
      }
    }
    std::ranges::stable_sort(all, {}, &Choice::ms);
    return all;
  }

  Samples probe(const Method& method, const MethodOptions& options) const {
    return in_.probe(method.description().name, options, few_);
  }

  /// With its error; a setting that is over a limit of the device in this scene is none to
  /// take.
  Choice judged_or_left(const Choice& given) const {
    try {
      return judged(given);
    } catch (const OverLimit&) {
      return given;
    }
  }

  /// With its error.
  Choice judged(Choice given) const {
    const MethodChoice& asked = in_.scene.method;
    given.error = given.method->description().random ? noise_of(given) : measured(given);
    // What is to be verified is told of many walks by looking at them.
    if (given.method->description().random && asked.verify &&
        given.error <= asked.max_error.value_or(1))
      given.error = measured(given);
    given.error = std::min(1.0, given.error);
    return given;
  }

  /// What is measured on rays, and what pixels between rays are off in a frame.
  double measured(const Choice& given) const {
    const double of_rays = judge_->bound(probe(*given.method, given.options));
    return in_.extent.is_sparse(given.options)
               ? std::hypot(of_rays, frame_over_tolerance * given.options.at("interpolation"))
               : of_rays;
  }

  /// Noise falls with the root of the number of walks, so that of a few, looked at once, tells
  /// of many.
  double noise_of(const Choice& given) const {
    constexpr double few_walks = 16;
    if (!few_walks_noise_) {
      MethodOptions options = given.options;
      options.at("samples_per_pixel") = few_walks;
      few_walks_noise_ = judge_->bound(probe(*given.method, options));
    }
    return *few_walks_noise_ * std::sqrt(few_walks / given.options.at("samples_per_pixel"));
  }

  const PlanInputs& in_;
  std::vector<double> few_;
  Problem problem_;
  std::unique_ptr<Judge> judge_;
  mutable std::optional<double> few_walks_noise_;
};

/// Ever more, until they are as many as colour needs, told from single scattering.
std::vector<Wavelengths> choose_wavelengths(const PlanInputs& inputs, double tolerance) {
  if (!inputs.scene.spectrum.wavelengths_nm.empty()) {
    return {{inputs.scene.spectrum.wavelengths_nm, 0}};
  }
  auto trace = [&](int count) {
    return inputs.probe("raymarch", coarse_march, colour_wavelengths(count));
  };
  Samples reference = trace(64);
  std::vector<Wavelengths> chosen;
  for (int count : wavelength_ladder) {
    const double error = measure_error(trace(count), reference).error;
    chosen.push_back({colour_wavelengths(count), frame_over_single_scattering * error});
    if (error <= tolerance) break;
  }
  return chosen;
}

std::string percent(double share) {
  std::ostringstream text;
  text << std::setprecision(2) << 100 * share << " %";
  return text.str();
}

std::string in_words(const MethodOptions& options) {
  std::ostringstream text;
  for (const auto& [name, value] : options) {
    text << (text.tellp() > 0 ? ", " : "") << name << " " << value;
  }
  return text.str();
}

std::string explain(const PlanInputs& inputs, const Plan& plan, const Choice& choice,
                    double spectral, double on_ground) {
  std::ostringstream text;
  bool automatic = inputs.scene.method.name == "auto";
  text << (automatic ? "auto chose " : "As asked: ") << plan.method << " ("
       << in_words(plan.options) << ") at " << plan.wavelengths_nm.size()
       << " wavelengths. Its error is at most " << percent(plan.expected_error) << ": "
       << percent(choice.error) << " of the method";
  if (spectral > 0) text << ", " << percent(spectral) << " of the number of wavelengths";
  if (on_ground > 0) {
    text << ", " << percent(on_ground) << " of what it takes the varied ground for";
  }
  text << ".";
  if (choice.method->description().highest_order == 1 && !single_scattering(inputs.scene)) {
    text << " It leaves out multiple scattering.";
  }
  if (!plan.met) {
    text << " That misses what was asked; nothing better is there"
         << (inputs.scene.method.max_ms ? "." : ", but for longer walks.");
  }
  return text.str();
}

}  // namespace

bool Extent::is_sparse(const MethodOptions& options) const {
  const auto interpolated = options.find("interpolation");
  return sparse_rays > 0 && interpolated != options.end() && interpolated->second > 0;
}

double Extent::traced(const MethodOptions& options) const {
  if (!is_sparse(options)) return rays;
  // What is off falls with the square of the distance between rays.
  return std::min(rays, sparse_rays * std::sqrt(tolerance / options.at("interpolation")));
}

double expected_ms(const DeviceProfile& profile, const Method& method,
                   const MethodOptions& options, const Problem& problem, Extent extent,
                   std::size_t wavelengths) {
  // Columns are the same at every wavelength; the rest is done for four of them at a time.
  const double groups = std::ceil(static_cast<double>(wavelengths) / 4),
               traced = extent.traced(options),
               of_method = method.evaluations(problem, options, traced) * (1 + groups) / 2,
               of_frame = extent.is_sparse(options)
                              ? DeviceProfile::evaluations_of_lattice +
                                    extent.pixels * DeviceProfile::evaluations_between +
                                    traced * DeviceProfile::evaluations_per_pixel
                              : extent.pixels * DeviceProfile::evaluations_per_pixel;
  return of_method / profile.pace(method.description().name) +
         of_frame / profile.pace(DeviceProfile::frame);
}

Plan make_plan(const PlanInputs& inputs) {
  const MethodChoice& asked = inputs.scene.method;
  const bool automatic = asked.name == "auto";
  const double tolerance = automatic ? asked.max_error.value_or(usual_error) : usual_error;
  std::vector<Wavelengths> wavelengths = choose_wavelengths(inputs, tolerance / 2);
  const Planner planner(inputs);
  const auto choose = [&] {
    return automatic ? planner.cheapest(wavelengths.back())
                     : planner.as_asked(wavelengths.back());
  };
  Choice choice = choose();
  // Where only time is asked, colour too is worth no more than there is.
  while (automatic && !asked.max_error && planner.is_late(choice) && wavelengths.size() > 1) {
    wavelengths.pop_back();
    choice = choose();
  }
  Plan plan;
  plan.wavelengths_nm = wavelengths.back().nm;
  plan.method = choice.name();
  plan.options = choice.options;
  plan.expected_ms = choice.ms;
  plan.expected_error = planner.stated(choice, wavelengths.back());
  plan.met = !automatic || ((!asked.max_error || plan.expected_error <= *asked.max_error) &&
                            !planner.is_late(choice));
  plan.why =
      explain(inputs, plan, choice, wavelengths.back().error, planner.error_on_ground(choice));
  return plan;
}

}  // namespace cyanometer
