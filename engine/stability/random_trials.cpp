#include "engine/stability/random_trials.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "engine/accuracy/random_scene.h"
#include "engine/scene/document.h"
#include "engine/stability/any_scene.h"
#include "engine/stability/row.h"

namespace cyanometer {
namespace {

using nlohmann::json;
using Samples = std::vector<std::vector<double>>;
using Options = std::map<std::string, double>;

/// Tables as small as still have something to interpolate. Orders are as many as the air asks,
/// for where a few are all that a geometric series goes by, it makes much of their last digits.
const Options& smallest_options(const std::string& method) {
  static const std::map<std::string, Options> options{
      {"nishita", {{"view_samples", 16}, {"light_samples", 8}}},
      {"raymarch", {}},
      {"hillaire",
       {{"multiple_altitudes", 8},
        {"multiple_suns", 16},
        {"multiple_directions", 16},
        {"multiple_samples", 8},
        {"sky_azimuths", 8},
        {"sky_elevations", 16},
        {"view_samples", 8},
        {"transmittance_cosines", 64},
        {"transmittance_altitudes", 16}}},
      {"bruneton",
       {{"orders", 2},
        {"altitudes", 4},
        {"zeniths", 5},
        {"suns", 8},
        {"azimuths", 3},
        {"source_zeniths", 4},
        {"source_azimuths", 3},
        {"refinement", 1},
        {"samples", 4},
        {"view_samples", 8}}},
      {"moments",
       {{"degree", 2},
        {"altitudes", 6},
        {"suns", 12},
        {"directions", 6},
        {"azimuths", 4},
        {"steps", 6},
        {"orders", 0},
        {"sky_steps", 6},
        {"sky_elevations", 12},
        {"sky_azimuths", 6}}},
      {"path", {{"samples_per_pixel", 8}}}};
  return options.at(method);
}

bool is_wanted(const std::string& method, const RandomTrialSettings& settings) {
  const auto& only = settings.methods;
  return only.empty() || std::ranges::find(only, method) != only.end();
}

/// One form of scenes in four is whatever a document can say; the others are air and haze in
/// which every method has something to show, and are quick.
bool says_anything(std::uint64_t seed) { return seed / scenes_of_a_form % 4 == 3; }

json scene_of(std::uint64_t seed) {
  return says_anything(seed) ? any_scene(seed) : random_scene(seed);
}

std::string name_of(TrialOptions options) {
  switch (options) {
    case TrialOptions::smallest:
      return "smallest";
    case TrialOptions::usual:
      return "usual";
    case TrialOptions::ladder:
      return "ladder";
  }
  return {};
}

Options options_of(const MethodDescription& method, std::uint64_t seed,
                   const RandomTrialSettings& settings) {
  if (settings.options == TrialOptions::usual) return {};
  // What a document can say may have 64 wavelengths: its ladder takes minutes.
  if (settings.options == TrialOptions::ladder && !says_anything(seed) &&
      !method.ladder.empty())
    return method.ladder[std::mt19937_64(seed)() % method.ladder.size()];
  // So many ask thin layers for, not to jump from sample to sample.
  if (settings.nudge && method.name == "nishita")
    return {{"view_samples", 256}, {"light_samples", 16}};
  return smallest_options(method.name);
}

/// The last step of its ladder; of what has none, as much as takes seconds.
Options finest_options(const MethodDescription& method) {
  if (method.name == "nishita") return {{"view_samples", 2000}, {"light_samples", 64}};
  return method.ladder.empty() ? Options() : method.ladder.back();
}

/// @param options  the others are as they are where nothing is asked
Plan plan_by(json document, const MethodDescription& method, const Options& options) {
  json& choice = document["method"];
  choice["name"] = method.name;
  for (const auto& [name, value] : options) choice[name] = value;
  const Scene scene = read_scene(document);
  Plan plan;
  plan.method = method.name;
  plan.options = scene.method.options;
  plan.wavelengths_nm = wavelengths_of(scene);
  return plan;
}

/// Pointers to all numbers of the scene that may change a little: not counts, not pixels, nor
/// what order one in double, which lights by rays from one point, knows nothing of.
std::vector<json::json_pointer> numbers_of(const json& document) {
  std::vector<json::json_pointer> all;
  const json flat = document.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    if (!value.is_number() || pointer.starts_with("/image") ||
        pointer.starts_with("/camera/fov") || pointer == "/sun/angular_diameter_deg" ||
        pointer == "/sun/distance_km")
      continue;
    all.emplace_back(pointer);
  }
  return all;
}

/// A ten-thousandth more, of 1 where it is 0, or less where more is refused.
json nudged(const json& document, const json::json_pointer& pointer) {
  for (double by : {1e-4, -1e-4}) {
    json changed = document;
    double value = document.at(pointer).get<double>();
    changed[pointer] = value != 0 ? value * (1 + by) : by;
    try {
      read_scene(changed);
      return changed;
    } catch (const SceneError&) {
    }
  }
  return document;
}

double change(double before, double after, double brightest) {
  return std::abs(after - before) / (std::max(before, after) + 1e-3 * brightest);
}

double brightest_of(const Samples& values, std::size_t channel) {
  double most = 0;
  for (const auto& ray : values) most = std::max(most, ray[channel]);
  return most;
}

/// noise_of, per unit of the sun's irradiance.
double relative_noise(const Radiances& seen, std::size_t ray, std::size_t channel) {
  const double radiance = seen.radiance[ray][channel];
  if (radiance <= 0) return 0;
  return noise_of(seen, ray, channel) * seen.relative[ray][channel] / radiance;
}

/// The largest change on a ray, and which rays are looked at.
class Sensitivity {
 public:
  Sensitivity(const Samples& before, const Samples& after) : kept_(before.size(), true) {
    constexpr double jump = 0.05;
    for (std::size_t i = 0; i < before.size(); ++i) {
      double most = 0;
      for (std::size_t c = 0; c < before[i].size(); ++c)
        most = std::max(most, change(before[i][c], after[i][c], brightest_of(before, c)));
      kept_[i] = most < jump;
      if (kept_[i]) largest_ = std::max(largest_, most);
    }
  }

  double largest() const { return largest_; }

  /// The largest change of a method on these rays. Walks that are changed a little part
  /// somewhere: what their noise explains is left out.
  double change_of(const Radiances& a, const Radiances& b) const {
    // Order one in double knows nothing of how strong the sun is at a wavelength.
    const Samples &before = a.relative, &after = b.relative;
    double most = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      for (std::size_t c = 0; kept_[i] && c < before[i].size(); ++c) {
        double noise = relative_noise(a, i, c) + relative_noise(b, i, c);
        double moved = std::max(std::abs(after[i][c] - before[i][c]) - noise, 0.0);
        most =
            std::max(most, change(before[i][c], before[i][c] + moved, brightest_of(before, c)));
      }
    }
    return most;
  }

 private:
  std::vector<bool> kept_;
  double largest_ = 0;
};

bool is_of_all_orders(const std::string& method) {
  return std::ranges::find(methods(), method, &MethodDescription::name)->highest_order != 1;
}

class Run {
 public:
  Run(Engine& engine, std::uint64_t seed, const RandomTrialSettings& settings,
      const Watch& watch)
      : engine_(engine),
        seed_(seed),
        settings_(settings),
        watch_(watch),
        document_(scene_of(seed)) {
    const Scene scene = read_scene(document_);
    directions_ = sample_directions(scene, 16);
    pictured_ = seed % methods().size();
    result_ = {{"seed", seed},
               {"settings", settings_document(settings)},
               {"failures", json::array()},
               {"refusals", json::array()}};
    // What order one in double knows nothing of has no change of its own to be held against.
    const bool one_ground = std::holds_alternative<UniformSurface>(scene.planet.surface);
    if (settings.nudge && one_ground) nudge();
  }

  json done() {
    for (std::size_t i = 0; i < methods().size(); ++i) {
      const MethodDescription& method = methods()[i];
      if (is_wanted(method.name, settings_)) attempt(method, i == pictured_);
    }
    for (const auto& [method, change] : changes_)
      result_["jumps"][method] = change / allowed(method);
    if (sensitivity_) refine();
    return result_;
  }

 private:
  /// Smaller ones are interpolated nowhere.
  static int width_of_picture(const Plan& plan) {
    const auto interpolation = plan.options.find("interpolation");
    return interpolation != plan.options.end() && interpolation->second > 0 ? 192 : 16;
  }

  Trial trial(const std::string& method) const { return Trial(engine_, method, {}, 1, watch_); }

  void nudge() {
    auto numbers = numbers_of(document_);
    std::shuffle(numbers.begin(), numbers.end(), std::mt19937_64(seed_));
    // Counts cannot change a little.
    const auto chosen = std::ranges::find_if(numbers, [&](const json::json_pointer& number) {
      other_ = nudged(document_, number);
      return other_ != document_;
    });
    if (chosen == numbers.end()) return;
    result_["nudged"] = chosen->to_string();
    result_["jumps"] = json::object();
    Trial first = trial("raymarch");
    sensitivity_ = Sensitivity(first.first_order(document_, directions_),
                               first.first_order(other_, directions_));
  }

  /// Notes what the method breaks or refuses.
  template <class Work>
  void noted(const std::string& method, const Work& work) {
    try {
      work();
    } catch (const BrokenFrame& frame) {
      result_["failures"].push_back({{"method", method}, {"what", frame.what()}});
    } catch (const OverLimit& limit) {
      result_["refusals"].push_back({{"method", method}, {"what", limit.what()}});
    }
  }

  void attempt(const MethodDescription& method, bool pictured) {
    noted(method.name, [&] {
      const Plan plan = plan_by(document_, method, options_of(method, seed_, settings_));
      if (pictured) trial(method.name).picture(document_, width_of_picture(plan), plan);
      if (auto change = change_by(plan)) changes_[method.name] = *change;
    });
  }

  /// None where nothing is nudged.
  std::optional<double> change_by(const Plan& plan) {
    Trial asked = trial(plan.method);
    Radiances seen = asked.look(document_, directions_, plan);
    if (!sensitivity_) return std::nullopt;
    return sensitivity_->change_of(seen, asked.look(other_, directions_, plan));
  }

  /// Between coarse nodes pictures are steeper than the scene: where a change is too large, by
  /// the method's finest setting too.
  void refine() {
    for (const MethodDescription& method : methods()) {
      if (result_["jumps"].value(method.name, 0.0) <= 1) continue;
      noted(method.name, [&] {
        const Plan finest = plan_by(document_, method, finest_options(method));
        result_["jumps_at_finest"][method.name] = *change_by(finest) / allowed(method.name);
      });
    }
  }

  /// Where order one hardly changes, in twilight and under layers that scatter often, all
  /// orders may: what two methods agree on is the scene's own.
  double allowed(const std::string& method) const {
    double own = sensitivity_->largest();
    for (const auto& [other, change] : changes_) {
      if (other != method && is_of_all_orders(method) && is_of_all_orders(other))
        own = std::max(own, change);
    }
    return 2 * own + 1e-3;
  }

  Engine& engine_;
  std::uint64_t seed_;
  const RandomTrialSettings& settings_;
  const Watch& watch_;
  json document_, other_;
  std::vector<Direction> directions_;
  std::size_t pictured_ = 0;  ///< the method that also makes a whole frame
  std::optional<Sensitivity> sensitivity_;
  std::map<std::string, double> changes_;
  json result_;
};

bool is_named_in(const json& list, const std::string& method) {
  return std::ranges::any_of(list, [&](const json& entry) {
    return entry.at("method").get_ref<const std::string&>() == method;
  });
}

double over_allowed(const json& trial, const char* settings, const std::string& method) {
  return trial.contains(settings) ? trial[settings].value(method, 0.0) : 0.0;
}

}  // namespace

json settings_document(const RandomTrialSettings& settings) {
  json tried = json::array();
  for (const MethodDescription& method : methods()) {
    if (is_wanted(method.name, settings)) tried.push_back(method.name);
  }
  return {{"methods", std::move(tried)},
          {"nudge", settings.nudge},
          {"options", name_of(settings.options)}};
}

json random_trial(Engine& engine, std::uint64_t seed, const RandomTrialSettings& settings,
                  const Watch& watch) {
  return Run(engine, seed, settings, watch).done();
}

std::string random_report(const std::vector<json>& trials) {
  std::ostringstream report;
  report << "| method | scenes | broken | refused | nudged | over what is allowed | with the "
            "finest setting too | largest change over it | seeds |\n"
            "|---|---|---|---|---|---|---|---|---|\n";
  for (const MethodDescription& method : methods()) {
    int scenes = 0, broken = 0, refused = 0, nudges = 0, over = 0, over_at_finest = 0;
    double largest = 0;
    std::string seeds;
    for (const json& trial : trials) {
      const bool breaks = is_named_in(trial.at("failures"), method.name);
      const double jump = over_allowed(trial, "jumps", method.name),
                   at_finest = over_allowed(trial, "jumps_at_finest", method.name);
      const json& tried = trial.at("settings").at("methods");
      scenes += std::ranges::find(tried, json(method.name)) != tried.end();
      refused += is_named_in(trial.at("refusals"), method.name);
      broken += breaks;
      nudges += trial.contains("jumps") && trial["jumps"].contains(method.name);
      over += jump > 1;
      over_at_finest += at_finest > 1;
      largest = std::max(largest, jump);
      if ((breaks || at_finest > 1) && seeds.size() < 60)
        seeds += " " + std::to_string(trial.at("seed").get<int>());
    }
    char numbers[128];
    std::snprintf(numbers, sizeof numbers, "%d | %d | %d | %d | %d | %d | %.2g", scenes, broken,
                  refused, nudges, over, over_at_finest, largest);
    report << "| `" << method.name << "` | " << numbers << " |" << seeds << " |\n";
  }
  return report.str();
}

}  // namespace cyanometer
