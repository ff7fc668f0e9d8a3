// The moment tables on the device: made once for an air, read by every sky of it.
#pragma once

#include "engine/methods/method.h"
#include "engine/methods/moments/phase_series.h"
#include "engine/physics/physics.h"

namespace cyanometer {

/// All that the tables depend on beside the air.
struct MomentSettings {
  int degree, altitudes, suns, directions, azimuths, steps;
  int orders;  ///< that are added up
  bool tail;   ///< and all after them

  std::string key() const;
};

class MomentTables final : public Tables {
 public:
  using Grid = Physics<float>::MomentGrid;

  MomentTables(vulkan::Device& device, const Grid& grid, const PhaseSeries& series, int degree,
               int groups);

  std::size_t bytes() const override { return series.size() + moments.size(); }

  Grid grid;
  bool particles;
  std::vector<double> straight_on;  ///< PhaseSeries::straight_on
  int fine_altitudes, fine_suns;
  int irradiance;          ///< where it lies in `moments`, in groups
  vulkan::Buffer series;   ///< PhaseSeries::values
  vulkan::Buffer moments;  ///< as shaders/methods/moments_view.glsl reads them
};

/// Work in parts that fit the pacer; submitted when enough has come together.
class PacedWork {
 public:
  explicit PacedWork(Tracer& tracer) : tracer_(tracer) {}
  ~PacedWork() = default;

  /// Dispatches one invocation for each of `count`, in parts: `record(first, end)`.
  template <class Record>
  void run(int count, std::int64_t evaluations_each, const Record& record) {
    for (int first = 0; first < count;) {
      std::int64_t room = tracer_.pacer.evaluations() - pending_;
      std::int64_t fit = room / evaluations_each / 64 * 64;
      if (fit < 64 && pending_ > 0) {
        submit();
        continue;
      }
      int end = static_cast<int>(
          std::min<std::int64_t>(count, first + std::max<std::int64_t>(fit, 64)));
      record(first, end);
      pending_ += evaluations_each * (end - first);
      first = end;
    }
  }
  void submit();

 private:
  Tracer& tracer_;
  std::int64_t pending_ = 0;
};

class MomentSolver {
 public:
  explicit MomentSolver(vulkan::Device& device);

  std::shared_ptr<const MomentTables> solve(Tracer& tracer, const UploadedScene& scene,
                                            const MomentSettings& settings);

  /// Cubic interpolation of a table along one axis (shaders/methods/moments_refine.comp).
  struct Axis {
    std::int32_t from, to, nodes, fine, inner, mirrored;
  };
  void refine(PacedWork& work, Tracer& tracer, const UploadedScene& scene,
              const vulkan::Buffer& coarse, const vulkan::Buffer& fine, int outer,
              const Axis& axis);

 private:
  vulkan::Kernel rays_, first_, project_, order_, rows_, next_, modes_, close_, refine_;
};

/// The scene's constants for a kernel that knows of no disc, and two of its own.
vulkan::Specialization moment_constants(const UploadedScene& scene, int degree, bool particles);

/// Rounds of loops on a piece of a ray with so many nodes, as shaders/methods/raymarch.glsl
/// marches it.
int rounds_of_a_piece(const UploadedScene& scene, int nodes);
/// Pieces that a ray can have.
int most_pieces(const UploadedScene& scene);
/// @throws OverLimit where one piece is too long for a dispatch
void require_rounds(const UploadedScene& scene, int rounds);

}  // namespace cyanometer
