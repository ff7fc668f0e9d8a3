// cyanometer compare: two scenes, or a picture and a scene, against each other.
#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/accuracy/comparison.h"
#include "engine/accuracy/error_picture.h"
#include "engine/accuracy/judgement.h"
#include "engine/scene/document.h"
#include "server/commands/command.h"
#include "server/routes/answers.h"

namespace cyanometer {
namespace {

struct CompareArguments {
  std::string a, b, output, device;
};

void print(const Comparison& comparison) {
  end_progress();
  write_file("-", comparison_document(comparison).dump(2) + "\n");
}

void paint(const CompareArguments& arguments, const std::vector<float>& map,
           const Image& image) {
  end_progress();
  write_file(arguments.output, error_picture(map, image.width, image.height));
}

void compare_scenes(const CompareArguments& arguments, const std::string& a) {
  const auto asked =
      read_compare_request({{"a", parse_json(a)}, {"b", read_document(arguments.b)}});
  const Watch watch = command_watch();
  Engine engine = command_engine(arguments.device);
  const FramePair frames = render_pair(engine, asked, watch);
  print(compare(frames, watch));
  if (!arguments.output.empty()) paint(arguments, error_map(frames), asked.b.image);
}

void judge_picture(const CompareArguments& arguments, const std::string& bytes) {
  const Scene scene = read_scene(read_document(arguments.b));
  const Watch watch = command_watch();
  ExrImage image;
  try {
    image = read_frame(bytes, scene);
  } catch (const ImageError& error) {
    throw CommandError(exit_refused, arguments.a + ": " + error.what());
  }
  Engine engine = command_engine(arguments.device);
  print(judge(engine, scene, image, {}, watch));
  if (!arguments.output.empty()) {
    paint(arguments, judged_map(engine, scene, image, watch), scene.image);
  }
}

void compare_files(const CompareArguments& arguments) {
  const std::string bytes = read_file(arguments.a);
  is_exr(bytes) ? judge_picture(arguments, bytes) : compare_scenes(arguments, bytes);
}

}  // namespace

void add_compare(CLI::App& app) {
  auto* command =
      app.add_subcommand("compare", "How much two scenes, or a picture and a scene, differ");
  const auto arguments = std::make_shared<CompareArguments>();
  command
      ->add_option("a", arguments->a,
                   "Scene document, or an EXR to judge against the converged solution; - is "
                   "standard input")
      ->required();
  command->add_option("b", arguments->b, "Scene document that it is held against")->required();
  command->add_option("-o,--output", arguments->output, "PNG of the error by pixel");
  command->add_option("--device", arguments->device, "Part of the Vulkan device's name");
  command->footer("Example: cyanometer compare fast.json exact.json -o error.png");
  command->callback([arguments] { compare_files(*arguments); });
}

}  // namespace cyanometer
