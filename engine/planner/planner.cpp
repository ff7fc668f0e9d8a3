#include "engine/planner/planner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <numbers>
#include <sstream>

#include "engine/accuracy/error.h"
#include "engine/optics/colour.h"
#include "engine/optics/profile.h"

namespace cyanometer {
namespace {

/// Samples of the view and the light ray. Light rays need theirs as much: at 16 a haze of 1.2
/// km is lost between two samples of a low sun's ray.
struct Samples {
  int view, light;
};
constexpr std::array<Samples, 8> sample_ladder{
    {{8, 8}, {16, 16}, {32, 16}, {32, 32}, {64, 32}, {64, 64}, {128, 64}, {256, 64}}};
constexpr std::array<int, 7> wavelength_ladder{4, 6, 8, 12, 16, 24, 32};

/// Evaluations of the optical depth a millisecond on two cores of a software device; the plan
/// may not depend on what is measured while it runs, or equal requests would have unequal
/// answers.
constexpr double nominal_evaluations_per_ms = 2.5e6;

MethodOptions options_of(Samples samples) {
  return {{"view_samples", samples.view}, {"light_samples", samples.light}};
}

Samples samples_of(const MethodOptions& options) {
  return {static_cast<int>(options.at("view_samples")),
          static_cast<int>(options.at("light_samples"))};
}

double milliseconds(const PlanInputs& inputs, Samples samples) {
  double evaluations = inputs.rays * samples.view * (samples.light * inputs.suns + 1) *
                       std::max(inputs.media, 1);
  return evaluations / nominal_evaluations_per_ms;
}

/// By step halving. The error of the midpoint rule is 4/3 of its difference from half the
/// steps, 1/3 of that from twice the steps, and up to twice and once where the planet's shadow
/// makes it converge slowly; the latter are stated. Costly marches are judged by the cheaper
/// side.
double quadrature_bound(const PlanInputs& inputs, Samples samples,
                        const std::vector<double>& wavelengths) {
  constexpr int most_samples_to_double = 1 << 14;
  auto trace = [&](Samples s) { return inputs.probe("nishita", options_of(s), wavelengths); };
  bool refine = samples.view * samples.light <= most_samples_to_double ||
                std::min(samples.view, samples.light) < 2;
  Samples other = refine ? Samples{2 * samples.view, 2 * samples.light}
                         : Samples{samples.view / 2, samples.light / 2};
  ErrorMeasure change = measure_error(trace(samples), trace(other));
  return (refine ? 2 : 1) * change.error;
}

double spectral_error(const PlanInputs& inputs, int count,
                      const std::vector<std::vector<double>>& reference) {
  auto values = inputs.probe("nishita", options_of({32, 8}), colour_wavelengths(count));
  return measure_error(values, reference).error;
}

struct Wavelengths {
  std::vector<double> nm;
  double error = 0;  ///< of colour, from using these and not more
};

Wavelengths choose_wavelengths(const PlanInputs& inputs, double tolerance) {
  if (!inputs.scene.spectrum.wavelengths_nm.empty()) {
    return {inputs.scene.spectrum.wavelengths_nm, 0};
  }
  auto reference = inputs.probe("nishita", options_of({32, 8}), colour_wavelengths(64));
  double error = 0;
  for (int count : wavelength_ladder) {
    error = spectral_error(inputs, count, reference);
    if (error <= tolerance || count == wavelength_ladder.back()) {
      return {colour_wavelengths(count), error};
    }
  }
  return {};
}

bool within_time(const PlanInputs& inputs, Samples samples) {
  const auto& most = inputs.scene.method.max_ms;
  return !most || milliseconds(inputs, samples) <= *most;
}

struct Choice {
  Samples samples;
  double quadrature_error;
};

/// The cheapest step of the ladder within the tolerance, or the last one that there is time
/// for.
Choice choose_samples(const PlanInputs& inputs, const std::vector<double>& wavelengths,
                      double tolerance) {
  Choice best{sample_ladder.front(),
              quadrature_bound(inputs, sample_ladder.front(), wavelengths)};
  for (std::size_t i = 1; i < sample_ladder.size() && best.quadrature_error > tolerance; ++i) {
    if (!within_time(inputs, sample_ladder[i])) break;
    best = {sample_ladder[i], quadrature_bound(inputs, sample_ladder[i], wavelengths)};
  }
  return best;
}

std::string percent(double share) {
  std::ostringstream text;
  text << std::setprecision(2) << 100 * share << " %";
  return text.str();
}

std::string explain(const PlanInputs& inputs, const Plan& plan, double quadrature,
                    double spectral, double missing) {
  std::ostringstream text;
  Samples samples = samples_of(plan.options);
  bool automatic = inputs.scene.method.name == "auto";
  text << (automatic ? "auto chose " : "As asked: ") << plan.method << " with " << samples.view
       << " view and " << samples.light << " light samples at " << plan.wavelengths_nm.size()
       << " wavelengths. Its error is at most " << percent(plan.expected_error) << ": "
       << percent(quadrature) << " from quadrature";
  if (spectral > 0) text << ", " << percent(spectral) << " from the number of wavelengths";
  if (missing > 0) {
    text << ", the rest from multiple scattering, which " << plan.method << " leaves out";
  }
  text << ".";
  if (!plan.met) text << " That misses what was asked; nothing better is there.";
  return text.str();
}

}  // namespace

double multiple_scattering_bound(const Scene& scene) {
  const auto& orders = scene.method.scattering_orders;
  if (orders && *orders <= 1) return 0;
  std::vector<double> wavelengths = scene.spectrum.wavelengths_nm;
  if (wavelengths.empty()) wavelengths = colour_wavelengths(8);
  Problem problem = make_problem(scene, wavelengths);
  double squares = 0;
  for (std::size_t w = 0; w < wavelengths.size(); ++w) {
    double depth = 0;
    for (const Medium& medium : problem.media) {
      depth += medium.scattering_per_km[w] * column_km(medium.profile, problem.thickness_km);
    }
    // Each order is at most the share q of the one before that does not escape: half of what an
    // optically thin layer scatters meets twice its depth on the way, and light from a bright
    // ground scatters as sunlight does.
    double q = depth > 0 ? 1 - std::exp(-2 * depth - 2 * problem.ground_albedo[w]) : 0;
    squares += q * q;
  }
  double share = std::sqrt(squares / static_cast<double>(wavelengths.size()));
  // In twilight the air that the sun still reaches directly is far away and thin.
  if (share > 0 && scene.sun.elevation_deg < 5) share = std::max(share, 0.7);
  if (share > 0 && scene.sun.elevation_deg < 0) share = 1;
  return share;
}

Plan make_plan(const PlanInputs& inputs) {
  const MethodChoice& asked = inputs.scene.method;
  bool automatic = asked.name == "auto";
  double missing = multiple_scattering_bound(inputs.scene);
  // Beside what the method leaves out, a tenth of it more would not be noticed.
  double asked_for = automatic ? asked.max_error.value_or(0.003) : 0.02;
  double tolerance = std::max(asked_for, missing / 5);
  Plan plan;
  plan.method = automatic ? "nishita" : asked.name;
  Wavelengths wavelengths = choose_wavelengths(inputs, asked_for / 4);
  plan.wavelengths_nm = wavelengths.nm;
  if (!automatic && asked.name != "nishita") {
    plan.options = asked.options;
    plan.why = "As asked.";
    return plan;
  }
  Choice choice{};
  if (automatic) {
    choice = choose_samples(inputs, plan.wavelengths_nm, tolerance / 2);
    plan.options = options_of(choice.samples);
  } else {
    plan.options = asked.options;
    choice.samples = samples_of(asked.options);
    choice.quadrature_error = quadrature_bound(inputs, choice.samples, plan.wavelengths_nm);
  }
  plan.expected_error =
      std::min(1.0, std::hypot(choice.quadrature_error + wavelengths.error, missing));
  plan.expected_ms = milliseconds(inputs, choice.samples);
  bool error_met = !automatic || !asked.max_error || plan.expected_error <= *asked.max_error;
  plan.met = error_met && (!automatic || within_time(inputs, choice.samples));
  plan.why = explain(inputs, plan, choice.quadrature_error, wavelengths.error, missing);
  return plan;
}

}  // namespace cyanometer
