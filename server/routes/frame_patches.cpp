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
  std::string pointer;  ///< to where it goes
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

/// @param start  the canonical scene where the sweep begins, whose document has what is not
///               written there: the sun's place
Sweep sweep_to(const std::string& dotted, const json& to, const std::string& at,
               const json& start, const json& document) {
  if (!to.is_number()) refuse(at, to, "a number");
  const Path path = split(dotted);
  json from = member(start, path);
  if (!from.is_number()) from = member(document, path);
  if (!from.is_number()) {
    throw SceneError(at, "", "a member that is a number in the scene",
                     at.substr(1) + " goes to a number from what is none in the scene.");
  }
  return {at, path, from.get<double>(), to.get<double>()};
}

json patch_at(const std::vector<Sweep>& sweeps, double t, json patch = json::object()) {
  for (const auto& sweep : sweeps) {
    json* place = &patch;
    for (const auto& name : sweep.path) place = &(*place)[name];
    *place = sweep.at(t);
  }
  return patch;
}

/// The merge patch that makes the one of the other.
json patch_between(const json& from, const json& to) {
  if (!from.is_object() || !to.is_object()) return to;
  json patch = json::object();
  for (const auto& [name, value] : to.items()) {
    if (!from.contains(name)) {
      patch[name] = value;
    } else if (from[name] != value) {
      patch[name] = patch_between(from[name], value);
    }
  }
  for (const auto& [name, value] : from.items()) {
    if (!to.contains(name)) patch[name] = nullptr;
  }
  return patch;
}

/// What the numbers take away when they are set, and what follows from that: an angle of a sun
/// that stands by its place takes the other angle and the camera's foot point.
json taken_away(const json& scene, const json& start, const std::vector<Sweep>& sweeps) {
  return patch_between(canonical(read_scene(scene, patch_at(sweeps, 0))), start);
}

std::string pointer_to(const Path& path) {
  std::string pointer;
  for (const auto& name : path) pointer += "/" + name;
  return pointer;
}

/// The sweep that leads to what was refused: of its own member, or of one around or within it;
/// else the first.
const Sweep& cause(const std::vector<Sweep>& sweeps, const std::string& refused) {
  for (const auto& sweep : sweeps) {
    const std::string own = pointer_to(sweep.path) + "/", other = refused + "/";
    if (own.starts_with(other) || other.starts_with(own)) return sweep;
  }
  return sweeps.front();
}

void within_sweeps(const std::vector<Sweep>& sweeps, const std::function<void()>& work) {
  try {
    work();
  } catch (const SceneError& error) {
    const std::string& at = cause(sweeps, error.pointer).pointer;
    throw SceneError(at, error.given, error.allowed,
                     at + " leads to a scene that is refused: " + error.what());
  } catch (const OverLimit& limit) {
    const std::string& at = cause(sweeps, limit.pointer).pointer;
    throw OverLimit(at, at + " leads over a limit: " + limit.what());
  }
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
          [patches](int i) { return patches[static_cast<std::size_t>(i)]; },
          [](int i, const auto& work) { within("/frames/" + std::to_string(i), work); }};
}

}  // namespace

FramePatches read_sweep(const json& scene, const json& count, const SweepEnds& ends,
                        const std::string& at, const std::string& scene_at) {
  const int frames = read_count(count);
  if (ends.empty()) {
    throw SceneError("/to", "", "numbers by dotted path",
                     "A number of frames wants at least one path in `to`: what changes.");
  }
  const json start = canonical(read_scene(scene));
  std::vector<Sweep> sweeps;
  for (const auto& [path, to] : ends) {
    sweeps.push_back(sweep_to(path, to, at + path, start, scene));
  }
  json kept;
  within_sweeps(sweeps, [&] {
    kept = taken_away(scene, start, sweeps);
    // Ranges have no gaps, so a scene out of range shows at the end, with the number that was
    // given.
    read_scene(scene, patch_at(sweeps, 1, kept));
  });
  return {frames,
          [sweeps, kept, frames](int i) {
            const double t = frames == 1 ? 0 : static_cast<double>(i) / (frames - 1);
            return patch_at(sweeps, t, kept);
          },
          [sweeps, scene_at](int i, const auto& work) {
            i == 0 ? within(scene_at, work) : within_sweeps(sweeps, work);
          }};
}

FramePatches read_frame_patches(const json& scene, const json& sequence,
                                const std::string& scene_at) {
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
  return read_sweep(scene, frames, ends, "/to/", scene_at);
}

}  // namespace cyanometer
