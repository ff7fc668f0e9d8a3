#include "server/routes/sequence.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/scene/document.h"
#include "server/routes/frame.h"
#include "server/routes/reading.h"

namespace cyanometer {
namespace {

using nlohmann::json;

/// `multipart/x-mixed-replace` says nothing of the format of the parts.
json with_format(json document, const Request& request) {
  const bool of_streams =
      request.header("accept").find("multipart/x-mixed-replace") != std::string::npos;
  return of_streams ? document : negotiate_format(std::move(document), request);
}

/// Reads every scene once, so that what is wrong with the last is said before the first is
/// sent.
void check(const Sequence& sequence, const Config& config, const Watch& watch) {
  for (int i = 0; i < sequence.count; ++i) {
    watch.check();
    sequence.within(i, [&] { check_frame(sequence.scene(i).scene, config); });
  }
}

void check_count(const std::string& pointer, double count, const Config& config) {
  if (count <= config.max_frames) return;
  throw OverLimit(pointer, shortest(count) + " frames are more than the " +
                               std::to_string(config.max_frames) + " of this server");
}

// ---- Refinement

/// The scene by ever more random walks, or within ever smaller errors.
std::vector<Scene> coarser(const Scene& scene) {
  std::vector<Scene> stages;
  const auto walks = scene.method.options.find("samples_per_pixel");
  if (walks != scene.method.options.end()) {
    for (const double part : {64, 16, 4}) {
      if (walks->second < part) continue;
      stages.push_back(scene);
      stages.back().method.options.at("samples_per_pixel") = std::floor(walks->second / part);
    }
    return stages;
  }
  for (const double error : {0.3, 0.1, 0.03}) {
    Scene& stage = stages.emplace_back(scene);
    stage.method = {};
    stage.method.max_error = error;
    stage.method.scattering_orders = scene.method.scattering_orders;
  }
  return stages;
}

/// @param at  pointer to the scene in the request
Sequence refinement(const json& document, const std::string& at) {
  Scene aim;
  within(at, [&] { aim = read_scene(document); });
  std::vector<Scene> stages = coarser(aim);
  stages.push_back(aim);
  Sequence sequence;
  sequence.count = static_cast<int>(stages.size());
  sequence.refines = true;
  sequence.scene = [stages = std::move(stages)](int i) {
    return scene_request(stages.at(static_cast<std::size_t>(i)));
  };
  sequence.within = [at](int, const auto& work) { within(at, work); };
  return sequence;
}

// ---- Links

struct Link {
  Fields scene;
  std::optional<std::string> frames, refine;
  SweepEnds ends;
};

void set_once(std::optional<std::string>& to, const std::string& name,
              const std::string& value) {
  if (to) refuse("/" + name, value, "given once");
  to = value;
}

/// JSON where it parses, else the text.
json value_of(const std::string& text) {
  json value = json::parse(text, nullptr, false);
  return value.is_discarded() ? json(text) : value;
}

Link read_link(const Fields& query) {
  Link link;
  for (const auto& [path, value] : query) {
    if (path == "frames") {
      set_once(link.frames, path, value);
    } else if (path == "refine") {
      set_once(link.refine, path, value);
    } else if (path.starts_with("to.")) {
      const std::string name = path.substr(3);
      for (const auto& [other, end] : link.ends) {
        if (other == name) refuse("/" + path, value, "given once");
      }
      link.ends.emplace_back(name, value_of(value));
    } else {
      link.scene.emplace_back(path, value);
    }
  }
  return link;
}

// ---- Frames

Sequence patched(const json& scene, const FramePatches& patches, const Config& config) {
  check_count("/frames", patches.count, config);
  return {
      patches.count,
      [scene, patches](int i) { return scene_request(read_scene(scene, patches.patch(i))); },
      patches.within};
}

}  // namespace

Sequence sequence_of_link(const Request& request, const Config& config, const Watch& watch) {
  const Link link = read_link(request.query);
  if (link.refine && *link.refine != "true") refuse("/refine", *link.refine, "true");
  if (link.refine.has_value() == link.frames.has_value()) {
    throw SceneError("", "", "refine=true, or frames=N with to.PATH=number",
                     "A stream is asked for by either refine=true or frames=N.");
  }
  if (link.refine && !link.ends.empty()) {
    refuse("/to." + link.ends.front().first, link.ends.front().second, "given with frames=N");
  }
  const json scene = with_format(document_from_query(link.scene), request);
  const Sequence sequence =
      link.refine
          ? refinement(scene, "")
          : patched(scene, read_sweep(scene, value_of(*link.frames), link.ends, "/to.", ""),
                    config);
  check(sequence, config, watch);
  return sequence;
}

Sequence sequence_of_body(const Request& request, const Config& config, const Watch& watch) {
  json document = body_document(request);
  check_members(document, "", {"scene", "frames", "to", "refine"});
  const json scene = with_format(document.value("scene", json::object()), request);
  if (!scene.is_object()) refuse("/scene", scene, "an object");
  const bool frames = document.contains("frames");
  if (frames == document.contains("refine")) {
    throw SceneError(
        "", "", "either frames or refine",
        "A stream has either /frames, merge patches or a number, or /refine, true.");
  }
  if (!frames) {
    check_members(document, "", {"scene", "refine"});
    if (document["refine"] != true) refuse("/refine", document["refine"], "true");
    const Sequence sequence = refinement(scene, "/scene");
    check(sequence, config, watch);
    return sequence;
  }
  within("/scene", [&] { check_frame(read_scene(scene), config); });
  document.erase("scene");
  const Sequence sequence =
      patched(scene, read_frame_patches(scene, document, "/scene"), config);
  check(sequence, config, watch);
  return sequence;
}

}  // namespace cyanometer
