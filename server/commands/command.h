// The command line: one file a command, one line each in the table of command.cpp.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <string>

#include "engine/engine.h"

namespace cyanometer {

/// What a command ends with, as its --help says.
enum Exit : int {
  exit_done = 0,
  exit_failed = 1,       ///< something went wrong: no device, no file, no answer
  exit_refused = 2,      ///< the command line or the scene is not valid
  exit_cancelled = 130,  ///< by SIGINT, as shells count it
};

/// Ends the command with this message on standard error.
struct CommandError : std::runtime_error {
  CommandError(Exit code_, const std::string& message)
      : std::runtime_error(message), code(code_) {}
  Exit code;
};

/// Parses the command line, runs the command, and says on standard error what went wrong.
int run_command(int count, char** arguments);

/// All bytes of a file; "-" is standard input. @throws CommandError
std::string read_file(const std::string& path);

/// The JSON document in a file; "-" is standard input. @throws CommandError, SceneError
nlohmann::json read_document(const std::string& path);

/// Writes all bytes; "-" is standard output. @throws CommandError
void write_file(const std::string& path, const std::string& bytes);

/// An engine on the device whose name has this part, with the profiles that the daemon keeps.
Engine command_engine(const std::string& device);

/// For options that take a preset, a method, or an image's format.
std::vector<std::string> preset_names();
std::vector<std::string> method_names();
std::vector<std::string> format_names();

/// A watch that SIGINT and SIGTERM cancel and that shows a bar on a terminal.
Watch command_watch();
/// Draws the bar, with a note after it, on a terminal.
void show_progress(double share, const std::string& note = "");
/// Removes the bar.
void end_progress();

void add_serve(CLI::App& app);
void add_render(CLI::App& app);
void add_radiance(CLI::App& app);
void add_plan(CLI::App& app);
void add_compare(CLI::App& app);
void add_composite(CLI::App& app);
void add_explain(CLI::App& app);
void add_attribute(CLI::App& app);
void add_experiments(CLI::App& app);
void add_devices(CLI::App& app);
void add_health(CLI::App& app);
void add_contact_sheet(CLI::App& app);
void add_schema(CLI::App& app);
void add_bench(CLI::App& app);
void add_chart(CLI::App& app);
void add_audit(CLI::App& app);
void add_profile(CLI::App& app);
void add_load(CLI::App& app);
void add_load_report(CLI::App& app);
void add_tables(CLI::App& app);
void add_stability(CLI::App& app);
void add_precision(CLI::App& app);

}  // namespace cyanometer
