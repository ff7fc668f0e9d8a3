// The tables of an atmosphere, made on the device order by order.
#pragma once

#include <memory>

#include "engine/methods/bruneton/grid.h"
#include "engine/methods/method.h"

namespace cyanometer::bruneton {

/// Rays on the device, cut into cells.
struct UploadedRays {
  UploadedRays(vulkan::Device& device, const Rays& rays, const ScatteringGrid& source,
               int cells, int groups);

  Rays rays;
  int cells;
  vulkan::Buffer grids;  ///< of the rays, and of what they gather
  vulkan::Buffer nodes;
  vulkan::Buffer cell_values;  ///< by ray and cell: place, and what comes from there

  std::size_t bytes() const { return grids.size() + nodes.size() + cell_values.size(); }
};

/// What all orders from the second on come from: the source in the air and the diffuse
/// irradiance of the ground, summed over orders, as they are interpolated.
class SourceTables final : public Tables {
 public:
  SourceTables(vulkan::Device& device, const ScatteringGrid& grid, int groups);
  std::size_t bytes() const override { return source.size() + irradiance.size(); }

  ScatteringGrid grid;
  vulkan::Buffer source;
  vulkan::Buffer irradiance;
};

/// Radiance along rays, from the second order on, as it is interpolated.
class ViewTable final : public Tables {
 public:
  ViewTable(UploadedRays uploaded, vulkan::Buffer values_)
      : rays(std::move(uploaded)), values(std::move(values_)) {}
  std::size_t bytes() const override { return rays.bytes() + values.size(); }

  UploadedRays rays;
  vulkan::Buffer values;
};

/// The first order by constituent, without phase functions.
class SingleTable final : public Tables {
 public:
  SingleTable(UploadedRays uploaded, vulkan::Buffer values_, vulkan::Buffer particles_)
      : rays(std::move(uploaded)),
        values(std::move(values_)),
        particles(std::move(particles_)) {}
  std::size_t bytes() const override { return rays.bytes() + values.size() + particles.size(); }

  UploadedRays rays;
  vulkan::Buffer values;     ///< of all constituents, or of the molecules together
  vulkan::Buffer particles;  ///< of particles, the first wavelength alone
};

/// Whether orders are asked for that come from the source; without, there is none to be made.
bool has_multiple(const Problem& problem);

/// What making the tables costs, in evaluations of the density; roughly.
double evaluations(const Problem& problem, const Setup& setup);

/// Constants of the pipelines: of tables, which know neither camera nor sun, and of views.
vulkan::Specialization table_constants(const UploadedScene& scene, const Setup& setup);
vulkan::Specialization view_constants(const UploadedScene& scene, const Setup& setup,
                                      const Rays& rays);

class TableMaker {
 public:
  explicit TableMaker(vulkan::Device& device);

  /// All come from the tracer's cache where they are there. @throws OverLimit
  std::shared_ptr<const SourceTables> source(Tracer& tracer, const UploadedScene& scene,
                                             const Setup& setup);
  std::shared_ptr<const ViewTable> view(Tracer& tracer, const UploadedScene& scene,
                                        const Setup& setup);
  std::shared_ptr<const SingleTable> single(Tracer& tracer, const UploadedScene& scene,
                                            const Setup& setup);

 private:
  struct Work;
  std::shared_ptr<const SourceTables> make_source(Work work);
  std::shared_ptr<const ViewTable> make_view(Work work);
  std::shared_ptr<const SingleTable> make_single(Work work);
  UploadedRays cut(const Work& work, const Rays& rays, int cells);
  void find_first_order(const Work& work, const UploadedRays& rays, const vulkan::Buffer& to);
  struct Shares;
  void find_source(const Work& work, const UploadedRays& rays, Shares& shares,
                   const vulkan::Buffer& radiance, const vulkan::Buffer& to);
  void find_irradiance(const Work& work, const UploadedRays& rays,
                       const vulkan::Buffer& radiance, const vulkan::Buffer& to);
  struct OrderSum;
  struct Closing;
  void weigh_chunks(const Work& work, const UploadedRays& rays, const OrderSum& source,
                    const OrderSum& irradiance, const Closing& closing);
  enum class Leave { one_order, all_orders };
  /// Leaves what is to be interpolated: an order, which is added to the sum, or the closed sum.
  void add_or_close(const Work& work, const UploadedRays& rays, const OrderSum& sum,
                    const Closing& closing, Leave what);
  void refine(const Work& work, const UploadedRays& rays, const OrderSum& sum);
  enum class Gather { radiance_with_ground, view_without_ground };
  void gather(const Work& work, const UploadedRays& rays, const SourceTables& from, Gather what,
              const vulkan::Buffer& to);

  vulkan::Kernel cells_, first_, gather_, redistribute_, source_, irradiance_, order_, means_,
      modes_, refine_, single_;
};

}  // namespace cyanometer::bruneton
