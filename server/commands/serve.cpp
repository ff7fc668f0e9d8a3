// cyanometer serve: the daemon.
#include <csignal>
#include <ctime>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "server/commands/command.h"
#include "server/config.h"
#include "server/daemon.h"
#include "server/log.h"

namespace cyanometer {
namespace {

void add_setting(CLI::App& command, Config& config, const Setting& setting) {
  std::visit(
      [&](auto member) {
        auto* option = command.add_option(setting.flag(), config.*member, setting.help);
        option->envname(setting.variable())->capture_default_str();
        if (!setting.choices.empty()) {
          option->check(CLI::IsMember(setting.choices));
        } else if constexpr (!std::is_same_v<decltype(member), std::string Config::*>) {
          using Number = std::remove_reference_t<decltype(config.*member)>;
          option->check(CLI::Range(static_cast<Number>(setting.minimum),
                                   static_cast<Number>(setting.maximum)));
        }
      },
      setting.member);
}

/// SIGTERM and SIGINT are taken by sigtimedwait alone; every thread made later inherits this.
sigset_t block_stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

void wait_for_end(const Daemon& daemon, const sigset_t& signals) {
  constexpr timespec glance{0, 100'000'000};
  while (!daemon.failed() && sigtimedwait(&signals, nullptr, &glance) < 0) {
  }
}

/// A second signal does not wait for what is in flight.
void let_signals_kill(const sigset_t& signals) {
  std::signal(SIGTERM, SIG_DFL);
  std::signal(SIGINT, SIG_DFL);
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

void serve(const Config& config) {
  start_log(config.log_level);
  const sigset_t signals = block_stop_signals();
  Daemon daemon(config);
  daemon.start();
  log_line(spdlog::level::info,
           {{"event", "listening"}, {"port", daemon.port()}, {"ops_port", daemon.ops_port()}});
  wait_for_end(daemon, signals);
  const bool failed = daemon.failed();
  let_signals_kill(signals);
  log_event(spdlog::level::info, "stopping");
  daemon.stop();
  if (failed) throw CommandError(exit_failed, "the daemon cannot go on; its log says why");
}

}  // namespace

void add_serve(CLI::App& app) {
  auto* command = app.add_subcommand("serve", "Answer over HTTP");
  const auto config = std::make_shared<Config>();
  const auto markdown = std::make_shared<bool>(false);
  for (const auto& setting : settings()) add_setting(*command, *config, setting);
  command->add_flag("--help-markdown", *markdown, "Print these settings as a table and end");
  command->footer(
      "Example: cyanometer serve --listen 127.0.0.1:8080 --ops-listen 127.0.0.1:9090");
  command->callback([config, markdown] {
    if (*markdown) {
      std::cout << settings_markdown();
    } else {
      serve(*config);
    }
  });
}

}  // namespace cyanometer
