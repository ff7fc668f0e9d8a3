// The tables of Hillaire's method and how they are made; each is kept under what it depends on.
#pragma once

#include <memory>

#include "engine/methods/method.h"
#include "engine/methods/tables/optical_depth_table.h"

namespace cyanometer::hillaire {

struct Sizes {
  OpticalDepthSize optical_depth;
  int multiple_suns, multiple_altitudes, directions, multiple_samples;
  int azimuths, elevations, view_samples;
  double forward_share;
  int orders;     ///< that are computed; -1 all
  int stops = 1;  ///< of parts of the sky view's rays; 1: whole rays
  /// Of order one alone: the share of each constituent's extinction (in the device's order)
  /// that does not dim light on its way to the camera; none where that is empty.
  std::vector<double> straight_on = {};

  /// Whether light may be scattered or reflected more than once.
  bool several_orders() const { return orders < 0 || orders > 1; }
  static Sizes of(const MethodOptions& options, int orders);
  /// Of a sky view for rays that end in the air: ratios of parts vary as little, and there are
  /// many stops.
  Sizes of_parts() const;
};

/// Of the air alone, all without the forward peak.
struct AirTables final : Tables {
  AirTables(vulkan::Device& device, const Sizes& sizes, int media, int groups);
  std::size_t bytes() const override {
    return kept.size() + log_multiple.size() + log_irradiance.size() + optical_depth->bytes();
  }

  /// In the cache by itself too, perhaps: these keep it when it has gone from there.
  std::shared_ptr<const OpticalDepthTable> optical_depth;
  vulkan::Buffer kept, log_multiple, log_irradiance;
};

/// Columns along the rays from an altitude.
struct ViewColumns final : Tables {
  ViewColumns(vulkan::Device& device, int media);
  std::size_t bytes() const override { return values.size(); }

  vulkan::Buffer values;
};

/// Ratios over the directions from an altitude under a sun.
struct SkyView final : Tables {
  SkyView(vulkan::Device& device, std::size_t bytes);
  std::size_t bytes() const override { return values.size(); }
  static std::size_t bytes_of(const UploadedScene& scene, const Sizes& sizes);

  vulkan::Buffer values;
};

/// All that pixels are made from.
struct TablesOfView {
  std::shared_ptr<const AirTables> air;
  std::shared_ptr<const ViewColumns> columns;
  std::shared_ptr<const SkyView> sky;  ///< null where every pixel is marched
};

/// The scene's bindings and those of the tables that most kernels begin with, then its own.
std::vector<vulkan::Binding> bind(const UploadedScene& scene, const AirTables& air,
                                  std::initializer_list<vulkan::Binding> own);

class TableMaker {
 public:
  explicit TableMaker(vulkan::Device& device);
  TablesOfView get(Tracer& tracer, const UploadedScene& scene, const Sizes& sizes,
                   bool with_sky);

 private:
  /// The kernels of all tables.
  void prepare(const vulkan::Specialization& specialization, bool several_orders,
               bool with_sky) const;
  std::shared_ptr<const AirTables> make_air(Tracer& tracer, const UploadedScene& scene,
                                            const Sizes& sizes);
  std::shared_ptr<const ViewColumns> make_columns(Tracer& tracer, const UploadedScene& scene,
                                                  const Sizes& sizes,
                                                  const TablesOfView& tables);
  std::shared_ptr<const SkyView> make_sky(Tracer& tracer, const UploadedScene& scene,
                                          const Sizes& sizes, const TablesOfView& tables);

  OpticalDepthTableMaker optical_depths_;
  vulkan::Kernel multiple_, irradiance_, sum_, columns_, sky_;
};

/// What all of the method's kernels are specialised by.
vulkan::Specialization constants(const UploadedScene& scene, const Sizes& sizes);

/// Nodes of a march of so many samples, at the most: a ray cut by the planet's shadow has more.
std::int64_t most_nodes(int samples);

/// Evaluations of the density that one node of a march is worth.
std::int64_t evaluations_per_node(const UploadedScene& scene);

/// The scale height that steps are fitted to: of the constituent that falls off fastest, of
/// those that scatter.
float scale_height_km(const Problem& problem);

}  // namespace cyanometer::hillaire
