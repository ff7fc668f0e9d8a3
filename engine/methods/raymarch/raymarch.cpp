#include "engine/methods/raymarch/raymarch.h"

#include <algorithm>
#include <cmath>

#include "engine/methods/scratch.h"
#include "spirv/raymarch.spv.h"

namespace cyanometer {
namespace {

struct RaymarchPush {
  std::int32_t first_ray, rays_in_tile, view_nodes, sun, pieces, first, last;
};

constexpr int pieces_at_most = Physics<float>::MOST_PIECES;

class Raymarch final : public Method {
 public:
  explicit Raymarch(vulkan::Device& device)
      : kernel_(device, raymarch_spirv, UploadedScene::bindings + 2, sizeof(RaymarchPush)) {}

  const MethodDescription& description() const override { return raymarch_description(); }

  double evaluations(const Problem& problem, const MethodOptions& options,
                     double rays) const override {
    return 1e6 + rays * evaluations_of_march(problem, options.at("view_nodes")) *
                     (has_heights(problem) ? shadows_over_columns : 1);
  }

  int rays_at_once(const UploadedScene& scene, const MethodOptions& options,
                   const Pacer& pacer) const override {
    constexpr std::int64_t fewest = 64, most = 1 << 16;
    std::int64_t fit = pacer.evaluations() / cost(scene.problem(), options);
    return static_cast<int>(std::clamp(fit / 64 * 64, fewest, most));
  }

  void trace(Tracer& tracer, const UploadedScene& scene, const MethodOptions& options,
             const Tile& tile) override {
    int view_nodes = static_cast<int>(options.at("view_nodes"));
    int pieces = march_pieces_at_once(scene, view_nodes);
    Scratch::Loan progress = progress_.take(tracer.device, sizeof(float) * tile.rays);
    std::vector<vulkan::Binding> bindings = scene.bind({tile.values, *progress});
    vulkan::Specialization constants = scene.constants();
    if (has_heights(scene.problem())) constants.push_back(scene.problem().ground->kind);
    for (int sun = 0; sun < scene.disc_points(); ++sun) {
      for (int done = 0; done < pieces_at_most; done += pieces) {
        bool last = sun + 1 == scene.disc_points() && done + pieces >= pieces_at_most;
        RaymarchPush push{tile.first_ray, tile.rays, view_nodes, sun, pieces, done == 0, last};
        tracer.commands.dispatch(kernel_, constants, bindings, vulkan::bytes_of(push),
                                 {vulkan::groups_for(tile.rays, 64)});
        tracer.pacer.took(cost(scene.problem(), options) * tile.rays, tracer.submit());
      }
    }
  }

 private:
  static constexpr std::int64_t shadows_over_columns = 8;

  static std::int64_t cost(const Problem& problem, const MethodOptions& options) {
    return march_evaluations(std::ssize(problem.media),
                             static_cast<int>(options.at("view_nodes"))) *
           (has_heights(problem) ? shadows_over_columns : 1);
  }

  vulkan::Kernel kernel_;
  Scratch progress_;
};

/// Rounds of the loops that look for heights before the sun (shaders/surface/ray.glsl).
int looks_from_node(const Problem& problem) {
  return has_heights(problem) ? Physics<float>::MOST_SUN_STEPS * 12 : 0;
}

}  // namespace

int march_pieces_at_once(const UploadedScene& scene, int view_nodes) {
  int on_a_ray = 2 * (scene.profile_nodes() + 1);  // down to its lowest point and up again
  int a_node = 2 + on_a_ray + 4 * scene.density_iterations() + looks_from_node(scene.problem());
  int into = 17 * (1 + scene.density_iterations());  // how far one sees into it
  int a_piece = scene.kinks() + on_a_ray + into + view_nodes * a_node;
  if (a_piece > most_loop_iterations && has_heights(scene.problem())) {
    throw OverLimit(
        "/method/view_nodes",
        "over ground with heights a march can follow at most " +
            std::to_string((most_loop_iterations - scene.kinks() - on_a_ray - into) / a_node) +
            " view nodes");
  }
  if (a_piece > most_loop_iterations) {
    throw OverLimit("/atmosphere/constituents",
                    "the tables of all profiles together have " +
                        std::to_string(scene.profile_nodes()) +
                        " nodes, more than a march of so many view nodes can follow");
  }
  return std::clamp(usual_loop_iterations / a_piece, 1, pieces_at_most);
}

double evaluations_of_march(const Problem& problem, double view_nodes) {
  // Fitted to the times of random scenes (`audit`), where it is half to twice of most: in thick
  // air, and for profiles of straight lines, rays are of more pieces. A column of a tabulated
  // profile is one of each piece of it.
  double layers = 0;
  for (const Medium& medium : problem.media) {
    const auto* table = std::get_if<TableProfile>(&medium.profile);
    layers += std::holds_alternative<ExponentialProfile>(medium.profile) ? 1 : 1.5;
    if (table) layers += 1.2 * static_cast<double>(table->altitude_km.size());
  }
  const double nodes = 34 + 12 * view_nodes,
               pieces = 0.65 + 0.35 * std::log2(1 + largest_depth(problem));
  return problem.sun_disc_samples * nodes * pieces * std::max(layers, 1.0);
}

std::int64_t march_evaluations(std::int64_t media, int view_nodes) {
  constexpr int usual_pieces = 4, a_node = 12;
  return std::int64_t{usual_pieces} * view_nodes * a_node * std::max<std::int64_t>(media, 1);
}

const MethodDescription& raymarch_description() {
  static const MethodDescription description = interpolated({
      .name = "raymarch",
      .title = "Gauss ray march",
      .summary =
          "Single scattering by Gauss-Legendre quadrature: each ray is cut at its lowest "
          "point, "
          "at the planet's shadow and where a layer begins or ends, and its nodes are spread "
          "as "
          "the air thins out.",
      .highest_order = 1,
      .limits = {{"Multiple scattering is left out: the blue of the sky is up to half too "
                  "dark, twilight and thick haze far too dark.",
                  {},
                  [](const SceneTraits& scene) { return scene.scattering_orders != 1; }},
                 {"In haze of an optical depth of 1 a low sun needs more nodes than the "
                  "default.",
                  {},
                  [](const SceneTraits& scene) {
                    return scene.haze > 0.5 && scene.sun_deg < 5;
                  }},
                 {"Heights of the ground shade the air by their shape down to a ten-thousandth "
                  "of the planet's radius.",
                  {},
                  [](const SceneTraits& scene) { return scene.varied_ground; }}},
      .options = {{.name = "view_nodes",
                   .title = "View nodes",
                   .description = "Gauss nodes on each smooth piece of a view ray.",
                   .unit = "",
                   .minimum = 1,
                   .maximum = Physics<float>::MOST_GAUSS_NODES,
                   .default_value = 6,
                   .integer = true,
                   .logarithmic = true,
                   .lessens = ErrorSource::quadrature}},
      .ladder = {{{"view_nodes", 3}},
                 {{"view_nodes", 4}},
                 {{"view_nodes", 6}},
                 {{"view_nodes", 10}},
                 {{"view_nodes", 16}},
                 {{"view_nodes", 32}}},
  });
  return description;
}

std::unique_ptr<Method> make_raymarch(vulkan::Device& device) {
  return std::make_unique<Raymarch>(device);
}

}  // namespace cyanometer
