#include "engine/methods/path/path.h"

#include <algorithm>
#include <cmath>

#include "engine/methods/path/guide.h"
#include "engine/methods/path/light_guide.h"
#include "engine/methods/raymarch/raymarch.h"
#include "engine/methods/scratch.h"
#include "spirv/path.spv.h"
#include "spirv/path_finish.spv.h"

namespace cyanometer {
namespace {

struct PathPush {
  std::int32_t first_ray, rays_in_tile, slices, walks_of_ray, orders, steps;
  std::uint32_t seed, fresh;
};

/// Gauss nodes of the first order on each smooth piece of a ray. Its error is bounded by that
/// of half as many nodes (path_finish.comp).
constexpr double first_order_nodes = 24;

/// Segments of each half of a ray that a step looks at.
constexpr int segments = 8;

/// A ray's walks are shared out among so many lanes, whose sums are independent results. A
/// function of the number of walks alone: the result does not depend on the device.
int slices_for(int walks) { return std::min(walks, walks < 1024 ? 16 : 64); }

/// On the device.
struct Guide : Tables {
  explicit Guide(vulkan::Device& device, const std::vector<float>& values)
      : buffer(device, values.size() * sizeof(float), vulkan::Memory::device) {
    buffer.write(0, std::as_bytes(std::span(values)));
  }
  std::size_t bytes() const override { return buffer.size(); }

  vulkan::Buffer buffer;
};

std::shared_ptr<const Guide> guide_of(Tracer& tracer, const UploadedScene& scene, bool guided) {
  auto make = [&] {
    Physics<double> physics = pack<double>(scene.problem());
    set_path_guide(physics, scene.problem());
    const std::vector<double>& values = physics.path_guide;
    return std::make_shared<const Guide>(tracer.device,
                                         std::vector<float>(values.begin(), values.end()));
  };
  return tracer.tables.get<Guide>((guided ? "path, light " : "path ") + scene.air_key(), make);
}

class PathTracing final : public Method {
 public:
  explicit PathTracing(vulkan::Device& device)
      : first_order_(make_raymarch(device)),
        walk_(device, path_spirv, UploadedScene::bindings + 6, sizeof(PathPush)),
        finish_(device, path_finish_spirv, UploadedScene::bindings + 3, sizeof(PathPush)) {}

  const MethodDescription& description() const override { return path_description(); }
  bool reflects() const override { return true; }

  double evaluations(const Problem& problem, const MethodOptions& options,
                     double rays) const override {
    // Fitted to the times of random scenes (`audit`).
    const double vertices = 3.4 + 1.8 * std::min(largest_depth(problem), 8.0);
    return 2 * first_order_->evaluations(problem, first_order(1), rays) +
           rays * walks_of(options) * vertices *
               static_cast<double>(cost_of_step(static_cast<int>(problem.media.size())));
  }

  int rays_at_once(const UploadedScene& scene, const MethodOptions& options,
                   const Pacer& pacer) const override {
    // Lanes enough to keep a device busy, few enough that a dispatch takes each of them some
    // steps on.
    constexpr std::int64_t fewest = 2048, most = 1 << 18, steps = 16;
    std::int64_t lanes =
        std::clamp(pacer.evaluations() / (steps * cost_of_step(scene.media())), fewest, most);
    int rays =
        static_cast<int>(std::max<std::int64_t>(lanes / slices_for(walks_of(options)), 64));
    return std::min(rays, first_order_->rays_at_once(scene, first_order(1), pacer));
  }

  void trace(Tracer& tracer, const UploadedScene& scene, const MethodOptions& options,
             const Tile& tile) override {
    int orders = scene.problem().scattering_orders;
    int walks = orders == 0 || orders == 1 ? 0 : walks_of(options);
    PathPush push{.first_ray = tile.first_ray,
                  .rays_in_tile = tile.rays,
                  .slices = std::max(slices_for(walks), 1),
                  .walks_of_ray = walks,
                  .orders = orders,
                  .steps = 0,
                  .seed = static_cast<std::uint32_t>(options.at("seed")),
                  .fresh = 1};
    Workspace work = workspace(tracer.device, scene, push);
    light_first_order(tracer, scene, tile, *work.coarse);
    if (walks > 0) walk(tracer, scene, push, work);
    tracer.commands.dispatch(finish_, scene.constants(),
                             scene.bind({tile.values, *work.sums, *work.coarse}),
                             vulkan::bytes_of(push), {vulkan::groups_for(tile.rays, 64)});
    tracer.submit();
  }

 private:
  static int walks_of(const MethodOptions& options) {
    return static_cast<int>(options.at("samples_per_pixel"));
  }
  static int lanes_of(const PathPush& push) { return push.rays_in_tile * push.slices; }

  /// Evaluations of densities in one step of a walk: its segments, the columns to the next
  /// vertex and to the sun, phases and random numbers.
  static std::int64_t cost_of_step(int media) {
    return std::int64_t{2 * segments + 32} * std::max(media, 1) + 16;
  }

  /// Rounds of all loops in one step, none unrolled. @throws OverLimit where they are too many
  static int loops_of_step(const UploadedScene& scene) {
    int densities = scene.density_iterations(), media = scene.media(), groups = scene.groups();
    int segment = 2 * densities + 2 * media + groups * (4 * media + 3);
    // Columns go through all nodes of a table, on the way down and on the way up.
    int columns = 2 * (8 * media + scene.profile_nodes() + 1);
    int phases = 4 * media * (groups + 12) + 6 * media * 8;
    int step = (2 * segments + Physics<float>::PARTS + 2) * segment + 2 * columns + phases +
               16 * groups + densities;
    if (step > most_loop_iterations) {
      throw OverLimit("/atmosphere/constituents",
                      "the tables of all profiles together have " +
                          std::to_string(scene.profile_nodes()) +
                          " nodes, more than a random walk can follow");
    }
    return step;
  }

  struct Workspace {
    Scratch::Loan walks, counts, sums, coarse, unfinished;
  };

  Workspace workspace(vulkan::Device& device, const UploadedScene& scene,
                      const PathPush& push) {
    std::size_t lanes = lanes_of(push), vec4 = 16, groups = scene.groups();
    return {walks_.take(device, lanes * vec4 * (4 + groups)),
            counts_.take(device, lanes * vec4), sums_.take(device, lanes * vec4 * 4 * groups),
            coarse_.take(device, push.rays_in_tile * vec4 * 2 * groups),
            unfinished_.take(device, sizeof(std::uint32_t))};
  }

  static MethodOptions first_order(double share) {
    return {{"view_nodes", share * first_order_nodes}};
  }

  /// Into the tile; that of half the nodes into `coarse`.
  void light_first_order(Tracer& tracer, const UploadedScene& scene, const Tile& tile,
                         const vulkan::Buffer& coarse) {
    std::size_t radiances = std::size_t{2} * scene.groups() * tile.rays * sizeof(glm::vec4);
    first_order_->trace(tracer, scene, first_order(0.5), tile);
    tracer.commands.copy({tile.values, 0, radiances}, {coarse, 0, radiances});
    first_order_->trace(tracer, scene, first_order(1), tile);
  }

  void walk(Tracer& tracer, const UploadedScene& scene, PathPush push, const Workspace& work) {
    bool guided = needs_light_guide(scene.problem());
    std::shared_ptr<const Guide> guide = guide_of(tracer, scene, guided);
    std::vector<vulkan::Binding> bindings =
        scene.bind({guide->buffer, *work.walks, *work.counts, *work.sums, *work.unfinished,
                    scene.ground_km() ? *scene.ground_km() : *work.unfinished});
    vulkan::Specialization constants = scene.constants();
    constants.push_back(segments);
    constants.push_back(guided);
    constants.push_back(scene.problem().ground ? scene.problem().ground->kind : 0);
    std::int64_t lanes = lanes_of(push), walking = lanes;
    std::int64_t most = std::max<std::int64_t>(usual_loop_iterations / loops_of_step(scene), 1);
    while (walking > 0) {
      std::int64_t step = walking * cost_of_step(scene.media());
      push.steps = static_cast<int>(
          std::clamp<std::int64_t>(tracer.pacer.evaluations() / step, 1, most));
      tracer.commands.fill(*work.unfinished, 0);
      tracer.commands.dispatch(walk_, constants, bindings, vulkan::bytes_of(push),
                               {vulkan::groups_for(lanes, 64)});
      double ms = tracer.submit();
      std::int64_t still = (*work.unfinished).as<std::uint32_t>()[0];
      // What ends in between is told apart so far: half of those that end have not walked.
      tracer.pacer.took(step * push.steps * (walking + still) / (2 * walking), ms);
      walking = still;
      push.fresh = 0;
    }
  }

  std::unique_ptr<Method> first_order_;
  vulkan::Kernel walk_, finish_;
  Scratch walks_, counts_, sums_, coarse_, unfinished_{vulkan::Memory::host};
};

}  // namespace

const MethodDescription& path_description() {
  static const MethodDescription description{
      .name = "path",
      .title = "Path tracing",
      .summary =
          "The reference: single scattering by quadrature, all further light by random walks "
          "that look at the sun from every vertex. Unbiased; states the standard error of "
          "every value.",
      .highest_order = -1,
      .random = true,
      .limits = {{"Half of the noise costs four times the time."},
                 {"In late twilight and in thick clouds the noise is largest.",
                  {},
                  [](const SceneTraits& scene) {
                    return scene.sun_deg < -6 || scene.depth > 2;
                  }},
                 {"Where the ground differs from place to place walks meet it as it is there; "
                  "but for where the camera's own rays meet it, it is level and without "
                  "detail. Heights shade the air in order one alone.",
                  {},
                  [](const SceneTraits& scene) { return scene.varied_ground; }}},
      .options = {{.name = "samples_per_pixel",
                   .title = "Walks",
                   .description = "Random walks for each pixel or direction.",
                   .unit = "",
                   .minimum = 1,
                   .maximum = 1 << 24,
                   .default_value = 64,
                   .integer = true,
                   .logarithmic = true,
                   .lessens = ErrorSource::walks},
                  {.name = "seed",
                   .title = "Seed",
                   .description = "Of the random numbers: another seed, another noise.",
                   .unit = "",
                   .minimum = 0,
                   .maximum = 1 << 30,
                   .default_value = 0,
                   .integer = true,
                   .logarithmic = false}},
      .ladder = {{{"samples_per_pixel", 16}, {"seed", 0}},
                 {{"samples_per_pixel", 64}, {"seed", 0}},
                 {{"samples_per_pixel", 256}, {"seed", 0}},
                 {{"samples_per_pixel", 1024}, {"seed", 0}},
                 {{"samples_per_pixel", 4096}, {"seed", 0}}},
  };
  return description;
}

std::unique_ptr<Method> make_path(vulkan::Device& device) {
  return std::make_unique<PathTracing>(device);
}

}  // namespace cyanometer
