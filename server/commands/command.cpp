#include "server/commands/command.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "engine/cache_folder.h"
#include "engine/image/encode.h"
#include "engine/scene/document.h"
#include "engine/surface/maps.h"

namespace cyanometer {
namespace {

/// Set by a signal, read by every thread that works.
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

/// Of images of surfaces, kept while a command runs.
constexpr std::size_t surface_bytes = std::size_t{256} << 20;

void say(const std::string& message) { std::cerr << "cyanometer: " << message << "\n"; }

int refuse(const SceneError& error) {
  say("the scene is refused: " + std::string(error.what()));
  return exit_refused;
}

/// Parse errors are the caller's mistakes; --help and --version are none.
int report(const CLI::App& app, const CLI::ParseError& error) {
  return app.exit(error) == 0 ? exit_done : exit_refused;
}

}  // namespace

int run_command(int count, char** arguments) {
  CLI::App app{"Skies and planets: atmospheric scattering over HTTP and on the command line."};
  app.name("cyanometer");
  app.set_version_flag("--version", version());
  app.require_subcommand(1);
  app.fallthrough();
  app.add_option_function<std::string>(
         "--surfaces", [](const std::string& folder) { use_surfaces(folder, surface_bytes); },
         "Folder of images that scenes may name in planet.surface; also CYANOMETER_SURFACES")
      ->envname("CYANOMETER_SURFACES");
  app.footer("Exit codes: 0 done, 1 failed, 2 command line or scene refused, 130 cancelled.");
  for (const auto add :
       {add_serve,     add_render,        add_radiance,  add_plan,        add_compare,
        add_composite, add_explain,       add_attribute, add_experiments, add_devices,
        add_health,    add_contact_sheet, add_schema,    add_bench,       add_chart,
        add_audit,     add_profile,       add_load,      add_load_report, add_tables,
        add_stability, add_precision}) {
    add(app);
  }
  try {
    app.parse(count, arguments);
    return exit_done;
  } catch (const CLI::ParseError& error) {
    return report(app, error);
  } catch (const SceneError& error) {
    return refuse(error);
  } catch (const OverLimit& limit) {
    say("over a limit at " + limit.pointer + ": " + limit.what());
    return exit_refused;
  } catch (const CommandError& error) {
    say(error.what());
    return error.code;
  } catch (const Cancelled&) {
    end_progress();
    say("cancelled");
    return exit_cancelled;
  } catch (const std::exception& error) {
    say(error.what());
    return exit_failed;
  }
}

std::string read_file(const std::string& path) {
  std::ifstream file;
  if (path != "-") {
    file.open(path, std::ios::binary);
    if (!file) throw CommandError(exit_failed, "cannot read " + path);
  }
  std::istream& in = path == "-" ? std::cin : file;
  return std::string(std::istreambuf_iterator<char>(in), {});
}

nlohmann::json read_document(const std::string& path) { return parse_json(read_file(path)); }

void write_file(const std::string& path, const std::string& bytes) {
  std::ofstream file;
  if (path != "-") file.open(path, std::ios::binary);
  std::ostream& out = path == "-" ? std::cout : file;
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.flush();
  if (!out) throw CommandError(exit_failed, "cannot write " + path);
}

Engine command_engine(const std::string& device) {
  return Engine({.device = device,
                 .kernels = EngineOptions::kernels_for_many_scenes,
                 .profiles = cache_folder("profiles")});
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : presets()) names.push_back(preset.name);
  return names;
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const MethodDescription& method : methods()) names.push_back(method.name);
  return names;
}

std::vector<std::string> format_names() {
  std::vector<std::string> names;
  for (const Encoding& each : encodings()) names.emplace_back(each.name);
  return names;
}

Watch command_watch() {
  // As the first process of a container, it would not be stopped by what it does not take.
  for (const int number : {SIGINT, SIGTERM})
    std::signal(number, [](int) { interrupted = true; });
  Watch watch;
  watch.gone = [] { return interrupted.load(); };
  watch.progress = [](double share) { show_progress(share); };
  return watch;
}

void show_progress(double share, const std::string& note) {
  if (!isatty(STDERR_FILENO)) return;
  constexpr int width = 40;
  const int filled = static_cast<int>(share * width);
  const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                          std::string(static_cast<std::size_t>(width - filled), '.');
  std::fprintf(stderr, "\r[%s] %3.0f %% %s\033[K", bar.c_str(), share * 100, note.c_str());
}

void end_progress() {
  if (isatty(STDERR_FILENO)) std::fputs("\r\033[K", stderr);
}

}  // namespace cyanometer
