// cyanometer render: a scene to a file, or a sequence of them to files, without a server.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "engine/image/encode.h"
#include "engine/scene/document.h"
#include "server/batch/batch.h"
#include "server/batch/file_pattern.h"
#include "server/batch/shard.h"
#include "server/commands/command.h"
#include "server/commands/image_file.h"
#include "server/routes/frame_patches.h"

namespace cyanometer {
namespace {

struct RenderArguments {
  std::string scene, output, device, frames, shard = "0/1";
  int workers = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, 31u)) + 1;
};

void render_one(const RenderArguments& arguments) {
  const Scene scene = scene_for_file(read_document(arguments.scene), arguments.output);
  const Watch watch = command_watch();
  Engine engine = command_engine(arguments.device);
  const Frame frame = engine.render(scene, watch);
  end_progress();
  write_file(arguments.output, encode(frame, scene));
}

/// What the arguments say in a form of their own.
template <class Read>
auto read_argument(const Read& read) {
  try {
    return read();
  } catch (const std::invalid_argument& error) {
    throw CommandError(exit_refused, error.what());
  }
}

std::string counts_of(const BatchProgress& progress) {
  return std::to_string(progress.there + progress.rendered) + " of " +
         std::to_string(progress.frames) + " frames";
}

/// The bar on a terminal; elsewhere, a line now and then for who reads the log.
std::function<void(const BatchProgress&)> progress_shower() {
  using Clock = std::chrono::steady_clock;
  return [said = Clock::now()](const BatchProgress& progress) mutable {
    show_progress(progress.share(), counts_of(progress));
    constexpr auto pause = std::chrono::seconds(30);
    if (isatty(STDERR_FILENO) || Clock::now() - said < pause) return;
    said = Clock::now();
    std::cerr << "cyanometer: " << counts_of(progress) << std::endl;
  };
}

Batch batch_of(const RenderArguments& arguments, const FilePattern& pattern,
               const Shard& shard) {
  const auto scene = document_for_file(read_document(arguments.scene), arguments.output);
  read_scene(scene);  // what is wrong with it is said of it, not of the first frame
  const auto patches = read_frame_patches(scene, read_document(arguments.frames), "");
  Batch batch;
  for (int i = 0; i < patches.count; ++i) {
    if (shard.holds(i)) batch.numbers.push_back(i);
  }
  batch.frame = [=](int number) {
    BatchFrame frame{number, pattern.file(number), patches.patch(number), {}};
    patches.within(number, [&] {
      frame.asked = scene_request(read_scene(scene, frame.patch));
      check_file(frame.asked.scene, frame.file.string());
    });
    return frame;
  };
  batch.device = arguments.device;
  batch.workers = arguments.workers;
  batch.show = progress_shower();
  return batch;
}

void render_sequence(const RenderArguments& arguments) {
  const auto shard = read_argument([&] { return read_shard(arguments.shard); });
  const auto pattern = read_argument([&] { return FilePattern(arguments.output); });
  const Batch batch = batch_of(arguments, pattern, shard);
  const auto folder = std::filesystem::path(arguments.output).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder);
  Manifest manifest(pattern.manifest_stem(), shard.suffix());
  const BatchProgress done = run_batch(batch, manifest, command_watch());
  end_progress();
  std::cerr << "cyanometer: " << counts_of(done) << ", " << done.rendered << " rendered, "
            << done.there << " were there; " << manifest.path().string() << "\n";
}

void render(const RenderArguments& arguments) {
  if (arguments.frames.empty()) {
    render_one(arguments);
  } else {
    render_sequence(arguments);
  }
}

}  // namespace

void add_render(CLI::App& app) {
  auto* command =
      app.add_subcommand("render", "Render a scene to a file, or a sequence to files");
  const auto arguments = std::make_shared<RenderArguments>();
  command->add_option("scene", arguments->scene, "Scene document; - is standard input")
      ->required();
  command
      ->add_option("-o,--output", arguments->output,
                   "Image file; - is standard output. With --frames a name with the frame's "
                   "number from 0, as sky-%05d.exr; what an earlier run left is not made again")
      ->required();
  auto* frames = command->add_option(
      "--frames", arguments->frames,
      "Sequence document: {\"frames\": [merge patch, ...]}, or {\"frames\": 120, \"to\": "
      "{\"sun.elevation_deg\": -6}} for numbers that go linearly from the scene's");
  command
      ->add_option("--shard", arguments->shard,
                   "I/N: of the sequence, every N-th frame from frame I on; /N: I is in "
                   "JOB_COMPLETION_INDEX")
      ->needs(frames)
      ->capture_default_str();
  command
      ->add_option("--workers", arguments->workers,
                   "Frames at once: one on the device, the others being encoded and written")
      ->needs(frames)
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->add_option("--device", arguments->device, "Part of the Vulkan device's name");
  command->footer(
      "A sequence leaves sky-manifest.jsonl beside its files: camera, sun, method and error of "
      "each frame,\na line of JSON each; a shard one of its own, as "
      "sky-manifest.3-of-16.jsonl. "
      "A run that was stopped\ngoes on. Put another scene's frames into another folder.\n"
      "Example: echo '{\"preset\":\"mars\"}' | cyanometer render - -o mars.exr\n"
      "         cyanometer render scene.json --frames sunset.json -o frames/sky-%05d.exr");
  command->callback([arguments] { render(*arguments); });
}

}  // namespace cyanometer
