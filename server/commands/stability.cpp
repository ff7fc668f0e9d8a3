// cyanometer stability: where the methods fail.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/cache_folder.h"
#include "engine/stability/random_trials.h"
#include "engine/stability/report.h"
#include "server/commands/command.h"

namespace cyanometer {
namespace {

using nlohmann::json;

struct StabilityArguments {
  std::string folder, device;
  std::vector<int> rows;
  std::vector<std::string> methods;
  StabilitySettings settings{.references = cache_folder("references")};
  std::uint64_t random = 0, first = 0, nudge_each = 10, ladder_each = 100;
  bool usual_options = false;
};

/// What an earlier run left of this version on this device, with as much work, one point a
/// line.
std::vector<StabilityPoint> read_points(const std::filesystem::path& file, const json& by) {
  std::vector<StabilityPoint> points;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    json found = json::parse(line, nullptr, false);
    if (!found.is_object() || found.value("by", json()) != by) continue;
    try {
      points.push_back(stability_point_from(found));
    } catch (const std::exception&) {
      continue;  // cut off in the middle: measured again
    }
  }
  return points;
}

template <class List, class Value>
bool wanted(const List& list, const Value& value) {
  return list.empty() || std::ranges::find(list, value) != list.end();
}

class StabilityRun {
 public:
  StabilityRun(const StabilityArguments& arguments, Engine& engine, const Watch& watch)
      : arguments_(arguments), engine_(engine), watch_(watch) {
    by_ = {{"version", version()},
           {"device", engine.device().name},
           {"most_work", arguments.settings.most_work}};
    report_ = {engine.device().name, version(), read_points(file(), by_)};
    out_.open(file(), std::ios::app);
    if (!out_) throw CommandError(exit_failed, "cannot write " + file().string());
  }

  void measure(const StabilityRow& row) {
    for (const std::string& method : stability_subjects()) {
      if (!wanted(arguments_.methods, method)) continue;
      for (double trigger : row.sweep) {
        auto known = [&](const StabilityPoint& point) {
          return point.row == row.number && point.method == method &&
                 point.trigger == trigger && (row.number > 0 || point.note == row.name);
        };
        if (std::ranges::any_of(report_.points, known)) continue;
        add(row, measure_point(engine_, row, method, trigger, arguments_.settings, watch_));
      }
    }
  }

  void write() const {
    std::filesystem::path folder = arguments_.folder;
    write_file((folder / "stability.md").string(), stability_table(report_));
    write_file((folder / "stability.svg").string(), stability_svg(report_));
  }

 private:
  std::filesystem::path file() const {
    return std::filesystem::path(arguments_.folder) / "points.jsonl";
  }

  void add(const StabilityRow& row, StabilityPoint point) {
    if (row.number == 0) point.note = row.name;
    json line = point_document(point);
    line["by"] = by_;
    out_ << line << std::endl;
    end_progress();
    std::fprintf(stderr, "%d %s, %s at %g: %s %.2g%s%s\n", row.number, row.name.c_str(),
                 point.method.c_str(), point.trigger, name_of(point.outcome).c_str(),
                 point.value, point.note.empty() ? "" : ", ", point.note.c_str());
    report_.points.push_back(std::move(point));
    write();
  }

  const StabilityArguments& arguments_;
  Engine& engine_;
  const Watch& watch_;
  json by_;
  StabilityReport report_;
  std::ofstream out_;
};

RandomTrialSettings settings_of(const StabilityArguments& arguments, std::uint64_t seed) {
  RandomTrialSettings settings{.methods = arguments.methods,
                               .nudge = seed % arguments.nudge_each == 0};
  const bool by_ladder = (seed + 1) % arguments.ladder_each == 0;
  if (arguments.usual_options)
    settings.options = TrialOptions::usual;
  else if (by_ladder && !settings.nudge)
    settings.options = TrialOptions::ladder;
  return settings;
}

/// What an earlier run left of this version on this device and was asked the same, by seed.
std::map<std::uint64_t, json> read_trials(const std::filesystem::path& file, const json& by,
                                          const StabilityArguments& arguments) {
  std::map<std::uint64_t, json> trials;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    json found = json::parse(line, nullptr, false);
    if (!found.is_object() || found.value("by", json()) != by) continue;
    const std::uint64_t seed = found.at("seed");
    if (found.value("settings", json()) == settings_document(settings_of(arguments, seed)))
      trials[seed] = std::move(found);
  }
  return trials;
}

/// Random scenes instead of rows.
void random(const StabilityArguments& arguments, Engine& engine, const Watch& watch) {
  const std::filesystem::path folder = arguments.folder,
                              file = folder / (arguments.usual_options ? "random_usual.jsonl"
                                                                       : "random.jsonl");
  const json by{{"version", version()}, {"device", engine.device().name}};
  std::map<std::uint64_t, json> trials = read_trials(file, by, arguments);
  std::ofstream out(file, std::ios::app);
  if (!out) throw CommandError(exit_failed, "cannot write " + file.string());
  for (std::uint64_t i = 0; i < arguments.random; ++i) {
    std::uint64_t seed = arguments.first + i;
    if (trials.contains(seed)) continue;
    json trial = random_trial(engine, seed, settings_of(arguments, seed), watch);
    trial["by"] = by;
    out << trial << std::endl;
    trials[seed] = std::move(trial);
    show_progress(static_cast<double>(i) / static_cast<double>(arguments.random),
                  std::to_string(i) + " scenes");
  }
  end_progress();
  std::vector<json> all;
  for (auto& [seed, trial] : trials) all.push_back(std::move(trial));
  std::cout << random_report(all);
}

void stability(const StabilityArguments& arguments) {
  if (arguments.random > 0 &&
      std::ranges::find(arguments.methods, "auto") != arguments.methods.end())
    throw CommandError(
        exit_refused,
        "--method auto is none that --random tries: those have names of their own");
  const Watch watch = command_watch();
  std::filesystem::create_directories(arguments.folder);
  Engine engine = command_engine(arguments.device);
  if (arguments.random > 0) return random(arguments, engine, watch);
  StabilityRun run(arguments, engine, watch);
  for (const StabilityRow& row : stability_rows()) {
    if (wanted(arguments.rows, row.number)) run.measure(row);
  }
  for (const StabilityRow& curve : stability_curves()) {
    if (wanted(arguments.rows, curve.number)) run.measure(curve);
  }
  end_progress();
  run.write();
}

}  // namespace

void add_stability(CLI::App& app) {
  auto* command = app.add_subcommand(
      "stability", "Where methods fail: scenes that break them, as a table and a picture");
  const auto arguments = std::make_shared<StabilityArguments>();
  command->add_option("-o,--output", arguments->folder, "Folder; what is there goes on")
      ->required();
  command
      ->add_option("--row", arguments->rows,
                   "Only these rows, 1 to 25; 0 is the errors along quantities of a scene")
      ->check(CLI::Range(0, 25));
  command->add_option("--method", arguments->methods, "Only these; may be repeated")
      ->check(CLI::IsMember(stability_subjects()));
  command
      ->add_option("--most-work", arguments->settings.most_work,
                   "Random walks of one reference, however noisy that leaves it")
      ->check(CLI::Range(1e3, 1e10))
      ->capture_default_str();
  command
      ->add_option("--random", arguments->random,
                   "So many random scenes instead: whether every value is finite and none "
                   "negative")
      ->check(CLI::Range(1, 100000000));
  command->add_option("--first", arguments->first, "The first of their seeds")
      ->capture_default_str();
  command
      ->add_option("--nudge-each", arguments->nudge_each,
                   "One of so many random scenes is changed a little, and its picture may "
                   "change but a little")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command
      ->add_option("--ladder-each", arguments->ladder_each,
                   "One of so many is rendered by settings that auto chooses among, not with "
                   "the smallest tables")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->add_flag(
      "--usual", arguments->usual_options,
      "Random scenes by each method at its defaults, not with its smallest tables");
  command->add_option("--references", arguments->settings.references, "Folder of references")
      ->capture_default_str();
  command->add_option("--device", arguments->device, "Part of the Vulkan device's name");
  command->footer(
      "Writes stability.md, stability.svg and points.jsonl. Long; a run that was stopped goes "
      "on.\n"
      "Example: cyanometer stability --row 13 --row 16 -o failures\n"
      "Example: cyanometer stability --random 50000 -o failures");
  command->callback([arguments] { stability(*arguments); });
}

}  // namespace cyanometer
