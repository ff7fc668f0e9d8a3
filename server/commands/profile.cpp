// cyanometer profile: how fast the device is, measured anew.
#include <iostream>
#include <memory>

#include "server/commands/command.h"

namespace cyanometer {
namespace {

void profile(const std::string& device) {
  Engine engine = command_engine(device);
  // What a daemon does first: it will find all compiled.
  engine.warm();
  std::cout << engine.device().name << ", million evaluations a second:\n";
  for (const auto& [method, per_ms] : engine.measure_profile(command_watch())) {
    std::printf("  %-10s %8.0f\n", method.c_str(), per_ms / 1000);
  }
}

}  // namespace

void add_profile(CLI::App& app) {
  auto* command = app.add_subcommand(
      "profile", "Measure how fast the device is, and keep it: what `max_ms` is reckoned by");
  const auto device = std::make_shared<std::string>();
  command->add_option("--device", *device, "Part of the Vulkan device's name");
  command->footer(
      "The daemon does it at its first start on a device. Leave the machine alone meanwhile.\n"
      "Example: cyanometer profile --device llvmpipe");
  command->callback([device] { profile(*device); });
}

}  // namespace cyanometer
