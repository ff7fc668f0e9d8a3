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
void check(const Sequence& sequence, const Config& config, const Watch& watch,
           const std::function<std::string(int)>& pointer_of) {
  for (int i = 0; i < sequence.count; ++i) {
    watch.check();
    within(pointer_of(i), [&] { check_frame(sequence.scene(i).scene, config); });
  }
}

void check_count(const std::string& pointer, double count, const Config& config) {
  if (count <= config.max_frames) return;
  throw OverLimit(pointer, shortest(count) + " frames are more than the " +
                               std::to_string(config.max_frames) + " of this server");
}

// ---- Refinement
// -------------------------------------------------------------------------------

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

Sequence refinement(const json& document) {
  const Scene aim = scene_request(document).scene;
  std::vector<Scene> stages = coarser(aim);
  stages.push_back(aim);
  Sequence sequence;
  sequence.count = static_cast<int>(stages.size());
  sequence.refines = true;
  sequence.scene = [stages = std::move(stages)](int i) {
    const Scene& scene = stages.at(static_cast<std::size_t>(i));
    return SceneRequest{scene, canonical(scene).dump()};
  };
  return sequence;
}

// ---- Links
// ------------------------------------------------------------------------------------

struct Sweep {
  std::string path;  ///< dotted
  double from = 0, to = 0;
};

json pointer_value(const json& document, const std::string& path) {
  std::string pointer;
  for (const char c : path) {
    pointer += c == '.' ? "/" : c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  }
  const json::json_pointer place("/" + pointer);
  return document.contains(place) ? document.at(place) : json();
}

/// @param document  of the scene where the sweep begins
Sweep read_sweep(const std::string& path, const std::string& text, const json& document) {
  const std::string name = "to." + path;
  const json to = json::parse(text, nullptr, false);
  if (!to.is_number()) refuse("/" + name, text, "a number");
  const json from = pointer_value(document, path);
  if (!from.is_number()) {
    throw SceneError("/" + name, "", "a member that is a number in the scene",
                     name + " goes to a number from what is none in the scene.");
  }
  return {path, from.get<double>(), to.get<double>()};
}

struct Link {
  Fields scene;
  std::optional<std::string> frames, refine;
  Fields sweeps;  ///< without "to."
};

void set_once(std::optional<std::string>& to, const std::string& name,
              const std::string& value) {
  if (to) refuse("/" + name, value, "given once");
  to = value;
}

Link read_link(const Fields& query) {
  Link link;
  for (const auto& [path, value] : query) {
    if (path == "frames") {
      set_once(link.frames, path, value);
    } else if (path == "refine") {
      set_once(link.refine, path, value);
    } else if (path.starts_with("to.")) {
      link.sweeps.emplace_back(path.substr(3), value);
    } else {
      link.scene.emplace_back(path, value);
    }
  }
  return link;
}

int read_count(const std::string& text, const Config& config) {
  const json count = json::parse(text, nullptr, false);
  if (!count.is_number_integer() || count.get<double>() < 1) {
    refuse("/frames", text, "a whole number from 1");
  }
  check_count("/frames", count.get<double>(), config);
  return count.get<int>();
}

/// The scene's link with the swept members set.
Fields link_at(Fields scene, const std::vector<Sweep>& sweeps, double t) {
  for (const auto& [path, from, to] : sweeps) {
    std::erase_if(scene, [&](const auto& field) { return field.first == path; });
    scene.emplace_back(path, shortest(from + (to - from) * t));
  }
  return scene;
}

Sequence swept(const Link& link, const Request& request, const Config& config) {
  Sequence sequence;
  sequence.count = read_count(*link.frames, config);
  if (link.sweeps.empty()) {
    throw SceneError("/to", "", "to.PATH=number",
                     "frames wants at least one to.PATH=number: what changes between them.");
  }
  const json start = canonical(read_scene(document_from_query(link.scene)));
  std::vector<Sweep> sweeps;
  for (const auto& [path, value] : link.sweeps) {
    for (const auto& other : sweeps) {
      if (other.path == path) refuse("/to." + path, value, "given once");
    }
    sweeps.push_back(read_sweep(path, value, start));
  }
  // Ranges have no gaps, so a scene out of range shows at the end, with the number that was
  // given.
  read_scene(document_from_query(link_at(link.scene, sweeps, 1)));
  const int count = sequence.count;
  sequence.scene = [link, sweeps, request, count](int i) {
    const double t = count == 1 ? 0 : static_cast<double>(i) / (count - 1);
    return scene_request(
        with_format(document_from_query(link_at(link.scene, sweeps, t)), request));
  };
  return sequence;
}

}  // namespace

Sequence sequence_of_link(const Request& request, const Config& config, const Watch& watch) {
  const Link link = read_link(request.query);
  if (link.refine && *link.refine != "true") refuse("/refine", *link.refine, "true");
  if (link.refine.has_value() == link.frames.has_value()) {
    throw SceneError("", "", "refine=true, or frames=N with to.PATH=number",
                     "A stream is asked for by either refine=true or frames=N.");
  }
  if (link.refine && !link.sweeps.empty()) {
    refuse("/to." + link.sweeps.front().first, link.sweeps.front().second,
           "given with frames=N");
  }
  const Sequence sequence =
      link.refine ? refinement(with_format(document_from_query(link.scene), request))
                  : swept(link, request, config);
  check(sequence, config, watch, [](int) { return ""; });
  return sequence;
}

Sequence sequence_of_body(const Request& request, const Config& config, const Watch& watch) {
  const json document = body_document(request);
  check_members(document, "", {"scene", "frames", "refine"});
  const json scene = with_format(document.value("scene", json::object()), request);
  if (!scene.is_object()) refuse("/scene", scene, "an object");
  const bool frames = document.contains("frames");
  if (frames == document.contains("refine")) {
    throw SceneError("", "", "either frames or refine",
                     "A stream has either /frames, a list of merge patches, or /refine, true.");
  }
  if (!frames) {
    if (document["refine"] != true) refuse("/refine", document["refine"], "true");
    Sequence sequence;
    within("/scene", [&] { sequence = refinement(scene); });
    check(sequence, config, watch, [](int) { return "/scene"; });
    return sequence;
  }
  const json& patches = document["frames"];
  if (!patches.is_array() || patches.empty()) {
    refuse("/frames", patches, "a list of merge patches");
  }
  check_count("/frames", static_cast<double>(patches.size()), config);
  within("/scene", [&] { check_frame(read_scene(scene), config); });
  const auto pointer_of = [](int i) { return "/frames/" + std::to_string(i); };
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (!patches[i].is_object()) {
      refuse(pointer_of(static_cast<int>(i)), patches[i], "a merge patch, an object");
    }
  }
  Sequence sequence;
  sequence.count = static_cast<int>(patches.size());
  sequence.scene = [scene, patches](int i) {
    return scene_request(merge(scene, patches[static_cast<std::size_t>(i)]));
  };
  check(sequence, config, watch, pointer_of);
  return sequence;
}

}  // namespace cyanometer
