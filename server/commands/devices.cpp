// cyanometer devices: what there is to compute on.
#include <algorithm>
#include <array>
#include <iostream>
#include <memory>

#include "server/commands/command.h"

namespace cyanometer {
namespace {

using Row = std::array<std::string, 6>;

void print_table(const std::vector<Row>& rows) {
  std::array<std::size_t, 6> widths{};
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += row[i] + std::string(widths[i] - row[i].size() + 2, ' ');
    }
    std::cout << line.substr(0, line.find_last_not_of(' ') + 1) << "\n";
  }
}

void devices(const std::string& wanted) {
  const auto found = list_devices({.device = wanted});
  std::vector<Row> rows{{"", "device", "type", "driver", "vulkan", "why"}};
  for (const auto& each : found) {
    rows.push_back({each.chosen ? "*" : "", each.name, each.type, each.driver, each.api_version,
                    each.why});
  }
  print_table(rows);
  if (std::ranges::none_of(found, &DeviceDescription::chosen)) {
    throw CommandError(exit_failed, "none of these can be used");
  }
}

}  // namespace

void add_devices(CLI::App& app) {
  auto* command = app.add_subcommand("devices", "List the Vulkan devices; * would be used");
  const auto wanted = std::make_shared<std::string>();
  command->add_option("--device", *wanted, "Part of the device's name");
  command->footer("Example: cyanometer devices --device llvmpipe");
  command->callback([wanted] { devices(*wanted); });
}

}  // namespace cyanometer
