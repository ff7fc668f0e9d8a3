#include "engine/methods/bruneton/tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/methods/later_orders.h"
#include "engine/methods/moments/phase_series.h"
#include "engine/methods/orders.h"
#include "engine/methods/raymarch/raymarch.h"
#include "engine/methods/tables/fill.h"
#include "spirv/bruneton_cells.spv.h"
#include "spirv/bruneton_first.spv.h"
#include "spirv/bruneton_gather.spv.h"
#include "spirv/bruneton_irradiance.spv.h"
#include "spirv/bruneton_means.spv.h"
#include "spirv/bruneton_modes.spv.h"
#include "spirv/bruneton_order.spv.h"
#include "spirv/bruneton_redistribute.spv.h"
#include "spirv/bruneton_refine.spv.h"
#include "spirv/bruneton_single.spv.h"
#include "spirv/bruneton_source.spv.h"

namespace cyanometer::bruneton {
namespace {

constexpr std::uint32_t grid_bindings = UploadedScene::bindings + 2;
constexpr std::size_t vec4_bytes = 4 * sizeof(float);
/// Orders computed at the most; those beyond follow from the last ones.
constexpr int most_orders = 64;
constexpr int most_pieces = Physics<float>::MOST_PIECES;

struct CellsPush {
  std::int32_t first, end, cells;
};
struct FirstPush {
  std::int32_t first, end, view_nodes, pieces, fresh, last;
};
struct GatherPush {
  std::int32_t first, end, cells, with_ground, encode;
};
struct SlicePush {
  std::int32_t first, end, altitude, out_zeniths, out_azimuths;
};
struct RangePush {
  std::int32_t first, end;
};
struct RefinePush {
  std::int32_t first, end, rows, columns, inner, factor;
};
struct MeansPush {
  std::int32_t first, end, directions, chunks;
};
struct ModesPush {
  std::int32_t first, end, chunks;
};
struct OrderPush {
  std::int32_t first, end, places, directions, close, chunks;
  float largest_share;
};

/// Between an order and the one before: tables may gain light where they resolve a phase
/// function badly, and their series would have no end.
double most_ratio(const Problem& problem) {
  return std::min(1 - (1 - order_ratio(problem)) / 4, 0.999);
}

/// A buffer of so many vec4, if the device can bind it.
vulkan::Buffer table_buffer(vulkan::Device& device, std::size_t values,
                            const std::string& option, const std::string& what) {
  std::size_t bytes = std::max<std::size_t>(values, 1) * vec4_bytes;
  const vulkan::Limits& limits = device.limits();
  std::size_t most = std::min(limits.max_storage_range, limits.max_allocation);
  if (bytes > most) {
    throw OverLimit("/method/" + option, what + " would take " + std::to_string(bytes >> 20) +
                                             " MiB; this device binds " +
                                             std::to_string(most >> 20));
  }
  return {device, bytes, vulkan::Memory::device};
}

vulkan::Buffer scattering_buffer(vulkan::Device& device, const Rays& rays,
                                 std::size_t quantities) {
  return table_buffer(device, quantities * rays.texels(), "zeniths",
                      "a table of the scattering");
}

vulkan::Buffer grid_buffer(vulkan::Device& device, const ScatteringGrid& rays,
                           const ScatteringGrid& source) {
  std::array grids{rays, source};
  vulkan::Buffer buffer(device, sizeof grids, vulkan::Memory::device);
  buffer.write(0, vulkan::bytes_of(grids));
  return buffer;
}

vulkan::Buffer node_buffer(vulkan::Device& device, const std::vector<float>& nodes) {
  vulkan::Buffer buffer(device, nodes.size() * sizeof(float), vulkan::Memory::device);
  buffer.write(0, std::as_bytes(std::span(nodes)));
  return buffer;
}

std::size_t cell_values(const Rays& rays, int cells, int groups) {
  return static_cast<std::size_t>(rays.count()) * (cells + 1) * (2 + groups);
}

/// Refuses samples whose loops together are over the drivers' limit.
void expect_few_rounds(int cells, int rounds_of_one) {
  if (std::int64_t{cells} * rounds_of_one > most_loop_iterations) {
    throw OverLimit("/method/samples",
                    "in so many constituents a path has at most " +
                        std::to_string(most_loop_iterations / rounds_of_one) + " samples");
  }
}

/// What the tables of a request and the orders they hold depend on.
std::string table_key(const UploadedScene& scene, const Setup& setup) {
  return setup.key() + " " + std::to_string(scene.problem().scattering_orders) + " " +
         scene.air_key();
}

/// Up to most_orders of those that are asked for; of all, as many as the options say, or as it
/// takes until light is everywhere in the air, from where on a few modes fade. Five are quick.
int orders_to_compute(const Problem& problem, const Setup& setup) {
  int asked = problem.scattering_orders;
  if (asked >= 0) return std::min(asked, most_orders);
  if (setup.orders > 0) return std::max(setup.orders, 2);
  double through = 3 + 6 * std::min<double>(scattering_depth(problem), most_orders);
  return std::clamp(std::min(orders_until_geometric(problem), static_cast<int>(through)), 5,
                    most_orders);
}

/// The problem with peaks as wide as the source's directions can follow, where they are
/// narrower: they would fall between its nodes or be taken for as wide as one, and between two
/// suns be where they are under neither.
std::optional<Problem> with_wide_peaks(Problem problem, const Setup& setup) {
  // Half of what Henyey and Greenstein's function scatters stays within sqrt(3) (1 - g) rad:
  // not quite from one node to the next, then.
  double apart_rad = std::numbers::pi / 2 *
                     (1.0 / (setup.source_zeniths - 1) + 1.0 / (setup.source_azimuths - 1));
  double largest_g = std::max(1 - apart_rad / 3, 0.0);
  bool any = false;
  for (Medium& medium : problem.media) {
    double g = 0;
    for (const auto& series :
         legendre_coefficients(medium.phase, problem.wavelengths_nm.size(), 1))
      g = std::abs(series[1]) > std::abs(g) ? series[1] : g;
    if (std::abs(g) <= largest_g) continue;
    any = true;
    medium.phase = HenyeyGreenstein{std::copysign(largest_g, g)};
  }
  return any ? std::optional(std::move(problem)) : std::nullopt;
}

}  // namespace

UploadedRays::UploadedRays(vulkan::Device& device, const Rays& rays_,
                           const ScatteringGrid& source, int cells_, int groups)
    : rays(rays_),
      cells(cells_),
      grids(grid_buffer(device, rays_.grid, source)),
      nodes(node_buffer(device, rays_.nodes)),
      cell_values(table_buffer(device, bruneton::cell_values(rays_, cells_, groups), "samples",
                               "the samples of all rays")) {}

SourceTables::SourceTables(vulkan::Device& device, const ScatteringGrid& grid_, int groups)
    : grid(grid_),
      source(table_buffer(
          device,
          std::size_t{1} * grid.altitudes * grid.suns * grid.zeniths * grid.azimuths * groups,
          "source_zeniths", "the table of the source")),
      irradiance(table_buffer(device, std::size_t{1} * grid.suns * groups, "suns",
                              "the table of irradiance")) {}

vulkan::Specialization table_constants(const UploadedScene& scene, const Setup& setup) {
  constexpr std::size_t near_sun = 8, many_suns = 9;
  vulkan::Specialization constants = scene.constants();
  constants[near_sun] = constants[many_suns] = 0;
  constants.push_back(setup.logarithmic);
  constants.push_back(0);
  constants.push_back(0);
  constants.push_back(setup.first != Setup::First::reconstructed);
  return constants;
}

vulkan::Specialization view_constants(const UploadedScene& scene, const Setup& setup,
                                      const Rays& rays) {
  vulkan::Specialization constants = scene.constants();
  constants.push_back(setup.logarithmic);
  constants.push_back(rays.grid.suns == 1 ? 1 : 2);
  constants.push_back(rays.grid.altitudes == 1 ? 1 : 2);
  constants.push_back(setup.first != Setup::First::reconstructed);
  return constants;
}

TableMaker::TableMaker(vulkan::Device& device)
    : cells_(device, bruneton_cells_spirv, grid_bindings + 1, sizeof(CellsPush)),
      first_(device, bruneton_first_spirv, grid_bindings + 2, sizeof(FirstPush)),
      gather_(device, bruneton_gather_spirv, grid_bindings + 4, sizeof(GatherPush)),
      redistribute_(device, bruneton_redistribute_spirv, grid_bindings + 1, sizeof(SlicePush)),
      source_(device, bruneton_source_spirv, grid_bindings + 3, sizeof(SlicePush)),
      irradiance_(device, bruneton_irradiance_spirv, grid_bindings + 2, sizeof(RangePush)),
      order_(device, bruneton_order_spirv, grid_bindings + 5, sizeof(OrderPush)),
      means_(device, bruneton_means_spirv, grid_bindings + 5, sizeof(MeansPush)),
      modes_(device, bruneton_modes_spirv, grid_bindings + 1, sizeof(ModesPush)),
      refine_(device, bruneton_refine_spirv, grid_bindings + 2, sizeof(RefinePush)),
      single_(device, bruneton_single_spirv, grid_bindings + 3, sizeof(CellsPush)) {}

namespace {

// Evaluations of the density that one invocation of each kernel is worth.
std::int64_t for_cells(std::int64_t media, int cells) { return 4 * cells * (media + 1); }
std::int64_t for_redistribution(std::int64_t media) { return 4 * (media + 1); }
std::int64_t for_source(std::int64_t incoming, std::int64_t groups) {
  return incoming * groups / 2 + 1;
}
std::int64_t for_gathering(int cells, std::int64_t groups) { return 16 * cells * (1 + groups); }

}  // namespace

bool has_multiple(const Problem& problem) {
  bool asked = problem.scattering_orders < 0 || problem.scattering_orders > 1;
  return asked && std::ranges::any_of(problem.media, [](const Medium& medium) {
           return std::ranges::max(medium.scattering_per_km) > 0;
         });
}

double evaluations(const Problem& problem, const Setup& setup) {
  std::int64_t media = std::ssize(problem.media);
  std::int64_t groups = (std::ssize(problem.wavelengths_nm) + 3) / 4;
  double incoming = setup.zeniths * setup.azimuths;
  double outgoing = setup.source_zeniths * setup.source_azimuths;
  double places = setup.altitudes * setup.suns, orders = orders_to_compute(problem, setup);
  auto times = [](double count, std::int64_t each) {
    return count * static_cast<double>(each);
  };
  auto integral = static_cast<std::int64_t>(incoming);
  return times(places * incoming, march_evaluations(media, setup.view_nodes)) +
         (orders - 1) *
             (times(places * outgoing, for_source(integral, groups)) +
              times(setup.altitudes * incoming * outgoing, for_redistribution(media))) +
         (orders - 2) * times(places * incoming, for_gathering(setup.cells, groups));
}

/// One making of tables.
struct TableMaker::Work {
  Tracer& tracer;
  const UploadedScene& scene;
  const Setup& setup;
  vulkan::Specialization constants = table_constants(scene, setup);

  /// Runs a kernel over `entries`, each worth so many evaluations of the density.
  template <class Push>
  void fill(const vulkan::Kernel& kernel, const UploadedRays& rays,
            std::initializer_list<vulkan::Binding> own, std::int64_t entries,
            std::int64_t evaluations, Push push) const {
    std::vector<vulkan::Binding> bindings = bind(rays, own);
    fill_table(tracer, {kernel, constants, bindings}, static_cast<int>(entries), evaluations,
               push);
  }
  std::vector<vulkan::Binding> bind(const UploadedRays& rays,
                                    std::initializer_list<vulkan::Binding> own) const {
    std::vector<vulkan::Binding> all = scene.bind({rays.grids, rays.nodes});
    for (const vulkan::Binding& binding : own) all.push_back(binding);
    return all;
  }
};

UploadedRays TableMaker::cut(const Work& work, const Rays& rays, int cells) {
  const UploadedScene& scene = work.scene;
  expect_few_rounds(cells, 4 * scene.density_iterations());
  UploadedRays uploaded(work.tracer.device, rays, source_grid(scene.problem(), work.setup),
                        cells, scene.groups());
  work.fill(cells_, uploaded, {uploaded.cell_values}, rays.count(),
            for_cells(scene.media(), cells), CellsPush{0, 0, cells});
  return uploaded;
}

void TableMaker::find_first_order(const Work& work, const UploadedRays& rays,
                                  const vulkan::Buffer& to) {
  constexpr int most = 1 << 14;  // texels whose progress is kept between two dispatches
  Tracer& tracer = work.tracer;
  int view_nodes = work.setup.view_nodes;
  int pieces = march_pieces_at_once(work.scene, view_nodes);
  std::int64_t evaluations = march_evaluations(work.scene.media(), view_nodes);
  vulkan::Buffer progress(tracer.device, most * sizeof(float), vulkan::Memory::device);
  std::vector<vulkan::Binding> bindings = work.bind(rays, {to, progress});
  FirstPush push{0, 0, view_nodes, pieces, 0, 0};
  for (; push.first < rays.rays.texels(); push.first = push.end) {
    std::int64_t fit = tracer.pacer.evaluations() / evaluations / 64 * 64;
    int count = static_cast<int>(std::clamp<std::int64_t>(fit, 64, most));
    push.end = std::min(rays.rays.texels(), push.first + count);
    for (int done = 0; done < most_pieces; done += pieces) {
      push.fresh = done == 0;
      push.last = done + pieces >= most_pieces;
      tracer.commands.dispatch(first_, work.constants, bindings, vulkan::bytes_of(push),
                               {vulkan::groups_for(count, 64)});
      tracer.pacer.took(evaluations * (push.end - push.first), tracer.submit());
    }
  }
}

/// How light is redistributed between directions at each altitude: the same for all orders, and
/// kept where there is room.
struct TableMaker::Shares {
  Shares(const Work& work, const UploadedRays& rays)
      : pairs(std::int64_t{1} * rays.rays.directions() * work.setup.source_zeniths *
              work.setup.source_azimuths),
        slice_bytes(aligned(static_cast<std::size_t>(pairs) * work.scene.groups() * vec4_bytes,
                            work.tracer.device.limits().storage_alignment)),
        kept(slice_bytes * rays.rays.grid.altitudes <= most_kept_bytes),
        buffer(table_buffer(work.tracer.device,
                            slice_bytes / vec4_bytes * (kept ? rays.rays.grid.altitudes : 1),
                            "source_zeniths", "the redistribution between directions")) {}

  vulkan::Binding slice(int altitude) const {
    return {buffer, kept ? altitude * slice_bytes : 0, slice_bytes};
  }

  static constexpr std::size_t most_kept_bytes = 64 << 20;
  std::int64_t pairs;  ///< of directions
  std::size_t slice_bytes;
  bool kept;
  vulkan::Buffer buffer;
  bool filled = false;  ///< with all that are kept

 private:
  static std::size_t aligned(std::size_t bytes, std::size_t alignment) {
    return (bytes + alignment - 1) / alignment * alignment;
  }
};

void TableMaker::find_source(const Work& work, const UploadedRays& rays, Shares& shares,
                             const vulkan::Buffer& radiance, const vulkan::Buffer& to) {
  const Setup& setup = work.setup;
  int outgoing = setup.source_zeniths * setup.source_azimuths;
  for (int altitude = 0; altitude < rays.rays.grid.altitudes; ++altitude) {
    const SlicePush push{0, 0, altitude, setup.source_zeniths, setup.source_azimuths};
    const vulkan::Binding slice = shares.slice(altitude);
    if (!shares.filled)
      work.fill(redistribute_, rays, {slice}, shares.pairs,
                for_redistribution(work.scene.media()), push);
    work.fill(source_, rays, {slice, radiance, to},
              std::int64_t{1} * outgoing * rays.rays.grid.suns,
              for_source(rays.rays.directions(), work.scene.groups()), push);
  }
  shares.filled = shares.kept;
}

void TableMaker::find_irradiance(const Work& work, const UploadedRays& rays,
                                 const vulkan::Buffer& radiance, const vulkan::Buffer& to) {
  work.fill(irradiance_, rays, {radiance, to}, rays.rays.grid.suns,
            for_source(rays.rays.directions(), work.scene.groups()), RangePush{0, 0});
}

/// A quantity over altitudes, suns and directions by order, summed over orders, and what of it
/// is interpolated.
struct TableMaker::OrderSum {
  /// Nodes, of each group of wavelengths.
  struct Size {
    int groups, altitudes, suns, zeniths, azimuths;

    int directions() const { return zeniths * azimuths; }
    std::size_t bytes() const {
      return vec4_bytes * groups * altitudes * suns * zeniths * azimuths;
    }
  };
  OrderSum(Tracer& tracer_, const vulkan::Buffer& result_, const Size& size_,
           const Setup& setup, int chunks)
      : tracer(tracer_),
        result(result_),
        size(size_),
        order(tracer.device, size.bytes(), vulkan::Memory::device),
        sum(tracer.device, size.bytes(), vulkan::Memory::device),
        earlier(table_buffer(tracer.device, size.bytes() / vec4_bytes * chunks,
                             "source_zeniths", "the sums of earlier orders")),
        encoded(tracer.device, size.bytes(), vulkan::Memory::device),
        in_directions(tracer.device,
                      size.bytes() / size.directions() * setup.refined(size.zeniths) *
                          setup.refined(size.azimuths),
                      vulkan::Memory::device) {
    tracer.commands.fill(sum, 0);
    tracer.commands.fill(earlier, 0);
  }

  /// Keeps the sum so far, where a chunk of orders begins.
  void keep(int chunk) {
    tracer.commands.copy({sum, 0, size.bytes()}, {earlier, chunk * size.bytes(), size.bytes()});
  }

  Tracer& tracer;
  const vulkan::Buffer& result;
  Size size;
  vulkan::Buffer order, sum;
  vulkan::Buffer earlier;  ///< sums, where chunks of orders begin
  vulkan::Buffer encoded;
  vulkan::Buffer in_directions;  ///< refined in directions alone
};

/// By how much chunks of orders weigh in all that come after them.
struct TableMaker::Closing {
  LaterOrders later;
  float largest_share;  ///< of a chunk in the one before
  vulkan::Buffer
      weights;  ///< and what they are found from, shaders/methods/bruneton/chunks.glsl
};

void TableMaker::weigh_chunks(const Work& work, const UploadedRays& rays,
                              const OrderSum& source, const OrderSum& irradiance,
                              const Closing& closing) {
  int directions = source.size.directions(), chunks = closing.later.chunks;
  int sums = rays.rays.grid.suns * work.scene.groups();
  work.fill(means_, rays,
            {source.sum, source.earlier, irradiance.sum, irradiance.earlier, closing.weights},
            std::int64_t{1} * (rays.rays.grid.altitudes + 1) * sums, chunks * directions,
            MeansPush{0, 0, directions, chunks});
  work.fill(modes_, rays, {closing.weights}, sums, 8 * chunks * chunks * source.size.altitudes,
            ModesPush{0, 0, chunks});
}

void TableMaker::add_or_close(const Work& work, const UploadedRays& rays, const OrderSum& sum,
                              const Closing& closing, Leave what) {
  const OrderSum::Size& size = sum.size;
  work.fill(order_, rays, {sum.order, sum.sum, sum.earlier, closing.weights, sum.encoded},
            std::int64_t{1} * size.groups * size.altitudes * size.directions(), 2 * size.suns,
            OrderPush{0, 0, size.altitudes, size.directions(), what == Leave::all_orders,
                      closing.later.chunks, closing.largest_share});
}

void TableMaker::refine(const Work& work, const UploadedRays& rays, const OrderSum& sum) {
  const OrderSum::Size& size = sum.size;
  auto fill = [&](const vulkan::Buffer& from, const vulkan::Buffer& to, int rows, int columns,
                  int inner) {
    constexpr int evaluations = 16;
    work.fill(refine_, rays, {from, to}, static_cast<std::int64_t>(to.size() / vec4_bytes),
              evaluations, RefinePush{0, 0, rows, columns, inner, work.setup.refinement});
  };
  fill(sum.encoded, sum.in_directions, size.zeniths, size.azimuths, 1);
  fill(sum.in_directions, sum.result, size.altitudes, size.suns,
       work.setup.refined(size.zeniths) * work.setup.refined(size.azimuths));
}

void TableMaker::gather(const Work& work, const UploadedRays& rays, const SourceTables& from,
                        Gather what, const vulkan::Buffer& to) {
  int groups = work.scene.groups();
  bool view = what == Gather::view_without_ground;
  work.fill(gather_, rays, {rays.cell_values, from.source, from.irradiance, to},
            rays.rays.texels(), for_gathering(rays.cells, groups),
            GatherPush{0, 0, rays.cells, !view, view});
}

std::shared_ptr<const SourceTables> TableMaker::make_source(Work work) {
  for (const vulkan::Kernel* kernel : {&cells_, &first_, &gather_, &redistribute_, &source_,
                                       &irradiance_, &order_, &refine_}) {
    kernel->prepare(work.constants);
  }
  vulkan::Device& device = work.tracer.device;
  const Problem& problem = work.scene.problem();
  int groups = work.scene.groups();
  UploadedRays rays = cut(work, all_rays(problem, work.setup), work.setup.cells);
  const ScatteringGrid grid = source_grid(problem, work.setup);
  vulkan::Buffer radiance = scattering_buffer(device, rays.rays, groups);
  auto tables = std::make_shared<SourceTables>(device, grid, groups);
  const Setup& setup = work.setup;
  int last = orders_to_compute(problem, setup);
  bool ends = problem.scattering_orders >= 0 && problem.scattering_orders <= last;
  const LaterOrders later = ends ? LaterOrders{} : LaterOrders::after(last - 1);
  const Closing closing{
      later,
      static_cast<float>(std::pow(most_ratio(problem), later.each)),
      {device,
       vec4_bytes * LaterOrders::most_chunks * (setup.altitudes + 2) * setup.suns * groups,
       vulkan::Memory::device}};
  OrderSum source(
      work.tracer, tables->source,
      {groups, setup.altitudes, setup.suns, setup.source_zeniths, setup.source_azimuths}, setup,
      later.chunks);
  OrderSum irradiance(work.tracer, tables->irradiance, {groups, 1, setup.suns, 1, 1}, setup,
                      later.chunks);

  Shares shares(work, rays);
  find_first_order(work, rays, radiance);
  for (int order = 2;; ++order) {
    find_irradiance(work, rays, radiance, irradiance.order);
    find_source(work, rays, shares, radiance, source.order);
    for (OrderSum* sum : {&irradiance, &source}) {
      add_or_close(work, rays, *sum, closing, Leave::one_order);
      if (auto chunk = later.begins_after(order, last)) sum->keep(*chunk);
    }
    if (order == last) break;
    for (OrderSum* sum : {&irradiance, &source}) refine(work, rays, *sum);
    gather(work, rays, *tables, Gather::radiance_with_ground, radiance);
  }
  if (later.chunks > 0) weigh_chunks(work, rays, source, irradiance, closing);
  for (OrderSum* sum : {&irradiance, &source}) {
    add_or_close(work, rays, *sum, closing, Leave::all_orders);
    refine(work, rays, *sum);
  }
  return tables;
}

std::shared_ptr<const ViewTable> TableMaker::make_view(Work work) {
  auto tables = source(work.tracer, work.scene, work.setup);
  const Problem& problem = work.scene.problem();
  bool in_space = problem.camera.altitude_km > problem.thickness_km;
  Rays rays = !work.setup.gathered_view ? all_rays(problem, work.setup)
              : in_space                ? rays_from_space(problem, work.setup)
                         : rays_from(problem, work.setup, problem.camera.altitude_km,
                                     problem.sun_direction[2]);
  UploadedRays uploaded =
      cut(work, rays, work.setup.gathered_view ? work.setup.view_cells : work.setup.cells);
  vulkan::Buffer values = scattering_buffer(work.tracer.device, rays, work.scene.groups());
  gather(work, uploaded, *tables, Gather::view_without_ground, values);
  return std::make_shared<ViewTable>(std::move(uploaded), std::move(values));
}

std::shared_ptr<const SingleTable> TableMaker::make_single(Work work) {
  vulkan::Device& device = work.tracer.device;
  int groups = work.scene.groups(), media = std::max(work.scene.media(), 1);
  bool separate = work.setup.first == Setup::First::separate;
  expect_few_rounds(work.setup.cells,
                    work.scene.density_iterations() + 2 * (media + work.scene.profile_nodes()));
  UploadedRays rays = cut(work, all_rays(work.scene.problem(), work.setup), work.setup.cells);
  vulkan::Buffer values =
      scattering_buffer(device, rays.rays, separate ? media * groups : groups);
  // Four values of one wavelength in the room of a group's.
  vulkan::Buffer particles =
      table_buffer(device, separate ? 1 : std::size_t{1} * media * rays.rays.texels() / 4 + 1,
                   "zeniths", "a table of particles");
  work.fill(single_, rays, {rays.cell_values, values, particles}, rays.rays.texels(),
            rays.cells * std::int64_t{12} * media, CellsPush{0, 0, rays.cells});
  return std::make_shared<SingleTable>(std::move(rays), std::move(values),
                                       std::move(particles));
}

std::shared_ptr<const SourceTables> TableMaker::source(Tracer& tracer,
                                                       const UploadedScene& scene,
                                                       const Setup& setup) {
  return tracer.tables.get<SourceTables>("bruneton source " + table_key(scene, setup), [&] {
    const std::optional<Problem> wide = with_wide_peaks(scene.problem(), setup);
    if (!wide) return make_source({tracer, scene, setup});
    UploadedScene uploaded(tracer.device, *wide);
    return make_source({tracer, uploaded, setup});
  });
}

std::shared_ptr<const ViewTable> TableMaker::view(Tracer& tracer, const UploadedScene& scene,
                                                  const Setup& setup) {
  const Problem& problem = scene.problem();
  std::string key = "bruneton view " + std::to_string(setup.view_cells) + " ";
  if (setup.gathered_view) {
    bool in_space = problem.camera.altitude_km > problem.thickness_km;
    std::array<double, 2> place{problem.camera.altitude_km, problem.sun_direction[2]};
    if (!in_space) key.append(reinterpret_cast<const char*>(place.data()), sizeof place);
    key += in_space ? "space " : " ";
  }
  return tracer.tables.get<ViewTable>(key + table_key(scene, setup), [&] {
    return make_view({tracer, scene, setup});
  });
}

std::shared_ptr<const SingleTable> TableMaker::single(Tracer& tracer,
                                                      const UploadedScene& scene,
                                                      const Setup& setup) {
  return tracer.tables.get<SingleTable>("bruneton single " + table_key(scene, setup), [&] {
    return make_single({tracer, scene, setup});
  });
}

}  // namespace cyanometer::bruneton
