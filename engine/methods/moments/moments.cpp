#include "engine/methods/moments/moments.h"

#include <algorithm>
#include <array>
#include <optional>

#include "engine/methods/moments/grid.h"
#include "engine/methods/moments/tables.h"
#include "spirv/moments.spv.h"
#include "spirv/moments_sky.spv.h"

namespace cyanometer {
namespace {

/// shaders/methods/moments_sky.comp
struct SkyPush {
  MomentTables::Grid grid;
  std::int32_t fine_altitudes, fine_suns, elevations, azimuths, steps, first, end;
};
/// shaders/methods/moments.comp
struct PixelPush {
  MomentTables::Grid grid;
  std::int32_t irradiance, fine_suns, elevations, azimuths, first_ray, rays_in_tile, view_nodes,
      sun, pieces, first, last, orders;
};

/// What is scattered more than once, from one camera under one sun.
class Sky final : public Tables {
 public:
  Sky(vulkan::Device& device, int elevations_, int azimuths_, int groups)
      : elevations(elevations_),
        azimuths(azimuths_),
        values(device, std::size_t{64} * elevations * azimuths * groups,
               vulkan::Memory::device) {}
  std::size_t bytes() const override { return values.size(); }

  int elevations, azimuths;  ///< of the sky; the ground has as many
  vulkan::Buffer values;     ///< as shaders/methods/moments.comp reads them
};

constexpr int finer = 4;

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
  int degree = chosen("degree", 0);
  if (degree == 0) degree = degree_for(problem);
  // Thick air is lit in a layer that is thin for its height, and light comes from close by.
  int thick = static_cast<int>(std::min(1.5 * largest_depth(problem), 12.0));
  MomentSettings settings{.degree = degree,
                          .altitudes = chosen("altitudes", 4 + degree + thick),
                          .suns = chosen("suns", 8 + 2 * degree),
                          .directions = chosen("directions", 4 + degree),
                          .azimuths = chosen("azimuths", 2 + degree),
                          .steps = chosen("steps", 2 + degree + thick),
                          .orders = chosen("orders", orders_until_geometric(problem)),
                          .tail = true};
  settings.altitudes = std::max(settings.altitudes, 4);  // as a cubic takes
  int wanted = problem.scattering_orders;
  constexpr int most_orders = 64;
  if (wanted > 0 && wanted - 1 <= most_orders) {
    settings.orders = wanted - 1;
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
        sky_(device, moments_sky_spirv, UploadedScene::bindings + 3, sizeof(SkyPush)),
        pixel_(device, moments_spirv, UploadedScene::bindings + 5, sizeof(PixelPush)) {}

  const MethodDescription& description() const override { return moments_description(); }

  double evaluations(const Problem& problem, const MethodOptions& options,
                     double rays) const override {
    constexpr double multiplications_in_one = 8;
    MomentSettings settings = settings_of(problem, options);
    double media = std::max<double>(static_cast<double>(problem.media.size()), 1);
    double gathered =
        settings.altitudes * 1.5 * settings.directions * settings.suns * settings.azimuths;
    double first_order = gathered * 2 * 6 * 12 * media;
    double others = gathered * settings.orders * settings.steps * 4 * (settings.degree + 2) /
                    multiplications_in_one;
    double sky = 2 * options.at("sky_elevations") * options.at("sky_azimuths") *
                 options.at("sky_steps") * 10 * media;
    double pixels = rays * problem.sun_disc_samples * 4 * options.at("view_nodes") * 12 * media;
    return first_order + others + sky + pixels;
  }

  int rays_at_once(const UploadedScene& scene, const MethodOptions& options,
                   const Pacer& pacer) const override {
    constexpr std::int64_t fewest = 64, most = 1 << 16;
    std::int64_t fit = pacer.evaluations() / cost(scene, options, 1);
    return static_cast<int>(std::clamp(fit / 64 * 64, fewest, most));
  }

  void trace(Tracer& tracer, const UploadedScene& scene, const MethodOptions& options,
             const Tile& tile) override {
    MomentSettings settings = settings_of(scene.problem(), options);
    bool more = scene.problem().scattering_orders != 0 && settings.orders > 0;
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
    trace_pixels(tracer, scene, options, settings, *tables, *sky, tile, more);
  }

 private:
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
                 0};
    std::vector<vulkan::Binding> bindings =
        scene.bind({tables.series, tables.moments, coarse.values});
    vulkan::Specialization constants =
        moment_constants(scene, settings.degree, tables.particles);
    PacedWork work(tracer);
    std::int64_t node =
        10 * std::max(scene.media(), 1) + 2 * (settings.degree + 1) * (settings.degree + 2);
    require_rounds(scene, rounds_of_a_piece(scene, push.steps));
    work.run(2 * elevations * azimuths * groups, push.steps * node, [&](int first, int end) {
      push.first = first;
      push.end = end;
      tracer.commands.dispatch(sky_, constants, bindings, vulkan::bytes_of(push),
                               {vulkan::groups_for(end - first, 64)});
    });
    int values = 2 * groups;
    solver_.refine(work, tracer, scene, coarse.values, between.values, 2,
                   {0, 0, elevations, fine_elevations, azimuths * values, 0});
    solver_.refine(work, tracer, scene, between.values, sky->values, 2 * fine_elevations,
                   {0, 0, azimuths, fine_azimuths, values, 1});
    work.submit();
    return sky;
  }

  void trace_pixels(Tracer& tracer, const UploadedScene& scene, const MethodOptions& options,
                    const MomentSettings& settings, const MomentTables& tables, const Sky& sky,
                    const Tile& tile, bool more) {
    int view_nodes = option(options, "view_nodes");
    require_rounds(scene, rounds_of_a_piece(scene, view_nodes));
    int all_pieces = most_pieces(scene);
    int pieces =
        std::min(most_loop_iterations / rounds_of_a_piece(scene, view_nodes), all_pieces);
    std::vector<vulkan::Binding> bindings =
        scene.bind({tables.series, tables.moments, sky.values, tile.values,
                    progress_for(tracer.device, tile.rays)});
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
                       more ? 2 : 1};
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

  const vulkan::Buffer& progress_for(vulkan::Device& device, int rays) {
    std::size_t bytes = sizeof(float) * rays;
    if (!progress_ || progress_->size() < bytes) {
      progress_.emplace(device, bytes, vulkan::Memory::device);
    }
    return *progress_;
  }

  MomentSolver solver_;
  vulkan::Kernel sky_, pixel_;
  std::optional<vulkan::Buffer> progress_;
};

MethodOption whole(std::string name, std::string title, std::string text, double minimum,
                   double maximum, double usual) {
  return {.name = std::move(name),
          .title = std::move(title),
          .description = std::move(text),
          .unit = "",
          .minimum = minimum,
          .maximum = maximum,
          .default_value = usual,
          .integer = true,
          .logarithmic = minimum > 0};
}

/// All options but the number of orders, which follows from the air.
MethodOptions sizes(int degree, int altitudes, int suns, int directions, int azimuths,
                    int steps, int view_nodes, int sky_steps, int sky_elevations,
                    int sky_azimuths) {
  return {{"degree", degree},
          {"altitudes", altitudes},
          {"suns", suns},
          {"directions", directions},
          {"azimuths", azimuths},
          {"steps", steps},
          {"orders", 0},
          {"view_nodes", view_nodes},
          {"sky_steps", sky_steps},
          {"sky_elevations", sky_elevations},
          {"sky_azimuths", sky_azimuths}};
}

}  // namespace

const MethodDescription& moments_description() {
  static const MethodDescription description{
      .name = "moments",
      .title = "Moment tables",
      .summary =
          "Order one by a Gauss march on every ray; all others from small tables of the "
          "light's spherical-harmonic moments over altitude and the sun's elevation.",
      .limits =
          {"Forward peaks sharper than the moments resolve (g above 0.8 at an optical depth of "
           "0.2 and more) blur the light next to a low sun and to the horizon.",
           "What is scattered more than once comes from the centre of the sun's disc."},
      .options =
          {whole("degree", "Degree",
                 "Highest degree of the spherical-harmonic moments; 0 takes 4 in clear air and "
                 "up to 8 in haze.",
                 0, 8, 0),
           whole("altitudes", "Altitudes",
                 "Nodes of the tables over altitude; 0 takes what suits the degree, and more "
                 "where the air is thick.",
                 0, 32, 0),
           whole("suns", "Suns",
                 "Nodes of the tables over the sun's elevation; 0 takes what suits the degree.",
                 0, 64, 0),
           whole("directions", "Directions",
                 "Zenith angles above the horizon of the rays that gather light, 0 for what "
                 "suits the degree; below it are half as many.",
                 0, 24, 0),
           whole("azimuths", "Azimuths",
                 "Azimuths of those rays, in half a turn; 0 takes what suits the degree.", 0,
                 24, 0),
           whole("steps", "Steps",
                 "Gauss nodes on each of those rays; 0 takes what suits the degree, and more "
                 "where the air is thick.",
                 0, 32, 0),
           whole("orders", "Orders",
                 "Orders that are traced before a geometric series takes over; 0 takes as many "
                 "as the air's depth and the ground's albedo ask for.",
                 0, 64, 0),
           whole("view_nodes", "View nodes",
                 "Gauss nodes of order one on each smooth piece of a view ray.", 1,
                 Physics<float>::MOST_GAUSS_NODES, 6),
           whole("sky_steps", "Sky steps",
                 "Gauss nodes of the other orders on a ray of the camera's sky.", 4,
                 Physics<float>::MOST_GAUSS_NODES, 16),
           whole("sky_elevations", "Sky elevations",
                 "Elevations of the camera's sky, and as many of its ground.", 8, 256, 48),
           whole("sky_azimuths", "Sky azimuths",
                 "Azimuths of the camera's sky, in half a turn.", 4, 128, 24)},
      .ladder = {sizes(4, 0, 0, 0, 0, 0, 6, 16, 48, 24), sizes(0, 0, 0, 0, 0, 0, 6, 16, 48, 24),
                 sizes(6, 0, 24, 0, 0, 12, 8, 20, 64, 32)},
  };
  return description;
}

std::unique_ptr<Method> make_moments(vulkan::Device& device) {
  return std::make_unique<Moments>(device);
}

}  // namespace cyanometer
