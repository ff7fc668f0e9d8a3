#include "server/routes/frame_patches.h"

#include <nlohmann/json.hpp>

#include "engine/scene/document.h"
#include "server/routes/frame.h"
#include "server/routes/reading.h"

namespace cyanometer {
namespace {

using nlohmann::json;

using Path = std::vector<std::string>;

struct Sweep {
  Path path;
  double from = 0, to = 0;

  /// A whole number is one in the document too.
  json at(double t) const { return json::parse(shortest(from + (to - from) * t)); }
};

Path split(const std::string& dotted) {
  Path parts{""};
  for (const char c : dotted) {
    if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

/// Null where there is none; a list's entries are no members.
json member(const json& document, const Path& path) {
  const json* at = &document;
  for (const auto& name : path) {
    if (!at->is_object() || !at->contains(name)) return nullptr;
    at = &(*at)[name];
  }
  return *at;
}

/// @param document  of the scene where the sweep begins
Sweep sweep_to(const std::string& dotted, const json& to, const std::string& at,
               const json& document) {
  if (!to.is_number()) refuse(at, to, "a number");
  const Path path = split(dotted);
  const json from = member(document, path);
  if (!from.is_number()) {
    throw SceneError(at, "", "a member that is a number in the scene",
                     at.substr(1) + " goes to a number from what is none in the scene.");
  }
  return {path, from.get<double>(), to.get<double>()};
}

json patch_at(const std::vector<Sweep>& sweeps, double t) {
  json patch = json::object();
  for (const auto& sweep : sweeps) {
    json* place = &patch;
    for (const auto& name : sweep.path) place = &(*place)[name];
    *place = sweep.at(t);
  }
  return patch;
}

int read_count(const json& count) {
  constexpr double most = 1e9;
  const bool whole = count.is_number_integer();
  if (!whole || count.get<double>() < 1 || count.get<double>() > most) {
    refuse("/frames", count, "a whole number from 1");
  }
  return count.get<int>();
}

FramePatches listed(const json& patches) {
  if (patches.empty()) refuse("/frames", patches, "a list of merge patches");
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (patches[i].is_object()) continue;
    refuse("/frames/" + std::to_string(i), patches[i], "a merge patch, an object");
  }
  return {static_cast<int>(patches.size()),
          [patches](int i) { return patches[static_cast<std::size_t>(i)]; }, true};
}

}  // namespace

FramePatches read_sweep(const json& scene, const json& count, const SweepEnds& ends,
                        const std::string& at) {
  const int frames = read_count(count);
  if (ends.empty()) {
    throw SceneError("/to", "", "numbers by dotted path",
                     "A number of frames wants at least one path in `to`: what changes.");
  }
  const json start = canonical(read_scene(scene));
  std::vector<Sweep> sweeps;
  for (const auto& [path, to] : ends) {
    sweeps.push_back(sweep_to(path, to, at + path, start));
  }
  // Ranges have no gaps, so a scene out of range shows at the end, with the number that was
  // given.
  read_scene(merge(scene, patch_at(sweeps, 1)));
  return {frames, [sweeps, frames](int i) {
            return patch_at(sweeps, frames == 1 ? 0 : static_cast<double>(i) / (frames - 1));
          }};
}

FramePatches read_frame_patches(const json& scene, const json& sequence) {
  check_members(sequence, "", {"frames", "to"});
  if (!sequence.contains("frames")) miss("/frames", "a list of merge patches, or a number");
  const json& frames = sequence["frames"];
  const auto to = sequence.find("to");
  if (frames.is_array()) {
    if (to != sequence.end()) refuse("/to", *to, "given with a number of frames");
    return listed(frames);
  }
  if (!frames.is_number()) refuse("/frames", frames, "a list of merge patches, or a number");
  SweepEnds ends;
  if (to != sequence.end()) {
    if (!to->is_object()) refuse("/to", *to, "an object of numbers by dotted path");
    for (const auto& [path, end] : to->items()) ends.emplace_back(path, end);
  }
  return read_sweep(scene, frames, ends, "/to/");
}

}  // namespace cyanometer
