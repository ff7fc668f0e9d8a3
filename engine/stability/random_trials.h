// Random scenes through every method: whether every value is finite and none negative, and
// whether pictures change no faster than the scene does.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/engine.h"

namespace cyanometer {

/// By what options each method is tried.
enum class TrialOptions {
  smallest,  ///< tables as small as still have something to interpolate
  usual,     ///< its defaults
  ladder,    ///< of air and haze a setting that `auto` chooses among, most pixels interpolated
};

struct RandomTrialSettings {
  TrialOptions options = TrialOptions::smallest;
  std::vector<std::string> methods = {};  ///< only these; none: all
  bool nudge = false;  ///< also changes one number of the scene by a ten-thousandth
};

/// What decides a trial beside its seed, as it stands in it: {"methods": those that are tried,
/// "nudge", "options"}.
nlohmann::json settings_document(const RandomTrialSettings& settings);

/// {"seed", "settings", "failures": [{"method", "what"}], "refusals": the same}, and where a
/// number was nudged {"nudged": its pointer, "jumps": {method: of all rays the largest change
/// over what is allowed}}. Allowed are twice the largest change that order one in double makes
/// on any ray, or, of methods of all orders, that another of them makes, and 1e-3; rays on
/// which order one jumps itself, at horizons and at the edge of the shadow, are left out. What
/// is over it is tried by the method's finest setting: "jumps_at_finest".
nlohmann::json random_trial(Engine& engine, std::uint64_t seed,
                            const RandomTrialSettings& settings, const Watch& watch = {});

/// What many of them say, in Markdown: scenes that were tried, failures by method with their
/// seeds, and how near to what is allowed the changes come.
std::string random_report(const std::vector<nlohmann::json>& trials);

}  // namespace cyanometer
