// cyanometer load-report: frames a second of every class of frames, as tables and a picture.
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>

#include "engine/scene/document.h"
#include "server/commands/command.h"
#include "server/commands/frame_size.h"
#include "server/load/own_daemon.h"
#include "server/load/survey.h"
#include "server/load/variation.h"

namespace cyanometer {
namespace {

using nlohmann::json;

struct LoadReportArguments {
  std::string folder, scene, device;
  std::vector<std::string> sizes;
  double minutes = 0;
  bool rates_only = false;
  SurveySettings settings;
};

SurveySettings settings_from(const LoadReportArguments& arguments) {
  SurveySettings settings = arguments.settings;
  if (!arguments.scene.empty()) settings.scene = read_document(arguments.scene);
  if (!arguments.sizes.empty()) settings.sizes.clear();
  for (const std::string& size : arguments.sizes)
    settings.sizes.push_back(read_frame_size(size));
  for (const auto& [width, height] : settings.sizes) {
    read_scene(settings.scene, {{"image", {{"width", width}, {"height", height}}}});
  }
  return settings;
}

DeviceDescription chosen_device(const std::string& part) {
  for (const DeviceDescription& device : list_devices({.device = part})) {
    if (device.chosen) return device;
  }
  throw CommandError(exit_failed, "there is no such Vulkan device");
}

class LoadReportRun {
 public:
  LoadReportRun(const LoadReportArguments& arguments, const Watch& watch)
      : arguments_(arguments),
        settings_(settings_from(arguments)),
        watch_(watch),
        folder_(arguments.folder) {
    survey_.device = chosen_device(arguments.device).name + " on " +
                     std::to_string(std::thread::hardware_concurrency()) + " cores";
    survey_.version = version();
    std::filesystem::create_directories(folder_);
    read_lines();
    out_.open(lines(), std::ios::app);
    if (!out_) throw CommandError(exit_failed, "cannot write " + lines().string());
  }

  void measure() {
    left_ = missing_points(settings_, survey_).size();
    if (!arguments_.rates_only) left_ += missing_errors(settings_, survey_).size();
    if (left_ == 0) return;
    all_ = left_;
    Engine engine({.device = arguments_.device});
    const int most = std::ranges::max(settings_.clients);
    // One address asks with all of them, and has three quarters of the places.
    const OwnDaemon daemon({"--device", arguments_.device, "--queue", std::to_string(2 * most),
                            "--threads", std::to_string(2 * most + 64)});
    daemon.wait_until_ready(watch_);
    const SurveyedDaemon surveyed{daemon.origin(), daemon.pid(), [&](const Image& image) {
                                    return engine.store_ms(image, watch_);
                                  }};
    measure_rates(
        surveyed, settings_, watch_, [&](const auto& point) { add(point); }, survey_);
    if (arguments_.rates_only) return;
    measure_errors(
        surveyed, settings_, watch_, [&](const auto& error) { add(error); }, survey_);
  }

  void write() const {
    write_file((folder_ / "report.md").string(), survey_table(survey_, settings_));
    write_file((folder_ / "report.svg").string(), survey_svg(survey_));
  }

 private:
  std::filesystem::path lines() const { return folder_ / "points.jsonl"; }

  /// What was measured by another version, on another device or of another scene is another
  /// measurement.
  json by() const {
    return {{"version", survey_.version},
            {"device", survey_.device},
            {"scene", settings_.scene},
            {"seconds", settings_.seconds}};
  }

  void read_lines() {
    std::ifstream in(lines());
    for (std::string line; std::getline(in, line);) {
      const json found = json::parse(line, nullptr, false);
      if (!found.is_object() || found.value("by", json()) != by()) continue;
      try {
        if (found.contains("point")) survey_.points.push_back(found.at("point"));
        if (found.contains("error")) survey_.errors.push_back(found.at("error"));
      } catch (const std::exception&) {
        continue;  // as another program wrote it: measured again
      }
    }
  }

  void add(const SurveyPoint& point) {
    end_progress();
    std::fprintf(stderr, "%d x %d %s, %s varies, %d clients: %.3g a second, %.3g x the floor\n",
                 point.width, point.height, point.format.c_str(), point.vary.c_str(),
                 point.clients, point.frames_per_s, point.over_floor());
    keep({{"point", point}});
  }

  void add(const SurveyError& error) {
    end_progress();
    std::fprintf(stderr, "%s, %s varies, %d x %d: error %.2g %%, stated %.2g %%\n",
                 error.preset.empty() ? "the scene" : error.preset.c_str(), error.vary.c_str(),
                 error.width, error.height, 100 * error.error, 100 * error.stated);
    keep({{"error", error}});
  }

  void keep(json line) {
    line["by"] = by();
    out_ << line << std::endl;
    write();
    --left_;
    show_progress(1 - static_cast<double>(left_) / static_cast<double>(all_),
                  std::to_string(left_) + " left");
  }

  const LoadReportArguments& arguments_;
  SurveySettings settings_;
  const Watch& watch_;
  std::filesystem::path folder_;
  Survey survey_;
  std::ofstream out_;
  std::size_t left_ = 0, all_ = 0;  ///< points and errors to be measured
};

void load_report(const LoadReportArguments& arguments) {
  Watch watch = command_watch();
  if (arguments.minutes > 0) {
    watch.deadline =
        std::chrono::steady_clock::now() +
        std::chrono::milliseconds(static_cast<std::int64_t>(60000 * arguments.minutes));
  }
  LoadReportRun run(arguments, watch);
  try {
    run.measure();
  } catch (const Cancelled& cancelled) {
    if (cancelled.reason != Cancelled::Reason::deadline) throw;
    end_progress();
    std::fprintf(stderr, "the time is over; the same command goes on\n");
  }
  end_progress();
  run.write();
}

}  // namespace

void add_load_report(CLI::App& app) {
  auto* command = app.add_subcommand(
      "load-report", "Frames a second of every class of frames, as report.md and report.svg");
  const auto arguments = std::make_shared<LoadReportArguments>();
  SurveySettings& settings = arguments->settings;
  command->add_option("-o,--output", arguments->folder, "Folder; what is there goes on")
      ->required();
  command->add_option("--scene", arguments->scene,
                      "Scene document that is timed, - is standard input; without it, earth");
  command->add_option("--clients", settings.clients, "Only so many; may be repeated")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->add_option(
      "--size", arguments->sizes,
      "Only of this size, as 1280x720; may be repeated; without it 360p, 720p and 1080p");
  command->add_option("--format", settings.formats, "Only these; may be repeated")
      ->check(CLI::IsMember(format_names()))
      ->capture_default_str();
  command->add_option("--vary", settings.vary, "Only what varies so; may be repeated")
      ->check(CLI::IsMember(variation_names()))
      ->capture_default_str();
  command->add_option("--seconds", settings.seconds, "Of each load, after a quarter as much")
      ->check(CLI::Range(0.05, 3600.0))
      ->capture_default_str();
  command
      ->add_option("--preset", settings.presets,
                   "Presets whose frames are held against the converged solution beside the "
                   "scene's; may be repeated")
      ->check(CLI::IsMember(preset_names()))
      ->capture_default_str();
  command->add_flag("--rates-only", arguments->rates_only, "Leaves the errors to a later run");
  command
      ->add_option("--minutes", arguments->minutes, "Begins nothing after so many; 0: no end")
      ->check(CLI::Range(0.0, 1e5));
  command->add_option("--device", arguments->device, "Part of the Vulkan device's name");
  command->footer(
      "Starts a daemon of its own. Long; a run that was stopped goes on. Nothing else should "
      "work "
      "on\nthe machine meanwhile. Errors come last, each measured once.\n"
      "Example: cyanometer load-report -o frames\n"
      "Example: cyanometer load-report -o quick --clients 4 --size 640x360 --format jpeg "
      "--seconds 1 --rates-only");
  command->callback([arguments] { load_report(*arguments); });
}

}  // namespace cyanometer
