// cyanometer load: what a daemon bears.
#include "server/load/load.h"

#include <cstdio>
#include <iostream>
#include <memory>
#include <random>

#include "server/commands/command.h"

namespace cyanometer {
namespace {

using nlohmann::json;

struct LoadArguments {
  LoadSettings settings;
  std::string scene;
  double rate = 0;
  bool same = false, as_json = false;
};

void print(const LoadReport& report) {
  for (const auto& [status, count] : report.statuses) {
    std::printf("%-12s %8zu\n", status == 0 ? "no answer" : std::to_string(status).c_str(),
                count);
  }
  std::printf("asked        %8.1f a second\n", report.asked_per_s());
  std::printf("frames       %8.1f a second, p50 %.1f ms, p99 %.1f ms, %zu truncated\n",
              report.frames_per_s(), quantile(report.frame_ms, 0.5),
              quantile(report.frame_ms, 0.99), report.truncated);
  if (!report.reject_ms.empty()) {
    std::printf("turned away  %8zu, p50 %.2f ms, p99 %.2f ms, %zu without Retry-After\n",
                report.reject_ms.size(), quantile(report.reject_ms, 0.5),
                quantile(report.reject_ms, 0.99), report.without_retry_after);
  }
  std::printf("generator    %8.2f s of CPU in %.1f s, %zu requests late\n", report.cpu_s,
              report.seconds, report.late);
}

void load(LoadArguments arguments) {
  LoadSettings& settings = arguments.settings;
  if (arguments.rate > 0) settings.rate = arguments.rate;
  settings.first = std::random_device{}() / 4;  // or a second run would meet the first one's
  json scene{{"image", {{"width", 64}, {"height", 36}}}};
  if (!arguments.scene.empty()) scene = read_document(arguments.scene);
  if (!scene.is_object()) {
    throw CommandError(exit_refused, arguments.scene + " is no scene");
  }
  settings.scene =
      arguments.same ? [scene](std::size_t) { return scene; } : ever_brighter(scene);
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
  command
      ->add_option("--seconds", settings.seconds,
                   "How long; rates are of what was asked and answered in that time")
      ->check(CLI::Range(0.1, 1e6))
      ->capture_default_str();
  command->add_option("--scene", arguments->scene,
                      "Scene document, - is standard input; without it, 64 x 36 pixels");
  command->add_flag("--same", arguments->same,
                    "The same scene each time; else each another frame of the same plan");
  command->add_option("--from", settings.sources,
                      "Addresses of this machine from which the clients ask, in turn");
  command->add_option("--token", settings.token, "The daemon's bearer token")
      ->envname("CYANOMETER_TOKEN");
  command->add_flag("--json", arguments->as_json, "The figures as JSON");
  command->footer(
      "Times of frames are from when a request was due, so that one that could not be sent in "
      "time\ncounts as slow. Give an open load enough clients to be never late.\n"
      "Example: cyanometer load http://127.0.0.1:8080 --rate 500 --clients 256 --seconds 30");
  command->callback([arguments] { load(*arguments); });
}

}  // namespace cyanometer
