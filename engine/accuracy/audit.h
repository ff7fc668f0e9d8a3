// Whether plans keep their word: random scenes, what `auto` chose for them and stated, and what
// every choice that it had is worth in truth.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/accuracy/reference.h"
#include "engine/engine.h"

namespace cyanometer {

/// The errors that are asked for.
inline constexpr double audited_errors[] = {0.1, 0.03, 0.01, 0.003};

/// One random scene, measured: {"seed", "noise", "walks", "choices": [{"method", "options",
/// "ms", "took_ms", "error", "error_95"}], "plans": [{"asked", "method", "options", "stated",
/// "met", "ms"}], "plans_in_time"}, the last as the plans, but with "asked_ms"; or
/// {"seed", "failure"} where it was refused. `ms` are the planner's own; "took_ms" is the
/// device's time of a frame with its tables, where no more than seconds are expected.
nlohmann::json audit_scene(Engine& engine, std::uint64_t seed, const ReferenceGoal& goal,
                           const std::filesystem::path& references, const Watch& watch = {});

/// What the scenes together say of one asked error.
struct AuditRow {
  double asked = 0;
  int scenes = 0;  ///< where some choice meets it and the reference can tell, or refused
  std::vector<std::uint64_t> undecided;  ///< seeds where it cannot: the chosen error's interval
                                         ///< holds what was asked
  int kept = 0;           ///< of `scenes`: those whose chosen error is at most what was asked
  int bounded = 0;        ///< of all decided: those whose error is at most what was stated
  int decided = 0;        ///< those whose error's interval does not hold what was stated
  int impossible = 0;     ///< scenes that no choice meets: left out of `scenes`
  double overstated = 0;  ///< median of stated over true error
  double time_over_cheapest = 0;  ///< median, where kept
};
std::vector<AuditRow> audit_rows(const std::vector<nlohmann::json>& scenes);

/// Of plans within a time, in all scenes.
struct AuditedTimes {
  int promised = 0, kept = 0;     ///< said to be within it; and are
  int refused = 0, possible = 0;  ///< said to be met by nothing; and are by something
};
AuditedTimes audited_times(const std::vector<nlohmann::json>& scenes);

/// The rows and the times as a table and a sentence in Markdown, below them the scenes that
/// failed, by seed.
std::string audit_report(const std::vector<nlohmann::json>& scenes);

}  // namespace cyanometer
