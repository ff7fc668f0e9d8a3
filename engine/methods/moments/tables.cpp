#include "engine/methods/moments/tables.h"

#include <algorithm>
#include <span>

#include "engine/methods/later_orders.h"
#include "engine/methods/moments/grid.h"
#include "spirv/moments_close.spv.h"
#include "spirv/moments_first.spv.h"
#include "spirv/moments_modes.spv.h"
#include "spirv/moments_next.spv.h"
#include "spirv/moments_order.spv.h"
#include "spirv/moments_project.spv.h"
#include "spirv/moments_rays.spv.h"
#include "spirv/moments_refine.spv.h"
#include "spirv/moments_rows.spv.h"

namespace cyanometer {
namespace {

using Grid = MomentTables::Grid;

/// shaders/methods/moments_device.glsl
struct MomentPush {
  Grid grid;
  std::int32_t fine_altitudes, up, down, steps, first_steps, first, end, each_azimuth,
      first_azimuth, end_azimuth, first_altitude, chunks;
};
struct RefinePush {
  MomentSolver::Axis axis;
  std::int32_t first, end;
};

/// Nodes of a finer table that linear interpolation reads as if it were cubic.
int nodes_of_finer(int nodes, int most) {
  return (nodes - 1) * std::clamp(most / (nodes - 1), 1, 4) + 1;
}
int finer_altitudes(int nodes) { return nodes_of_finer(nodes, 64); }
int finer_suns(int nodes) { return nodes_of_finer(nodes, 128); }

int slots_of(int degree) { return (degree + 1) * (degree + 2) / 2 + 1; }

constexpr std::size_t value_bytes = 16;

vulkan::Specialization solution_constants(const UploadedScene& scene,
                                          const MomentSettings& settings, bool particles) {
  vulkan::Specialization constants = moment_constants(scene, settings.degree, particles);
  constants.push_back(static_cast<std::uint32_t>(settings.azimuths));
  return constants;
}

/// One solution: its sizes, its buffers, its passes.
class Solution {
 public:
  Solution(Tracer& tracer, const UploadedScene& scene, const MomentSettings& settings,
           vulkan::Specialization constants, MomentTables& tables)
      : tracer_(tracer),
        scene_(scene),
        settings_(settings),
        later_(settings.tail ? LaterOrders::after(settings.orders) : LaterOrders{}),
        grid_(tables.grid),
        tables_(tables),
        constants_(std::move(constants)),
        groups_(scene.groups()),
        up_(settings.directions),
        down_(std::max(settings.directions / 2, 3)),
        rows_at_once_(static_cast<int>(
            std::clamp<std::int64_t>(most_row_values / row_values(), 1, settings.altitudes))),
        rays_(tracer.device, ray_values() * value_bytes, vulkan::Memory::device),
        light_(tracer.device, light_values() * value_bytes, vulkan::Memory::device),
        moments_(tracer.device, moment_values() * value_bytes, vulkan::Memory::device),
        rows_(tracer.device, rows_at_once_ * row_values() * value_bytes,
              vulkan::Memory::device),
        order_(tracer.device, order_values() * value_bytes, vulkan::Memory::device),
        work_(tracer) {
    tracer.commands.fill(moments_, 0);
  }

  void trace_rays(const vulkan::Kernel& kernel) {
    run(kernel, grid_.altitudes * rays(), 40 * media() * (settings_.steps + 1), push());
  }

  void trace_first_order(const vulkan::Kernel& kernel) {
    // A part of a ray on either side of the shadow, and the series of phase functions.
    int series = (2 * settings_.degree + 3) * scene_.media() *
                 (scene_.problem().sun_distance_km > 0 ? first_steps() : 1);
    int rounds =
        2 * (rounds_of_a_piece(scene_, first_steps()) + series) + 4 * settings_.degree + 2;
    require_rounds(scene_, rounds);
    MomentPush part = push();
    // Under a near sun the scattering angle changes along a ray.
    part.each_azimuth = scene_.problem().sun_distance_km > 0 ||
                        settings_.azimuths * rounds > usual_loop_iterations;
    int at_once =
        part.each_azimuth ? std::max(usual_loop_iterations / rounds, 1) : settings_.azimuths;
    for (int first = 0; first < settings_.azimuths; first += at_once) {
      part.first_azimuth = first;
      part.end_azimuth = std::min(first + at_once, settings_.azimuths);
      int azimuths = part.each_azimuth ? part.end_azimuth - first : 2;
      run(kernel, grid_.altitudes * rays() * grid_.suns,
          std::int64_t{azimuths} * first_steps() * 12 * media() + 30 * settings_.azimuths,
          part);
    }
  }

  void project(const vulkan::Kernel& kernel) {
    run(kernel, grid_.altitudes * grid_.suns * groups_, 4 * rays() * (settings_.degree + 2),
        push());
  }

  /// Keeps the sum so far where a chunk begins.
  void keep(int order) {
    if (auto chunk = later_.begins_after(order, settings_.orders)) {
      std::size_t table = table_values(grid_.altitudes) * value_bytes;
      tracer_.commands.copy(
          {moments_, table, table},
          {moments_, (earlier_tables() + *chunk * table_values(grid_.altitudes)) * value_bytes,
           table});
    }
  }

  void refine_order(const vulkan::Kernel& kernel) {
    run(kernel, static_cast<int>(order_values()), 12, push());
  }

  void trace_next_order(const vulkan::Kernel& rows, const vulkan::Kernel& next) {
    for (int first = 0; first < grid_.altitudes; first += rows_at_once_) {
      MomentPush part = push();
      part.first_altitude = first;
      int altitudes = std::min(rows_at_once_, grid_.altitudes - first);
      int suns = altitudes * rays() * grid_.suns * groups_;
      run(rows, suns * settings_.steps, 5 * (settings_.degree + 2), part);
      run(next, suns, 8 * settings_.steps * (settings_.degree + 2), part);
    }
  }

  /// The sum, as skies read it.
  void finish(const vulkan::Kernel& modes, const vulkan::Kernel& close, MomentSolver& solver) {
    if (later_.chunks > 0) {
      run(modes, grid_.suns * groups_, 8 * later_.chunks * later_.chunks * grid_.altitudes,
          push());
    }
    run(close, (grid_.altitudes + 1) * grid_.suns * groups_, 2 * slots(), push());
    int sum = table_values(grid_.altitudes);
    solver.refine(work_, tracer_, scene_, moments_, moments_, 1,
                  {sum, fine_table(), grid_.altitudes, finer_altitudes(grid_.altitudes),
                   grid_.suns * slots() * groups_, 0});
    solver.refine(work_, tracer_, scene_, moments_, tables_.moments, tables_.fine_altitudes,
                  {fine_table(), 0, grid_.suns, tables_.fine_suns, slots() * groups_, 0});
    solver.refine(work_, tracer_, scene_, moments_, tables_.moments, 1,
                  {sum + grid_.altitudes * grid_.suns * slots() * groups_, tables_.irradiance,
                   grid_.suns, tables_.fine_suns, groups_, 0});
    work_.submit();
  }

 private:
  static constexpr std::int64_t most_row_values = 1 << 22;  // 64 MiB

  int media() const { return std::max(scene_.media(), 1); }
  int slots() const { return slots_of(settings_.degree); }
  int rays() const { return up_ + down_; }
  int first_steps() const {
    return std::min(settings_.steps + 3, int{Physics<float>::MOST_GAUSS_NODES});
  }
  // Sizes in values of four wavelengths, as shaders/methods/moments_device.glsl counts them.
  std::int64_t row_values() const {  // of one altitude
    return std::int64_t{rays()} * settings_.steps * settings_.suns *
           ((settings_.degree + 2) / 2 + 1) * groups_;
  }
  std::int64_t order_values() const {
    return std::int64_t{finer_altitudes(grid_.altitudes)} * settings_.suns *
           ((slots() - 1) / 2 + 1) * groups_;
  }
  std::int64_t ray_values() const {
    std::int64_t node = 2 + (settings_.degree + 1) * groups_;
    return std::int64_t{settings_.altitudes} * rays() * (settings_.steps * node + groups_);
  }
  std::int64_t light_values() const {
    return std::int64_t{settings_.altitudes} * rays() * settings_.suns *
           (settings_.degree + 2) * groups_;
  }
  int table_values(int altitudes) const {
    return (altitudes * slots() + 1) * settings_.suns * groups_;
  }
  int fine_table() const { return 2 * table_values(grid_.altitudes); }
  std::int64_t earlier_tables() const {
    return fine_table() + table_values(finer_altitudes(grid_.altitudes));
  }
  std::int64_t moment_values() const {
    std::int64_t vectors = LaterOrders::most_chunks * (grid_.altitudes + 2);
    return earlier_tables() + std::int64_t{later_.chunks} * table_values(grid_.altitudes) +
           vectors * grid_.suns * groups_;
  }

  MomentPush push() const {
    return {grid_,
            finer_altitudes(grid_.altitudes),
            up_,
            down_,
            settings_.steps,
            first_steps(),
            0,
            0,
            0,
            0,
            settings_.azimuths,
            0,
            later_.chunks};
  }

  void run(const vulkan::Kernel& kernel, int count, std::int64_t evaluations_each,
           MomentPush part) {
    std::vector<vulkan::Binding> bindings =
        scene_.bind({tables_.series, rays_, light_, moments_, rows_, order_});
    work_.run(count, evaluations_each, [&](int first, int end) {
      part.first = first;
      part.end = end;
      tracer_.commands.dispatch(kernel, constants_, bindings, vulkan::bytes_of(part),
                                {vulkan::groups_for(end - first, 64)});
    });
  }

  Tracer& tracer_;
  const UploadedScene& scene_;
  const MomentSettings& settings_;
  LaterOrders later_;
  Grid grid_;
  MomentTables& tables_;
  vulkan::Specialization constants_;
  int groups_, up_, down_, rows_at_once_;
  vulkan::Buffer rays_, light_, moments_, rows_, order_;
  PacedWork work_;
};

}  // namespace

std::string MomentSettings::key() const {
  std::string key;
  for (int value : {degree, altitudes, suns, directions, azimuths, steps, orders, int{tail}}) {
    key += std::to_string(value) + ",";
  }
  return key;
}

MomentTables::MomentTables(vulkan::Device& device, const Grid& grid_, const PhaseSeries& phases,
                           int degree, int groups)
    : grid(grid_),
      particles(phases.particles),
      straight_on(phases.straight_on),
      fine_altitudes(finer_altitudes(grid.altitudes)),
      fine_suns(finer_suns(grid.suns)),
      irradiance(fine_altitudes * fine_suns * slots_of(degree) * groups),
      series(device, phases.values.size() * value_bytes, vulkan::Memory::device),
      moments(device, (irradiance + fine_suns * groups) * value_bytes, vulkan::Memory::device) {
  series.write(0, std::as_bytes(std::span(phases.values)));
}

void PacedWork::submit() {
  if (pending_ == 0) return;
  tracer_.pacer.took(pending_, tracer_.submit());
  pending_ = 0;
}

MomentSolver::MomentSolver(vulkan::Device& device)
    : rays_(device, moments_rays_spirv, UploadedScene::bindings + 6, sizeof(MomentPush)),
      first_(device, moments_first_spirv, UploadedScene::bindings + 6, sizeof(MomentPush)),
      project_(device, moments_project_spirv, UploadedScene::bindings + 6, sizeof(MomentPush)),
      order_(device, moments_order_spirv, UploadedScene::bindings + 6, sizeof(MomentPush)),
      rows_(device, moments_rows_spirv, UploadedScene::bindings + 6, sizeof(MomentPush)),
      next_(device, moments_next_spirv, UploadedScene::bindings + 6, sizeof(MomentPush)),
      modes_(device, moments_modes_spirv, UploadedScene::bindings + 6, sizeof(MomentPush)),
      close_(device, moments_close_spirv, UploadedScene::bindings + 6, sizeof(MomentPush)),
      refine_(device, moments_refine_spirv, UploadedScene::bindings + 2, sizeof(RefinePush)) {}

std::shared_ptr<const MomentTables> MomentSolver::solve(Tracer& tracer,
                                                        const UploadedScene& scene,
                                                        const MomentSettings& settings) {
  PhaseSeries series = make_phase_series(scene.problem(), settings.degree, settings.tail);
  Grid grid = moment_grid<float>(scene.problem(), settings.altitudes, settings.suns);
  auto tables = std::make_shared<MomentTables>(tracer.device, grid, series, settings.degree,
                                               scene.groups());
  const vulkan::Specialization constants =
      solution_constants(scene, settings, series.particles);
  for (const vulkan::Kernel* kernel :
       {&rays_, &first_, &project_, &order_, &rows_, &next_, &close_}) {
    kernel->prepare(constants);
  }
  Solution solution(tracer, scene, settings, constants, *tables);
  solution.trace_rays(rays_);
  solution.trace_first_order(first_);
  solution.project(project_);
  solution.keep(1);
  for (int order = 2; order <= settings.orders; ++order) {
    solution.refine_order(order_);
    solution.trace_next_order(rows_, next_);
    solution.project(project_);
    solution.keep(order);
  }
  solution.finish(modes_, close_, *this);
  return tables;
}

void MomentSolver::refine(PacedWork& work, Tracer& tracer, const UploadedScene& scene,
                          const vulkan::Buffer& coarse, const vulkan::Buffer& fine, int outer,
                          const Axis& axis) {
  std::vector<vulkan::Binding> bindings = scene.bind({coarse, fine});
  work.run(outer * axis.fine * axis.inner, 8, [&](int first, int end) {
    RefinePush push{axis, first, end};
    tracer.commands.dispatch(refine_, moment_constants(scene, 0, false), bindings,
                             vulkan::bytes_of(push), {vulkan::groups_for(end - first, 64)});
  });
}

vulkan::Specialization moment_constants(const UploadedScene& scene, int degree,
                                        bool particles) {
  vulkan::Specialization constants = scene.constants();
  constants[9] = 0;  // MANY_SUNS
  constants.push_back(static_cast<std::uint32_t>(degree));
  constants.push_back(particles);
  return constants;
}

int rounds_of_a_piece(const UploadedScene& scene, int nodes) {
  int on_a_ray = 2 * (scene.profile_nodes() + 1);  // down to its lowest point and up again
  return scene.kinks() + on_a_ray + nodes * (2 + on_a_ray + 4 * scene.density_iterations());
}

int most_pieces(const UploadedScene& scene) {
  // Cut at the lowest point and the shadow's two edges; each kink is passed twice by the ray
  // and twice by its light.
  const int where_wavelengths_end = 2 * 4 * scene.groups();
  return std::min(4 + 4 * scene.kinks() + where_wavelengths_end,
                  int{Physics<float>::MOST_PIECES});
}

void require_rounds(const UploadedScene& scene, int rounds) {
  if (rounds <= most_loop_iterations) return;
  throw OverLimit("/atmosphere/constituents", "the tables of all profiles together have " +
                                                  std::to_string(scene.profile_nodes()) +
                                                  " nodes, more than a march can follow");
}

}  // namespace cyanometer
