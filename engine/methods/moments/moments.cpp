#include "engine/methods/moments/moments.h"

#include <algorithm>
#include <array>

#include "engine/methods/hillaire/sky_tracer.h"
#include "engine/methods/moments/grid.h"
#include "engine/methods/moments/tables.h"
#include "engine/methods/orders.h"
#include "engine/methods/raymarch/raymarch.h"
#include "engine/methods/scratch.h"
#include "spirv/moments.spv.h"
#include "spirv/moments_add.spv.h"
#include "spirv/moments_add_parts.spv.h"
#include "spirv/moments_parts.spv.h"
#include "spirv/moments_sky.spv.h"
#include "spirv/moments_sky_rays.spv.h"

namespace cyanometer {
namespace {

/// shaders/methods/moments_sky.comp
struct SkyPush {
  MomentTables::Grid grid;
  std::int32_t fine_altitudes, fine_suns, elevations, azimuths, steps, first, end, stop;
};
/// Its SKY_POINTS.
constexpr int sky_points = 8;
/// shaders/methods/moments.comp
struct PixelPush {
  MomentTables::Grid grid;
  std::int32_t irradiance, fine_suns, elevations, azimuths, first_ray, rays_in_tile, view_nodes,
      sun, pieces, first, last, orders, cut_only;
};

/// shaders/methods/moments_add.comp
struct AddPush {
  MomentTables::Grid grid;
  std::int32_t irradiance, fine_suns, elevations, azimuths, first_ray, rays_in_tile;
};

/// What is scattered more than once, from one camera under one sun.
class Sky final : public Tables {
 public:
  /// @param parts  stops of each ray; 1 for whole rays
  Sky(vulkan::Device& device, int elevations_, int azimuths_, int groups, int parts = 1)
      : elevations(elevations_),
        azimuths(azimuths_),
        values(device, std::size_t{64} * elevations * azimuths * groups * parts,
               vulkan::Memory::device) {}
  std::size_t bytes() const override { return values.size(); }

  int elevations, azimuths;  ///< of the sky; the ground has as many
  vulkan::Buffer values;     ///< as shaders/methods/moments.comp reads them
};

constexpr int finer = 4;
/// Ratios of parts bend less; shaders/methods/moments_parts.glsl.
constexpr int finer_parts = 2, part_stops = 16;

int option(const MethodOptions& options, const char* name) {
  return static_cast<int>(options.at(name));
}

/// Tables for the orders before the last, which the pixel's ray itself scatters. What is 0
/// follows from the scene: finer structure takes finer tables.
MomentSettings settings_of(const Problem& problem, const MethodOptions& options) {
  auto chosen = [&](const char* name, int otherwise) {
    int value = option(options, name);
    return value > 0 ? value : otherwise;
  };
  int usual_degree = degree_for(problem);
  int steps_finer = option(options, "finer");
  bool peaked = usual_degree > 2;
  int degree = chosen("degree", usual_degree + (peaked ? 2 * steps_finer : 0));
  auto sized = [&](const char* name, int usual) {
    return chosen(name, peaked ? usual : usual * (4 + steps_finer) / 4);
  };
  int fineness = std::max(degree, 4);  // of what the moments are moments of
  // Thick air is lit in a layer that is thin for its height, and light comes from close by.
  double depth = largest_depth(problem);
  int steps_more = static_cast<int>(std::clamp(8 * depth - 2, 0.0, 18.0));
  int thick = static_cast<int>(std::clamp(4 * depth - 1, 0.0, 16.0));
  MomentSettings settings{.degree = degree,
                          .altitudes = sized("altitudes", 4 + fineness + thick),
                          .suns = sized("suns", 8 + 2 * fineness),
                          .directions = sized("directions", 6 + fineness),
                          .azimuths = sized("azimuths", 2 + degree),
                          .steps = sized("steps", 2 + fineness + steps_more),
                          .orders = chosen("orders", orders_until_geometric(problem)),
                          .tail = true};
  constexpr int of_a_cubic = 4;
  settings.altitudes = std::max(settings.altitudes, of_a_cubic);
  settings.suns = std::max(settings.suns, of_a_cubic);
  settings.steps = std::min(settings.steps, int{Physics<float>::MOST_GAUSS_NODES});
  int wanted = problem.scattering_orders;
  constexpr int most_orders = 64;
  if (wanted >= 0 && wanted - 1 <= most_orders) {
    settings.orders = std::max(wanted - 1, 0);
    settings.tail = false;
  }
  return settings;
}

template <class Values>
void append(std::string& key, const Values& values) {
  key.append(reinterpret_cast<const char*>(values.data()),
             values.size() * sizeof(values.front()));
}

class Moments final : public Method {
 public:
  explicit Moments(vulkan::Device& device)
      : solver_(device),
        sky_rays_(device, moments_sky_rays_spirv, UploadedScene::bindings + 4, sizeof(SkyPush)),
        sky_(device, moments_sky_spirv, UploadedScene::bindings + 4, sizeof(SkyPush)),
        parts_(device, moments_parts_spirv, UploadedScene::bindings + 5, sizeof(SkyPush)),
        pixel_(device, moments_spirv, UploadedScene::bindings + 5, sizeof(PixelPush)),
        add_(device, moments_add_spirv, UploadedScene::bindings + 4, sizeof(AddPush)),
        add_parts_(device, moments_add_parts_spirv, UploadedScene::bindings + 4,
                   sizeof(AddPush)),
        first_order_tables_(device),
        first_order_(device) {}

  const MethodDescription& description() const override { return moments_description(); }

  double evaluations(const Problem& problem, const MethodOptions& options,
                     double rays) const override {
    MomentSettings settings = settings_of(problem, options);
    double beams = settings.altitudes * 1.5 * settings.directions * settings.suns;
    // Fitted to the times of random scenes (`audit`), of which nearly all are within a third.
    double first_order = 240 * beams * settings.azimuths;
    double others = 5.8 * beams * settings.orders * settings.steps * (settings.degree + 2);
    double sky = 1.8 * options.at("sky_elevations") * options.at("sky_azimuths") *
                 options.at("sky_steps") * (40 + 2 * settings.degree);
    double marched = rays, pixels_read = 0;
    if (may_read_first_order(problem, options)) {
      constexpr double a_lookup = 6;
      pixels_read = rays * a_lookup;
      marched = options.at("first_elevations") * options.at("first_azimuths");
    }
    double pixels =
        marched * evaluations_of_march(problem, options.at("view_nodes")) + pixels_read;
    return 1e6 + first_order + others + sky + pixels;
  }

  int rays_at_once(const UploadedScene& scene, const MethodOptions& options,
                   const Pacer& pacer) const override {
    constexpr std::int64_t fewest = 64, most = 1 << 16;
    if (may_read_first_order(scene.problem(), options)) return most;
    std::int64_t fit = pacer.evaluations() / cost(scene, options, 1);
    return static_cast<int>(std::clamp(fit / 64 * 64, fewest, most));
  }

  void trace(Tracer& tracer, const UploadedScene& scene, const MethodOptions& options,
             const Tile& tile) override {
    MomentSettings settings = settings_of(scene.problem(), options);
    bool more = settings.orders > 0;
    std::string key = "moments " + settings.key();
    append(key, std::array{scene.problem().sun_distance_km});
    key += scene.air_key();
    auto tables = tracer.tables.get<MomentTables>(key, [&] {
      return more ? solver_.solve(tracer, scene, settings)
                  : order_one_tables(tracer.device, scene, settings);
    });
    auto sky = tracer.tables.get<Sky>(sky_key(scene, options, key), [&] {
      return more ? make_sky(tracer, scene, options, settings, *tables)
                  : std::make_shared<const Sky>(tracer.device, 2, 2, 1);
    });
    bool cut = scene.any_ends(tile.first_ray, tile.rays);
    bool whole = !scene.all_end(tile.first_ray, tile.rays);
    hillaire::Sizes first = first_order_sizes(options, *tables);
    if (may_read_first_order(scene.problem(), options) && first_order_.serves(scene, first)) {
      if (whole) {
        read_first_order(tracer, scene, first, tile);
        if (more) add_higher_orders(add_, tracer, scene, settings, *tables, *sky, tile);
      }
      if (cut && first_order_.serves(scene, first.of_parts())) {
        read_first_order(tracer, scene, first.of_parts(), tile);
      } else if (cut) {
        trace_pixels(tracer, scene, options, settings, *tables, *sky, tile, false, true);
      }
    } else {
      trace_pixels(tracer, scene, options, settings, *tables, *sky, tile, more, false);
    }
    if (!cut || !more) return;
    auto parts = tracer.tables.get<Sky>("parts of " + sky_key(scene, options, key), [&] {
      return make_parts(tracer, scene, options, settings, *tables);
    });
    add_higher_orders(add_parts_, tracer, scene, settings, *tables, *parts, tile);
  }

 private:
  /// Order one of parallel light, inside the air, may come from a table of the sky.
  static bool may_read_first_order(const Problem& problem, const MethodOptions& options) {
    return options.at("march_pixels") == 0 && problem.sun_distance_km == 0 &&
           problem.sun_disc_samples == 1 && problem.camera.altitude_km <= problem.thickness_km;
  }

  static hillaire::Sizes first_order_sizes(const MethodOptions& options,
                                           const MomentTables& tables) {
    hillaire::Sizes sizes{};
    sizes.multiple_suns = sizes.multiple_altitudes = 2;  // idle in order one
    sizes.azimuths = option(options, "first_azimuths");
    sizes.elevations = option(options, "first_elevations");
    sizes.view_samples = option(options, "first_samples");
    sizes.orders = 1;
    sizes.straight_on = tables.straight_on;
    return sizes;
  }

  void read_first_order(Tracer& tracer, const UploadedScene& scene,
                        const hillaire::Sizes& sizes, const Tile& tile) {
    first_order_.trace(tracer, scene, sizes,
                       first_order_tables_.get(tracer, scene, sizes, true), tile);
  }

  /// To whole rays, or to parts of rays from a table of these.
  void add_higher_orders(const vulkan::Kernel& kernel, Tracer& tracer,
                         const UploadedScene& scene, const MomentSettings& settings,
                         const MomentTables& tables, const Sky& sky, const Tile& tile) {
    std::vector<vulkan::Binding> bindings =
        scene.bind({tables.series, tables.moments, sky.values, tile.values});
    vulkan::Specialization constants = scene.constants();
    constants.push_back(static_cast<std::uint32_t>(settings.degree));
    constants.push_back(tables.particles);
    AddPush push{tables.grid,  tables.irradiance, tables.fine_suns, sky.elevations,
                 sky.azimuths, tile.first_ray,    tile.rays};
    tracer.commands.dispatch(kernel, constants, bindings, vulkan::bytes_of(push),
                             {vulkan::groups_for(tile.rays, 64)});
    constexpr std::int64_t a_pixel = 20;
    tracer.pacer.took(a_pixel * std::max(scene.media(), 1) * tile.rays, tracer.submit());
  }

  /// Order one alone needs no moments.
  static std::shared_ptr<const MomentTables> order_one_tables(vulkan::Device& device,
                                                              const UploadedScene& scene,
                                                              const MomentSettings& settings) {
    MomentTables::Grid grid = moment_grid<float>(scene.problem(), 4, 4);
    return std::make_shared<const MomentTables>(
        device, grid, make_phase_series(scene.problem(), settings.degree, false),
        settings.degree, scene.groups());
  }

  static std::string sky_key(const UploadedScene& scene, const MethodOptions& options,
                             const std::string& tables_key) {
    std::string key = "moments' sky ";
    const Problem& problem = scene.problem();
    append(key, std::array{options.at("sky_steps"), options.at("sky_elevations"),
                           options.at("sky_azimuths"), problem.camera.altitude_km});
    append(key, problem.sun_direction);
    return key + tables_key;
  }

  /// shaders/methods/moments_sky.glsl
  static std::size_t sky_ray_bytes(const SkyPush& push, int degree, int groups) {
    std::size_t nodes = std::size_t{2} * push.elevations * push.steps;
    return 16 * nodes * (1 + sky_points * (degree + 2) * groups);
  }

  std::shared_ptr<const Sky> make_sky(Tracer& tracer, const UploadedScene& scene,
                                      const MethodOptions& options,
                                      const MomentSettings& settings,
                                      const MomentTables& tables) {
    int elevations = option(options, "sky_elevations"),
        azimuths = option(options, "sky_azimuths"), groups = scene.groups();
    Sky coarse(tracer.device, elevations, azimuths, groups);
    int fine_elevations = finer * (elevations - 1) + 1,
        fine_azimuths = finer * (azimuths - 1) + 1;
    Sky between(tracer.device, fine_elevations, azimuths, groups);
    auto sky = std::make_shared<Sky>(tracer.device, fine_elevations, fine_azimuths, groups);
    SkyPush push{tables.grid,
                 tables.fine_altitudes,
                 tables.fine_suns,
                 elevations,
                 azimuths,
                 option(options, "sky_steps"),
                 0,
                 0,
                 0};
    vulkan::Buffer rays(tracer.device, sky_ray_bytes(push, settings.degree, groups),
                        vulkan::Memory::device);
    vulkan::Specialization constants =
        moment_constants(scene, settings.degree, tables.particles);
    bool each_azimuth = scene.problem().camera.altitude_km > scene.problem().thickness_km;
    constants.push_back(each_azimuth);
    if (!each_azimuth) sky_rays_.prepare(constants);
    sky_.prepare(constants);
    PacedWork work(tracer);
    auto run = [&](const vulkan::Kernel& kernel, int count, std::int64_t evaluations_each) {
      std::vector<vulkan::Binding> bindings =
          scene.bind({tables.series, tables.moments, rays, coarse.values});
      work.run(count, evaluations_each, [&](int first, int end) {
        push.first = first;
        push.end = end;
        tracer.commands.dispatch(kernel, constants, bindings, vulkan::bytes_of(push),
                                 {vulkan::groups_for(end - first, 64)});
      });
    };
    int degree = settings.degree, a_node = cost_of_sky_node(scene, degree);
    if (!each_azimuth)
      run(sky_rays_, 2 * elevations * push.steps * sky_points * groups, a_node);
    run(sky_, 2 * elevations * azimuths * groups,
        push.steps * (each_azimuth ? a_node : sky_points / 2 * (degree + 2)));
    refine_sky(work, tracer, scene, coarse, between, *sky, 2 * groups);
    work.submit();
    return sky;
  }

  /// First over elevations, then over azimuths. @param values  of a direction
  void refine_sky(PacedWork& work, Tracer& tracer, const UploadedScene& scene,
                  const Sky& coarse, const Sky& between, const Sky& fine, int values) {
    solver_.refine(work, tracer, scene, coarse.values, between.values, 2,
                   {0, 0, coarse.elevations, fine.elevations, coarse.azimuths * values, 0});
    solver_.refine(work, tracer, scene, between.values, fine.values, 2 * fine.elevations,
                   {0, 0, coarse.azimuths, fine.azimuths, values, 1});
  }

  /// Evaluations of a node of a camera's ray.
  static int cost_of_sky_node(const UploadedScene& scene, int degree) {
    return 10 * std::max(scene.media(), 1) + 2 * (degree + 1) * (degree + 2);
  }

  std::shared_ptr<const Sky> make_parts(Tracer& tracer, const UploadedScene& scene,
                                        const MethodOptions& options,
                                        const MomentSettings& settings,
                                        const MomentTables& tables) {
    constexpr int most_elevations = 64, most_azimuths = 32;
    int elevations = std::min(option(options, "sky_elevations"), most_elevations),
        azimuths = std::min(option(options, "sky_azimuths"), most_azimuths),
        groups = scene.groups();
    int fine_elevations = finer_parts * (elevations - 1) + 1,
        fine_azimuths = finer_parts * (azimuths - 1) + 1;
    Sky light(tracer.device, elevations, azimuths, groups);
    Sky coarse(tracer.device, elevations, azimuths, groups, part_stops);
    Sky between(tracer.device, fine_elevations, azimuths, groups, part_stops);
    auto parts = std::make_shared<Sky>(tracer.device, fine_elevations, fine_azimuths, groups,
                                       part_stops);
    SkyPush push{
        tables.grid, tables.fine_altitudes, tables.fine_suns, elevations, azimuths, 0, 0, 0, 0};
    vulkan::Specialization constants =
        moment_constants(scene, settings.degree, tables.particles);
    std::vector<vulkan::Binding> bindings =
        scene.bind({tables.series, tables.moments, tables.series, light.values, coarse.values});
    PacedWork work(tracer);
    int a_node = cost_of_sky_node(scene, settings.degree);
    for (push.stop = 0; push.stop < part_stops; ++push.stop) {
      work.run(2 * elevations * azimuths * groups, 4 * a_node, [&](int first, int end) {
        push.first = first;
        push.end = end;
        tracer.commands.dispatch(parts_, constants, bindings, vulkan::bytes_of(push),
                                 {vulkan::groups_for(end - first, 64)});
      });
    }
    refine_sky(work, tracer, scene, coarse, between, *parts, 2 * groups * part_stops);
    work.submit();
    return parts;
  }

  /// @param cut_only  leaves alone the rays that go on as far as they can
  void trace_pixels(Tracer& tracer, const UploadedScene& scene, const MethodOptions& options,
                    const MomentSettings& settings, const MomentTables& tables, const Sky& sky,
                    const Tile& tile, bool more, bool cut_only) {
    int view_nodes = option(options, "view_nodes");
    require_rounds(scene, rounds_of_a_piece(scene, view_nodes));
    int all_pieces = most_pieces(scene);
    int pieces =
        std::clamp(usual_loop_iterations / rounds_of_a_piece(scene, view_nodes), 1, all_pieces);
    Scratch::Loan progress = progress_.take(tracer.device, sizeof(float) * tile.rays);
    std::vector<vulkan::Binding> bindings =
        scene.bind({tables.series, tables.moments, sky.values, tile.values, *progress});
    vulkan::Specialization constants = scene.constants();
    constants.push_back(static_cast<std::uint32_t>(settings.degree));
    constants.push_back(tables.particles);
    for (int sun = 0; sun < scene.disc_points(); ++sun) {
      for (int done = 0; done < all_pieces; done += pieces) {
        bool last = sun + 1 == scene.disc_points() && done + pieces >= all_pieces;
        PixelPush push{tables.grid,    tables.irradiance, tables.fine_suns,
                       sky.elevations, sky.azimuths,      tile.first_ray,
                       tile.rays,      view_nodes,        sun,
                       pieces,         done == 0,         last,
                       more ? 2 : 1,   cut_only};
        tracer.commands.dispatch(pixel_, constants, bindings, vulkan::bytes_of(push),
                                 {vulkan::groups_for(tile.rays, 64)});
        tracer.pacer.took(cost(scene, options, tile.rays), tracer.submit());
      }
    }
  }

  /// Evaluations of a number of rays under one sun.
  static std::int64_t cost(const UploadedScene& scene, const MethodOptions& options,
                           std::int64_t rays) {
    constexpr int usual_pieces = 4, a_node = 12;
    return rays * usual_pieces * option(options, "view_nodes") * a_node *
           std::max(scene.media(), 1);
  }

  MomentSolver solver_;
  vulkan::Kernel sky_rays_, sky_, parts_, pixel_, add_, add_parts_;
  hillaire::TableMaker first_order_tables_;
  hillaire::SkyTracer first_order_;
  Scratch progress_;
};

MethodOption whole(std::string name, std::string title, std::string text, double minimum,
                   double maximum, double usual, ErrorSource lessens) {
  return {.name = std::move(name),
          .title = std::move(title),
          .description = std::move(text),
          .unit = "",
          .minimum = minimum,
          .maximum = maximum,
          .default_value = usual,
          .integer = true,
          .logarithmic = minimum > 0,
          .lessens = lessens,
          .finest = maximum > 1 ? std::nullopt : std::optional(maximum)};
}

/// All options, those of the tables as they follow from the scene.
MethodOptions sizes(int degree, int steps_finer, bool march) {
  const bool fine = steps_finer > 0;
  MethodOptions options{{"degree", degree},
                        {"finer", steps_finer},
                        {"march_pixels", march},
                        {"view_nodes", fine ? 8 : 6},
                        {"sky_steps", fine ? 20 : 14},
                        {"sky_elevations", fine ? 64 : 40},
                        {"sky_azimuths", fine ? 32 : 20},
                        {"first_elevations", 108},
                        {"first_azimuths", 64},
                        {"first_samples", 16}};
  for (const char* name : {"altitudes", "suns", "directions", "azimuths", "steps", "orders"}) {
    options[name] = 0;
  }
  return options;
}

}  // namespace

const MethodDescription& moments_description() {
  static const MethodDescription description = interpolated({
      .name = "moments",
      .title = "Moment tables",
      .summary = "Order one by a Gauss march on every ray; all others from small tables of the "
                 "light's spherical-harmonic moments over altitude and the sun's elevation.",
      .limits =
          {{"Forward peaks sharper than the moments resolve (g above 0.8 at an optical "
            "depth of 0.2 and more) blur the light next to a low sun and to the horizon; under "
            "a sun at 33 deg 95 % of the light of haze of a depth of 1 is within 5 % at a g of "
            "0.9, within 11 % at 0.97.",
            {3, 13, 14},
            [](const SceneTraits& scene) {
              return scene.asymmetry > 0.85 || (scene.asymmetry > 0.7 && scene.haze > 0.15);
            }},
           {"What is scattered more than once comes from the centre of the sun's disc.",
            {17},
            [](const SceneTraits& scene) { return scene.sun_diameter_deg > 5; }},
           {"Before objects near the camera the air's light is off by 4 to 7 % in haze "
            "at dusk.",
            {2},
            [](const SceneTraits& scene) { return scene.haze > 0.02 && scene.sun_deg < 5; }},
           {"Late twilight is off by 2 % from a sun of -9 deg on, 3 % from -12, also where a "
            "number of "
            "orders is asked for.",
            {7, 8},
            [](const SceneTraits& scene) { return scene.sun_deg < -6; }},
           {"Thick air loses light: of an optical depth of 3 over white ground 2 %, of 10 5 %.",
            {12},
            [](const SceneTraits& scene) { return scene.depth > 2; }},
           {"Order one, where it is read from a table, is off by 0.5 % for cameras above "
            "20 km, and by 1 % in twilight.",
            {},
            [](const SceneTraits& scene) {
              return scene.altitude_km > 10 || scene.sun_deg < 0;
            }},
           {"Where the ground differs from place to place, the light that it sends back "
            "into the air is that of its mean albedo, slopes and the sea see an even "
            "sky, and heights shade the air not at all.",
            {},
            [](const SceneTraits& scene) { return scene.varied_ground; }}},
      .options =
          {whole("degree", "Degree",
                 "Highest degree of the spherical-harmonic moments; 0 takes 2 in clean air, 4 "
                 "in clear air and up to 8 in haze.",
                 0, Physics<float>::MOST_DEGREE, 0, ErrorSource::tables),
           whole(
               "altitudes", "Altitudes",
               "Nodes of the tables over altitude, at least 4; 0 takes what suits the degree, "
               "and more where the air is thick.",
               0, 32, 0, ErrorSource::tables),
           whole("suns", "Suns",
                 "Nodes of the tables over the sun's elevation, at least 4; 0 takes what suits "
                 "the degree.",
                 0, 64, 0, ErrorSource::tables),
           whole("directions", "Directions",
                 "Zenith angles above the horizon of the rays that gather light, 0 for what "
                 "suits the degree; below it are half as many.",
                 0, 24, 0, ErrorSource::quadrature),
           whole("azimuths", "Azimuths",
                 "Azimuths of those rays, in half a turn; 0 takes what suits the degree.", 0,
                 24, 0, ErrorSource::quadrature),
           whole("steps", "Steps",
                 "Gauss nodes on each of those rays; 0 takes what suits the degree, and more "
                 "where the air is thick.",
                 0, 32, 0, ErrorSource::quadrature),
           whole(
               "orders", "Orders",
               "Orders that are traced; all later ones follow from how these fade. 0 takes as "
               "many as the air's depth and the ground's albedo ask for.",
               0, 64, 0, ErrorSource::orders),
           whole(
               "finer", "Finer",
               "By as many steps the degree that follows from the scene is higher by two, and "
               "all that follows from it finer; in clean air, which two degrees hold, all the "
               "rest is finer by quarters.",
               0, 2, 0, ErrorSource::tables),
           whole("view_nodes", "View nodes",
                 "Gauss nodes of order one on each smooth piece of a view ray.", 1,
                 Physics<float>::MOST_GAUSS_NODES, 6, ErrorSource::quadrature),
           whole("sky_steps", "Sky steps",
                 "Gauss nodes of the other orders on a ray of the camera's sky.", 4,
                 Physics<float>::MOST_GAUSS_NODES, 14, ErrorSource::quadrature),
           whole("sky_elevations", "Sky elevations",
                 "Elevations of the camera's sky, and as many of its ground.", 8, 256, 40,
                 ErrorSource::tables),
           whole("sky_azimuths", "Sky azimuths",
                 "Azimuths of the camera's sky, in half a turn.", 4, 128, 20,
                 ErrorSource::tables),
           whole(
               "march_pixels", "March each pixel",
               "1 marches order one in every pixel, as is always done from outside the air and "
               "for a near or wide sun; 0 reads it from a table of the camera's sky, as "
               "hillaire does.",
               0, 1, 1, ErrorSource::tables),
           whole("first_elevations", "Order one: elevations",
                 "Elevations of that table, half above and half below the horizon.", 4, 512,
                 108, ErrorSource::tables),
           whole("first_azimuths", "Order one: azimuths", "Azimuths of that table.", 2, 512, 64,
                 ErrorSource::tables),
           whole("first_samples", "Order one: samples", "Samples on its rays.", 4, 64, 16,
                 ErrorSource::quadrature)},
      .ladder = {sizes(4, 0, false), sizes(0, 0, false), sizes(0, 0, true), sizes(0, 1, true),
                 sizes(0, 2, true)},
  });
  return description;
}

std::unique_ptr<Method> make_moments(vulkan::Device& device) {
  return std::make_unique<Moments>(device);
}

}  // namespace cyanometer
