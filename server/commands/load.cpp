// cyanometer load: what a daemon bears.
#include "server/load/load.h"

#include <cstdio>
#include <iostream>
#include <memory>
#include <random>
#include <tuple>

#include "engine/image/encode.h"
#include "engine/scene/document.h"
#include "server/commands/command.h"
#include "server/commands/frame_size.h"

namespace cyanometer {
namespace {

using nlohmann::json;

struct LoadArguments {
  LoadSettings settings;
  std::string scene, vary = name_of(Variation::exposure), format, size;
  double rate = 0;
  bool as_json = false;
};

void print_frames(const LoadReport& report) {
  std::printf(
      "frames       %8.1f a second, p50 %.1f ms, p99 %.1f ms, %zu truncated, %zu kept\n",
      report.frames_per_s(), quantile(report.frame_ms, 0.5), quantile(report.frame_ms, 0.99),
      report.truncated, report.kept);
  if (report.methods.empty()) return;
  std::printf("stages      ");
  for (const auto& [stage, ms] : report.stage_ms) {
    std::printf(" %s %.2f ms", stage.c_str(), quantile(ms, 0.5));
  }
  std::printf(", medians\nerror        %8.2g %% stated at most, %zu frames worse than asked\n",
              100 * report.stated_error, report.unmet);
  if (report.daemon_cpu_s && !report.frame_ms.empty()) {
    std::printf("daemon       %8.2f ms of CPU a frame\n",
                1000 * *report.daemon_cpu_s / static_cast<double>(report.frame_ms.size()));
  }
}

void print(const LoadReport& report) {
  for (const auto& [status, count] : report.statuses) {
    std::printf("%-12s %8zu\n", status == 0 ? "no answer" : std::to_string(status).c_str(),
                count);
  }
  std::printf("asked        %8.1f a second\n", report.asked_per_s());
  print_frames(report);
  if (!report.reject_ms.empty()) {
    std::printf("turned away  %8zu, p50 %.2f ms, p99 %.2f ms, %zu without Retry-After\n",
                report.reject_ms.size(), quantile(report.reject_ms, 0.5),
                quantile(report.reject_ms, 0.99), report.without_retry_after);
  }
  std::printf("generator    %8.2f s of CPU in %.1f s, %zu requests late\n", report.cpu_s,
              report.seconds, report.late);
}

json image_asked(const LoadArguments& arguments) {
  json image = json::object();
  if (!arguments.format.empty()) image["format"] = arguments.format;
  if (!arguments.size.empty()) {
    std::tie(image["width"], image["height"]) = read_frame_size(arguments.size);
  }
  return image;
}

void load(LoadArguments arguments) {
  LoadSettings& settings = arguments.settings;
  if (arguments.rate > 0) settings.rate = arguments.rate;
  settings.vary = variation_of(arguments.vary);
  settings.first = std::random_device{}() / 4;  // or a second run would meet the first one's
  if (!arguments.scene.empty()) settings.scene = read_document(arguments.scene);
  if (!settings.scene.is_object()) {
    throw CommandError(exit_refused, arguments.scene + " is no scene");
  }
  settings.scene = merge(settings.scene, {{"image", image_asked(arguments)}});
  const LoadReport report = run_load(settings);
  if (arguments.as_json) {
    std::cout << load_document(report).dump(1) << "\n";
  } else {
    print(report);
  }
}

}  // namespace

void add_load(CLI::App& app) {
  auto* command = app.add_subcommand("load", "Load a daemon and say what it bears");
  const auto arguments = std::make_shared<LoadArguments>();
  LoadSettings& settings = arguments->settings;
  settings.scene = {{"image", {{"width", 64}, {"height", 36}}}};
  command->add_option("url", settings.origin, "Its address")->capture_default_str();
  command
      ->add_option("--clients", settings.clients, "Connections, each with one request at once")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command
      ->add_option("--rate", arguments->rate,
                   "Requests a second that arrive whether or not earlier ones are answered; 0: "
                   "each client asks when it has its answer")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  command->add_option("--seconds", settings.seconds, "How long")
      ->check(CLI::Range(0.1, 1e6))
      ->capture_default_str();
  command->add_option("--scene", arguments->scene,
                      "Scene document, - is standard input; without it, 64 x 36 pixels");
  command->add_option("--size", arguments->size, "Of its frames, as 1280x720");
  command->add_option("--format", arguments->format, "Of its frames")
      ->check(CLI::IsMember(format_names()));
  command
      ->add_option("--vary", arguments->vary,
                   "What changes from frame to frame, to and fro; nothing: the same scene each "
                   "time, which is kept; exposure: none is kept, all else stays")
      ->check(CLI::IsMember(variation_names()))
      ->capture_default_str();
  command->add_option("--from", settings.sources,
                      "Addresses of this machine from which the clients ask, in turn");
  command->add_option("--token", settings.token, "The daemon's bearer token")
      ->envname("CYANOMETER_TOKEN");
  command->add_flag("--json", arguments->as_json, "The figures as JSON");
  command->footer(
      "Times of frames are from when a request was due, so that one that could not be sent in "
      "time\ncounts as slow. Give an open load enough clients to be never late.\n"
      "CPU of the daemon is known where its metrics say process_cpu_seconds_total.\n"
      "Example: cyanometer load http://127.0.0.1:8080 --rate 500 --clients 256 --seconds 30\n"
      "Example: cyanometer load --vary sun --size 1280x720 --format jpeg --clients 4");
  command->callback([arguments] { load(*arguments); });
}

}  // namespace cyanometer
