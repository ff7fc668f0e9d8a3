#include "engine/methods/bruneton/bruneton.h"

#include <cmath>

#include "engine/methods/bruneton/table_panels.h"
#include "engine/methods/bruneton/tables.h"
#include "engine/methods/raymarch/raymarch.h"
#include "engine/methods/tables/fill.h"
#include "spirv/bruneton.spv.h"
#include "spirv/bruneton_parts.spv.h"
#include "spirv/bruneton_single_view.spv.h"

namespace cyanometer {
namespace {

using bruneton::Setup;

/// Of the density, that reading a table for a ray and a group of wavelengths is worth.
constexpr int view_evaluations = 20;

struct ViewPush {
  std::int32_t first_ray, rays_in_tile;
};
struct PartsPush {
  std::int32_t first, end, first_ray, rays_in_tile, cells;
};

class Bruneton final : public Method {
 public:
  explicit Bruneton(vulkan::Device& device)
      : first_order_(make_raymarch(device)),
        tables_(device),
        parts_(device, bruneton_parts_spirv, UploadedScene::bindings + 4, sizeof(PartsPush)),
        view_(device, bruneton_spirv, UploadedScene::bindings + 5, sizeof(ViewPush)),
        single_view_(device, bruneton_single_view_spirv, UploadedScene::bindings + 5,
                     sizeof(ViewPush)) {}

  const MethodDescription& description() const override { return bruneton_description(); }

  double evaluations(const Problem& problem, const MethodOptions& options,
                     double rays) const override {
    double groups = std::ceil(static_cast<double>(problem.wavelengths_nm.size()) / 4);
    return bruneton::evaluations(problem, Setup(options)) +
           first_order_->evaluations(problem, options, rays) + rays * groups * view_evaluations;
  }

  int rays_at_once(const UploadedScene& scene, const MethodOptions& options,
                   const Pacer& pacer) const override {
    return first_order_->rays_at_once(scene, options, pacer);
  }

  void trace(Tracer& tracer, const UploadedScene& scene, const MethodOptions& options,
             const Tile& tile) override {
    Setup setup(options);
    bool cut = scene.any_ends(tile.first_ray, tile.rays);
    bool whole = !scene.all_end(tile.first_ray, tile.rays);
    bool quadrature = setup.first == Setup::First::quadrature;
    if (cut || quadrature) first_order_->trace(tracer, scene, options, tile);
    if (whole && !quadrature) trace_single(tracer, scene, setup, tile);
    if (!bruneton::has_multiple(scene.problem())) return;
    if (whole || scene.problem().ground) add_multiple(tracer, scene, setup, tile);
    if (cut) add_multiple_to_parts(tracer, scene, setup, tile);
  }

  std::vector<Panels> tables(Tracer& tracer, const UploadedScene& scene,
                             const MethodOptions& options) override {
    return bruneton::table_panels(tables_, tracer, scene, Setup(options));
  }

 private:
  void trace_single(Tracer& tracer, const UploadedScene& scene, const Setup& setup,
                    const Tile& tile) {
    auto table = tables_.single(tracer, scene, setup);
    run(tracer, scene, bruneton::view_constants(scene, setup, table->rays.rays), single_view_,
        {table->rays.grids, table->rays.nodes, table->values, table->particles, tile.values},
        view_evaluations * scene.media() * scene.groups(), tile);
  }

  void add_multiple(Tracer& tracer, const UploadedScene& scene, const Setup& setup,
                    const Tile& tile) {
    auto sources = tables_.source(tracer, scene, setup);
    auto view = tables_.view(tracer, scene, setup);
    run(tracer, scene, bruneton::view_constants(scene, setup, view->rays.rays), view_,
        {view->rays.grids, view->rays.nodes, view->values, sources->irradiance, tile.values},
        view_evaluations * scene.groups(), tile);
  }

  void add_multiple_to_parts(Tracer& tracer, const UploadedScene& scene, const Setup& setup,
                             const Tile& tile) {
    auto sources = tables_.source(tracer, scene, setup);
    auto view = tables_.view(tracer, scene, setup);
    std::int64_t a_cell = 4 * (scene.media() + 1) + view_evaluations * scene.groups();
    fill_table(tracer,
               {parts_, bruneton::view_constants(scene, setup, view->rays.rays),
                scene.bind({view->rays.grids, view->rays.nodes, sources->source, tile.values})},
               tile.rays, setup.cells * a_cell,
               PartsPush{0, 0, tile.first_ray, tile.rays, setup.cells});
  }

  static void run(Tracer& tracer, const UploadedScene& scene,
                  const vulkan::Specialization& constants, const vulkan::Kernel& kernel,
                  std::initializer_list<vulkan::Binding> own, std::int64_t evaluations,
                  const Tile& tile) {
    ViewPush push{tile.first_ray, tile.rays};
    std::vector<vulkan::Binding> bindings = scene.bind(own);
    tracer.commands.dispatch(kernel, constants, bindings, vulkan::bytes_of(push),
                             {vulkan::groups_for(tile.rays, 64)});
    tracer.pacer.took(evaluations * tile.rays, tracer.submit());
  }

  std::unique_ptr<Method> first_order_;
  bruneton::TableMaker tables_;
  vulkan::Kernel parts_, view_, single_view_;
};

MethodOption nodes(std::string name, std::string title, std::string description, int least,
                   int most, int usual, ErrorSource lessens) {
  return {.name = std::move(name),
          .title = std::move(title),
          .description = std::move(description),
          .unit = "",
          .minimum = static_cast<double>(least),
          .maximum = static_cast<double>(most),
          .default_value = static_cast<double>(usual),
          .integer = true,
          .logarithmic = least > 0 && most > 4,
          .lessens = lessens,
          // The defaults of switches are the finest that there is.
          .finest = most > 2 ? std::nullopt : std::optional<double>(usual)};
}

MethodDescription describe() {
  MethodDescription description{
      .name = "bruneton",
      .title = "Bruneton's tables",
      .summary =
          "All orders, each from the one before, in tables over altitude, view, sun and the "
          "azimuth between them. They hold for every camera and every sun.",
      .limits =
          {{"From the second order on light is parallel and comes from the centre of the "
            "disc.",
            {17},
            [](const SceneTraits& scene) {
              return scene.sun_diameter_deg > 1 || scene.near_sun;
            }},
           {"In haze of an optical depth of 0.1 under a low sun one ray in a hundred is "
            "off by 2.5 % at the defaults; in clear air by less than 0.5 %, 6 % at a sun "
            "of -12 deg.",
            {2, 3, 8, 10},
            [](const SceneTraits& scene) { return scene.sun_deg < 10; }},
           {"Ground within a tenth of a degree of the horizon of a camera below 10 m is "
            "up to 8 % too bright.",
            {1, 2},
            [](const SceneTraits& scene) { return scene.altitude_km < 0.01; }},
           {"Forward peaks that are narrower than the source's directions lie apart (g above "
            "0.86 at the defaults) are as wide as these from the second order on.",
            {13, 14},
            [](const SceneTraits& scene) { return scene.asymmetry > 0.85; }},
           {"Haze of an optical depth of 3 is off by a tenth, of 10 by half, molecules of 10 "
            "lose a twentieth of the light: more altitudes follow thick air.",
            {12, 22},
            [](const SceneTraits& scene) { return scene.depth > 2; }},
           {"Where the ground differs from place to place, the light that it sends back "
            "into the air is that of its mean albedo, slopes and the sea see an even "
            "sky, and heights shade the air in order one alone.",
            {},
            [](const SceneTraits& scene) { return scene.varied_ground; }}},
      .options =
          {nodes("orders", "Orders computed",
                 "Of all orders those that are computed; the others follow from the last of "
                 "them. 0: as many as light takes to get through the air, five at least; 1 "
                 "counts as 2.",
                 0, 64, 0, ErrorSource::orders),
           nodes("altitudes", "Altitudes", "Nodes from the ground to the top.", 4, 128, 16,
                 ErrorSource::tables),
           nodes("zeniths", "Zenith nodes",
                 "Directions of view on each side of the horizon, and of the integral over "
                 "all directions.",
                 4, 128, 24, ErrorSource::tables),
           nodes("suns", "Sun nodes",
                 "Elevations of the sun, from the zenith to where it lights no air.", 4, 256,
                 32, ErrorSource::tables),
           nodes("azimuths", "Azimuth nodes", "From the sun to the opposite.", 3, 65, 13,
                 ErrorSource::tables),
           nodes("source_zeniths", "Source zeniths",
                 "Directions, even in angle, of what the air scatters.", 3, 129, 13,
                 ErrorSource::tables),
           nodes("source_azimuths", "Source azimuths", "Of what the air scatters.", 3, 65, 7,
                 ErrorSource::tables),
           nodes("refinement", "Refinement",
                 "The source is interpolated by cubics on a grid so many times finer in each "
                 "coordinate, before it is read linearly; 1 leaves that out.",
                 1, 6, 2, ErrorSource::none),
           nodes("samples", "Samples", "Of a path, from the second order on.", 2, 256, 20,
                 ErrorSource::quadrature),
           nodes("view_samples", "View samples", "Of a path that is gathered for the view.", 2,
                 256, 64, ErrorSource::quadrature),
           nodes("view_nodes", "View nodes",
                 "Gauss nodes on each smooth piece of a path in the first order.", 1,
                 Physics<float>::MOST_GAUSS_NODES, 6, ErrorSource::quadrature),
           nodes("mapping", "Mapping",
                 "Of tables: 0 linear; 1 the paper's, by distances to the horizon and the top; "
                 "2 gathered at the horizon and the terminator.",
                 0, 2, 2, ErrorSource::tables),
           nodes("horizon", "Split at the horizon",
                 "1: nothing is interpolated from the sky to the ground.", 0, 1, 1,
                 ErrorSource::tables),
           nodes("logarithmic", "Of logarithms", "1: logarithms are interpolated.", 0, 1, 1,
                 ErrorSource::tables),
           nodes("gather", "Gather for the view",
                 "1: a small table of the view is integrated from the source for the camera's "
                 "altitude and sun; 0: the four-dimensional table is read.",
                 0, 1, 1, ErrorSource::tables),
           nodes("first_order", "First order",
                 "0: by quadrature; 1: from a table of each constituent; 2: particles in the "
                 "colours of the molecules' table.",
                 0, 2, 0, ErrorSource::tables)},
      .variations = {{{"altitudes", 8}, {"zeniths", 12}, {"suns", 16}, {"azimuths", 7}},
                     {{"gather", 0}},
                     {{"mapping", 1}},
                     {{"mapping", 0}},
                     {{"first_order", 1}},
                     {{"first_order", 2}}},
  };
  return description;
}

}  // namespace

const MethodDescription& bruneton_description() {
  static const MethodDescription description = interpolated(describe());
  return description;
}

std::unique_ptr<Method> make_bruneton(vulkan::Device& device) {
  return std::make_unique<Bruneton>(device);
}

}  // namespace cyanometer
