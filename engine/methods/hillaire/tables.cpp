#include "engine/methods/hillaire/tables.h"

#include <algorithm>
#include <array>

#include "engine/methods/hillaire/forward_peak.h"
#include "engine/methods/tables/fill.h"
#include "engine/optics/profile.h"
#include "spirv/hillaire_columns.spv.h"
#include "spirv/hillaire_irradiance.spv.h"
#include "spirv/hillaire_multiple.spv.h"
#include "spirv/hillaire_sky.spv.h"
#include "spirv/hillaire_sum.spv.h"

namespace cyanometer::hillaire {
namespace {

constexpr std::size_t vec4_bytes = 16;
constexpr std::size_t phase_tables_constant = 31;  // shaders/device.glsl
constexpr int view_nodes = 2 * 2048;               // shaders/methods/hillaire/view.glsl

/// The sky's irradiance needs more directions than isotropic light: phase functions have peaks.
constexpr int irradiance_directions = 4;

struct SpherePush {
  std::int32_t first, end, first_direction, end_direction, directions, samples, terms;
  float scale_height_km;
};
struct SumPush {
  std::int32_t first, end;
};
struct ColumnPush {
  std::int32_t first, end, first_medium, end_medium;
  float altitude_km;
};
struct SkyViewPush {
  std::int32_t first, end, samples, all_orders;
  float scale_height_km;
};

/// Terms of the series that orders two and up are; -1 all.
int terms(const Sizes& sizes) { return sizes.orders < 0 ? -1 : std::max(sizes.orders - 1, 0); }

bool has_phase_tables(const Problem& problem) {
  return std::any_of(problem.media.begin(), problem.media.end(), [](const Medium& medium) {
    return std::holds_alternative<TabulatedPhase>(medium.phase);
  });
}

template <class... Values>
std::string key(const char* name, const UploadedScene& scene, Values... values) {
  std::string key = name;
  ((key += " " + std::to_string(values)), ...);
  return key + " " + scene.air_key();
}

std::string bytes_of_float(double value) {
  auto bytes = std::bit_cast<std::array<char, sizeof(float)>>(static_cast<float>(value));
  return {bytes.data(), bytes.size()};
}

/// Where the rays of the view begin.
double start_altitude_km(const Problem& problem) {
  return std::min(problem.camera.altitude_km, problem.thickness_km);
}

/// Entries that sum over directions: as many directions a dispatch as loops and pacer allow.
void fill_over_directions(Tracer& tracer, const UploadedScene& scene, const Filling& filling,
                          int entries, SpherePush push) {
  std::int64_t nodes = most_nodes(push.samples);
  std::int64_t rounds = nodes * (scene.density_iterations() + 2) + scene.media() * 16;
  std::int64_t direction = nodes * evaluations_per_node(scene);
  std::int64_t some = std::min<std::int64_t>(entries, 1024) * direction;
  std::int64_t fit =
      std::clamp<std::int64_t>(tracer.pacer.evaluations() / some, 1,
                               std::max<std::int64_t>(usual_loop_iterations / rounds, 1));
  for (int first = 0; first < push.directions; first = push.end_direction) {
    push.first_direction = first;
    push.end_direction = static_cast<int>(std::min<std::int64_t>(push.directions, first + fit));
    fill_table(tracer, filling, entries, direction * (push.end_direction - first), push);
  }
}

}  // namespace

Sizes Sizes::of(const MethodOptions& options, int orders) {
  auto option = [&](const char* name) { return static_cast<int>(options.at(name)); };
  return {{option("transmittance_cosines"), option("transmittance_altitudes")},
          option("multiple_suns"),
          option("multiple_altitudes"),
          option("multiple_directions"),
          option("multiple_samples"),
          option("sky_azimuths"),
          option("sky_elevations"),
          option("view_samples"),
          options.at("forward_share"),
          orders,
          1,
          {}};
}

Sizes Sizes::of_parts() const {
  constexpr int most_azimuths = 48, most_elevations = 96, many_stops = 32;
  Sizes parts = *this;
  parts.azimuths = std::min(azimuths, most_azimuths);
  parts.elevations = std::min(elevations, most_elevations);
  parts.stops = many_stops;
  return parts;
}

AirTables::AirTables(vulkan::Device& device, const Sizes& sizes, int media, int groups)
    : kept(device, vec4_bytes * std::max(media, 1) * groups, vulkan::Memory::device),
      log_multiple(device, vec4_bytes * sizes.multiple_suns * sizes.multiple_altitudes * groups,
                   vulkan::Memory::device),
      log_irradiance(device, vec4_bytes * sizes.multiple_suns * groups,
                     vulkan::Memory::device) {}

ViewColumns::ViewColumns(vulkan::Device& device, int media)
    : values(device, sizeof(float) * view_nodes * std::max(media, 1), vulkan::Memory::device) {}

SkyView::SkyView(vulkan::Device& device, std::size_t bytes)
    : values(device, bytes, vulkan::Memory::device) {}

std::size_t SkyView::bytes_of(const UploadedScene& scene, const Sizes& sizes) {
  auto scatters = [](const Medium& medium) {
    return std::any_of(medium.scattering_per_km.begin(), medium.scattering_per_km.end(),
                       [](double s) { return s > 0; });
  };
  const std::vector<Medium>& media = scene.problem().media;
  std::size_t planes = 1 + std::count_if(media.begin(), media.end(), scatters);
  return vec4_bytes * sizes.azimuths * sizes.elevations * sizes.stops * planes * scene.groups();
}

TableMaker::TableMaker(vulkan::Device& device)
    : optical_depths_(device),
      multiple_(device, hillaire_multiple_spirv, UploadedScene::bindings + 3,
                sizeof(SpherePush)),
      irradiance_(device, hillaire_irradiance_spirv, UploadedScene::bindings + 4,
                  sizeof(SpherePush)),
      sum_(device, hillaire_sum_spirv, UploadedScene::bindings + 4, sizeof(SumPush)),
      columns_(device, hillaire_columns_spirv, UploadedScene::bindings + 5, sizeof(ColumnPush)),
      sky_(device, hillaire_sky_spirv, UploadedScene::bindings + 6, sizeof(SkyViewPush)) {}

TablesOfView TableMaker::get(Tracer& tracer, const UploadedScene& scene, const Sizes& sizes,
                             bool with_sky) {
  const Problem& problem = scene.problem();
  TablesOfView tables;
  std::string air =
      key("hillaire air", scene, sizes.optical_depth.cosines, sizes.optical_depth.altitudes,
          sizes.multiple_suns, sizes.multiple_altitudes, sizes.directions,
          sizes.multiple_samples, sizes.forward_share, terms(sizes));
  for (double share : sizes.straight_on) air += bytes_of_float(share);
  tables.air = tracer.tables.get<AirTables>(air, [&] {
    prepare(constants(scene, sizes), sizes.several_orders(), with_sky);
    return make_air(tracer, scene, sizes);
  });
  std::string altitude = bytes_of_float(start_altitude_km(problem));
  tables.columns = tracer.tables.get<ViewColumns>(
      "view columns " + altitude + scene.air_key(),
      [&] { return make_columns(tracer, scene, sizes, tables); });
  if (!with_sky) return tables;
  std::string sky = "hillaire sky " + altitude + bytes_of_float(problem.sun_direction[2]);
  for (int size : {sizes.azimuths, sizes.elevations, sizes.view_samples, sizes.stops}) {
    sky += " " + std::to_string(size);
  }
  tables.sky = tracer.tables.get<SkyView>(
      sky + " " + air, [&] { return make_sky(tracer, scene, sizes, tables); });
  return tables;
}

void TableMaker::prepare(const vulkan::Specialization& specialization, bool several_orders,
                         bool with_sky) const {
  for (const vulkan::Kernel* kernel : {&multiple_, &irradiance_, &sum_}) {
    if (several_orders) kernel->prepare(specialization);
  }
  columns_.prepare(specialization);
  if (with_sky) sky_.prepare(specialization);
}

std::shared_ptr<const AirTables> TableMaker::make_air(Tracer& tracer,
                                                      const UploadedScene& scene,
                                                      const Sizes& sizes) {
  auto tables =
      std::make_shared<AirTables>(tracer.device, sizes, scene.media(), scene.groups());
  const Problem& problem = scene.problem();
  Problem scaled =
      without_forward_peak(problem, sizes.several_orders() ? sizes.forward_share : 0);
  std::vector<glm::vec4> kept = sizes.straight_on.empty()
                                    ? scattering_kept(problem, scaled)
                                    : scattering_kept(problem, sizes.straight_on);
  if (!kept.empty()) tables->kept.write(0, std::as_bytes(std::span(kept)));
  tables->optical_depth =
      optical_depths_.get(tracer, UploadedScene(tracer.device, scaled), sizes.optical_depth);
  if (!sizes.several_orders()) return tables;  // nothing reads them
  vulkan::Buffer parts(tracer.device, 3 * tables->log_multiple.size(), vulkan::Memory::device);
  vulkan::Buffer suns(tracer.device, 2 * tables->log_irradiance.size(), vulkan::Memory::device);
  vulkan::Specialization specialization = constants(scene, sizes);
  int texels = sizes.multiple_suns * sizes.multiple_altitudes;
  int series = terms(sizes);
  float height_km = scale_height_km(problem);

  auto multiple = scene.bind({tables->optical_depth->values(), tables->kept, parts});
  fill_over_directions(
      tracer, scene, {multiple_, specialization, multiple}, texels,
      {0, 0, 0, 0, sizes.directions, sizes.multiple_samples, series, height_km});
  auto irradiance = scene.bind({tables->optical_depth->values(), tables->kept, parts, suns});
  fill_over_directions(
      tracer, scene, {irradiance_, specialization, irradiance}, sizes.multiple_suns,
      {0, 0, 0, 0, irradiance_directions * sizes.directions, sizes.multiple_samples,
       series < 0 ? series : std::max(series - 1, 0), height_km});
  auto sum = scene.bind({parts, suns, tables->log_multiple, tables->log_irradiance});
  fill_table(tracer, {sum_, specialization, sum}, texels, 1, SumPush{});
  return tables;
}

std::shared_ptr<const ViewColumns> TableMaker::make_columns(Tracer& tracer,
                                                            const UploadedScene& scene,
                                                            const Sizes& sizes,
                                                            const TablesOfView& tables) {
  auto columns = std::make_shared<ViewColumns>(tracer.device, scene.media());
  vulkan::Specialization specialization = constants(scene, sizes);
  auto bindings = bind(scene, *tables.air, {columns->values});
  const Problem& problem = scene.problem();
  int media = scene.media(), at_once = std::min(columns_at_once(problem), media);
  for (int medium = 0; medium < media; medium += at_once) {
    ColumnPush push{0, 0, medium, std::min(media, medium + at_once),
                    static_cast<float>(start_altitude_km(problem))};
    fill_table(tracer, {columns_, specialization, bindings}, view_nodes,
               evaluations_per_column(problem) * at_once, push);
  }
  return columns;
}

std::shared_ptr<const SkyView> TableMaker::make_sky(Tracer& tracer, const UploadedScene& scene,
                                                    const Sizes& sizes,
                                                    const TablesOfView& tables) {
  auto sky = std::make_shared<SkyView>(tracer.device, SkyView::bytes_of(scene, sizes));
  vulkan::Specialization specialization = constants(scene, sizes);
  auto bindings = bind(scene, *tables.air, {tables.columns->values, sky->values});
  SkyViewPush push{0, 0, sizes.view_samples, sizes.several_orders(),
                   scale_height_km(scene.problem())};
  fill_table(tracer, {sky_, specialization, bindings},
             sizes.azimuths * sizes.elevations * sizes.stops,
             2 * most_nodes(sizes.view_samples) * evaluations_per_node(scene), push);
  return sky;
}

std::vector<vulkan::Binding> bind(const UploadedScene& scene, const AirTables& air,
                                  std::initializer_list<vulkan::Binding> own) {
  std::vector<vulkan::Binding> all =
      scene.bind({air.optical_depth->values(), air.kept, air.log_multiple, air.log_irradiance});
  for (const vulkan::Binding& binding : own) all.push_back(binding);
  return all;
}

vulkan::Specialization constants(const UploadedScene& scene, const Sizes& sizes) {
  vulkan::Specialization all = OpticalDepthTable::constants(scene, sizes.optical_depth);
  for (int size : {sizes.multiple_suns, sizes.multiple_altitudes, sizes.azimuths,
                   sizes.elevations, sizes.stops}) {
    all.push_back(static_cast<std::uint32_t>(size));
  }
  all.resize(phase_tables_constant);
  all.push_back(has_phase_tables(scene.problem()));
  return all;
}

std::int64_t most_nodes(int samples) { return samples + samples / 2 + 12; }

std::int64_t evaluations_per_node(const UploadedScene& scene) {
  return 8 + scene.media() * (1 + scene.groups()) + 8 * scene.groups();
}

float scale_height_km(const Problem& problem) {
  double height_km = problem.thickness_km;
  for (const Medium& medium : problem.media) {
    if (std::ranges::max(medium.scattering_per_km) > 0)
      height_km = std::min(height_km, column_km(medium.profile, problem.thickness_km));
  }
  return static_cast<float>(std::max(height_km, 1e-3 * problem.thickness_km));
}

}  // namespace cyanometer::hillaire
