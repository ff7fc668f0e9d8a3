#include "engine/accuracy/reference.h"

#include <unistd.h>
#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "engine/accuracy/error.h"
#include "engine/accuracy/finest.h"
#include "engine/fingerprint.h"
#include "engine/scene/document.h"
#include "engine/surface/surface_pass.h"

namespace cyanometer {
namespace {

using nlohmann::json;
using Samples = std::vector<std::vector<double>>;

/// Beyond all that `path` can be asked for: a method that shares its random numbers with what
/// it is held against looks better than it is.
constexpr double first_seed = 0x1p31;

/// The scene without what its radiances do not depend on.
Scene undressed(const Scene& scene) {
  Scene plain = scene;
  MethodChoice method;
  method.name = "path";
  method.scattering_orders = scene.method.scattering_orders;
  plain.method = method;
  Image image;
  image.width = scene.image.width;
  image.height = scene.image.height;
  plain.image = image;
  return plain;
}

json identity_of(const Scene& scene, const std::vector<Direction>& directions) {
  json rays = json::array();
  for (const Direction& ray : directions) rays.push_back({ray.elevation_deg, ray.azimuth_deg});
  json identity = {{"scene", canonical(undressed(scene))},
                   {"rays", fingerprint(rays.dump())},
                   {"unit", "1/sr"},
                   {"first_seed", first_seed},
                   {"version", version()}};
  if (std::string ground = ground_revision(scene); !ground.empty()) identity["ground"] = ground;
  return identity;
}

/// Whether the halves have the shape that the rest relies on.
bool complete(const Reference& reference, std::size_t rays, std::size_t wavelengths) {
  auto whole = [&](const Samples& half) {
    return half.size() == rays && std::ranges::all_of(half, [&](const auto& ray) {
             return ray.size() == wavelengths;
           });
  };
  return reference.walks > 0 && whole(reference.halves[0]) && whole(reference.halves[1]);
}

/// What is kept, or nothing where there is none, or one that cannot be read.
void load(const std::filesystem::path& file, const json& identity, std::size_t wavelengths,
          Reference& reference) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return;
  json kept = json::parse(in, nullptr, false);
  if (!kept.is_object() || kept.value("identity", json()) != identity) return;
  Reference found = reference;
  try {
    found.walks = kept.at("walks");
    found.halves = kept.at("halves");
  } catch (const json::exception&) {
    return;
  }
  if (complete(found, reference.directions.size(), wavelengths)) reference = found;
}

/// By a file beside it, so that nobody reads half of one.
void save(const std::filesystem::path& file, const json& identity, const Reference& reference) {
  std::filesystem::create_directories(file.parent_path());
  std::filesystem::path unfinished = file;
  unfinished += "." + std::to_string(::getpid()) + ".new";  // others may make the same
  std::ofstream out(unfinished, std::ios::binary);
  out << json{{"identity", identity}, {"walks", reference.walks}, {"halves", reference.halves}};
  out.close();
  if (!out) throw std::runtime_error("cannot write " + unfinished.string());
  std::filesystem::rename(unfinished, file);
}

/// Adds `walks` to each half; the seed has not been used before.
void add_walks(Engine& engine, const Scene& scene, std::int64_t walks, const Watch& watch,
               Reference& reference) {
  for (std::size_t half : {0, 1}) {
    Plan plan;
    plan.method = "path";
    plan.wavelengths_nm = scene.spectrum.wavelengths_nm;
    plan.options = {{"samples_per_pixel", static_cast<double>(walks)},
                    // Every pass but the first doubles what is there: its size is its own.
                    {"seed", first_seed + static_cast<double>(2 * reference.walks + half)}};
    Samples more = engine.radiance(scene, reference.directions, false, plan, watch).relative;
    Samples& sum = reference.halves[half];
    if (reference.walks == 0) {
      sum = std::move(more);
      continue;
    }
    double share = static_cast<double>(walks) / static_cast<double>(reference.walks + walks);
    for (std::size_t i = 0; i < sum.size(); ++i) {
      for (std::size_t w = 0; w < sum[i].size(); ++w)
        sum[i][w] += share * (more[i][w] - sum[i][w]);
    }
  }
  reference.walks += walks;
}

}  // namespace

json goal_document(const ReferenceGoal& goal) {
  return {{"rays", goal.rays}, {"noise", goal.noise}, {"most_walks", goal.most_walks}};
}

Reference make_reference(Engine& engine, const Scene& scene, const ReferenceGoal& goal,
                         const std::filesystem::path& folder, const Watch& watch) {
  return make_reference(engine, scene, sample_directions(scene, goal.rays), goal, folder,
                        watch);
}

Reference make_reference(Engine& engine, const Scene& scene,
                         const std::vector<Direction>& directions, const ReferenceGoal& goal,
                         const std::filesystem::path& folder, const Watch& watch) {
  constexpr std::int64_t first_walks = 256;
  json identity = identity_of(scene, directions);
  std::filesystem::path file =
      folder.empty() ? "" : folder / (fingerprint(identity.dump()) + ".json");
  Reference reference;
  reference.directions = directions;
  if (!file.empty()) load(file, identity, scene.spectrum.wavelengths_nm.size(), reference);
  bool random = scene.method.scattering_orders.value_or(2) > 1;
  const RayColours colours(scene, scene.spectrum.wavelengths_nm);
  auto noisy = [&] {
    // The mean's error is half of the halves' difference.
    reference.noise = measure_error(colours.error_channels(reference.halves[0]),
                                    colours.error_channels(reference.halves[1]))
                          .error /
                      2;
    return random && reference.noise > goal.noise && reference.walks < goal.most_walks;
  };
  while (reference.walks == 0 || noisy()) {
    add_walks(engine, scene, std::max(reference.walks, first_walks), watch, reference);
    if (!file.empty()) save(file, identity, reference);
  }
  return reference;
}

}  // namespace cyanometer
