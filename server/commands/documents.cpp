// cyanometer radiance, plan, schema: the routes of those names on the command line.
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/scene/document.h"
#include "server/commands/command.h"
#include "server/routes/answers.h"

namespace cyanometer {
namespace {

struct DocumentsArguments {
  std::string document, device;
};

void print(const nlohmann::json& document) { write_file("-", document.dump(2) + "\n"); }

void radiance(const DocumentsArguments& arguments) {
  const auto asked = read_radiance_request(read_document(arguments.document));
  const Watch watch = command_watch();
  Engine engine = command_engine(arguments.device);
  const auto radiances =
      engine.radiance(asked.scene, asked.directions, asked.irradiance, watch);
  end_progress();
  print(radiance_document(asked.scene, radiances));
}

void plan(const DocumentsArguments& arguments) {
  const Scene scene = read_scene(read_document(arguments.document));
  Engine engine = command_engine(arguments.device);
  print(plan_document(scene, engine.plan(scene, command_watch())));
}

CLI::App* add(CLI::App& app, const std::string& name, const std::string& what,
              const std::string& file, void (*run)(const DocumentsArguments&)) {
  auto* command = app.add_subcommand(name, what);
  const auto arguments = std::make_shared<DocumentsArguments>();
  command->add_option("file", arguments->document, file + "; - is standard input")->required();
  command->add_option("--device", arguments->device, "Part of the Vulkan device's name");
  command->callback([arguments, run] { run(*arguments); });
  return command;
}

}  // namespace

void add_radiance(CLI::App& app) {
  add(app, "radiance", "Spectral radiance in directions", "Document as of POST /v1/radiance",
      radiance)
      ->footer(
          "Example: echo '{\"directions\":[{\"elevation_deg\":90,\"azimuth_deg\":0}]}' | "
          "cyanometer radiance -");
}

void add_plan(CLI::App& app) {
  add(app, "plan", "What would be done for a scene", "Scene document", plan)
      ->footer("Example: echo '{\"preset\":\"mars\"}' | cyanometer plan -");
}

void add_schema(CLI::App& app) {
  auto* command = app.add_subcommand("schema", "Print the JSON Schema of the scene document");
  command->footer("Example: cyanometer schema > scene.schema.json");
  command->callback([] { print(scene_schema()); });
}

}  // namespace cyanometer
