// The frames of a sequence as files: rendered one after the other on the device while those
// before are encoded and written, and not again where they are there already.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "server/batch/manifest.h"
#include "server/routes/scene_request.h"

namespace cyanometer {

struct BatchFrame {
  int number = 0;
  std::filesystem::path file;
  nlohmann::json patch;  ///< what is the frame's own
  SceneRequest asked;
};

struct BatchProgress {
  std::size_t frames = 0, there = 0, rendered = 0;
  double running = 0;  ///< share of the frame on the device that is done

  double share() const;
};

struct Batch {
  std::vector<int> numbers;
  /// May be called from any thread. @throws SceneError
  std::function<BatchFrame(int number)> frame;
  std::string device;
  int workers = 1;  ///< frames that are made at once, one of them on the device
  std::function<void(const BatchProgress&)> show = [](const BatchProgress&) {};
};

/// Reads every scene before the first is rendered.
/// @throws SceneError, Cancelled, std::runtime_error; the frames made until then are kept
BatchProgress run_batch(const Batch& batch, Manifest& manifest, const Watch& watch);

}  // namespace cyanometer
