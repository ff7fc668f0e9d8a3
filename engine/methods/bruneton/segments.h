// Aerial perspective: the air before points that the caller knows, from the tables.
#pragma once

#include "engine/methods/bruneton/tables.h"

namespace cyanometer::bruneton {

/// The light of a part of a ray as the difference of two values of the tables [Bruneton and
/// Neyret 2008, section 4]. Of a short part that is the slope of what is interpolated between
/// nodes, wrong by as much as it bends there. Measured with the default's nodes from 0.05 to
/// 6 km up, over parts of 1 m to 100 km, against integrals along them
/// (tests/bruneton/segments_test.cpp):
/// - by day, median 0.7 to 4 %; parts shorter than 10 km are off by up to 74 %;
/// - with the sun on the horizon, all orders: median 2 to 8 %; looking down from below the
///   second altitude (0.4 km) nearly all light of a part up to 1 km is lost, as logarithms are
///   interpolated to the nothing that is seen from the ground;
/// - there, the first order alone: median 3 to 23 %; from below that altitude blue, of which
/// the
///   low sun has next to nothing left, is off by hundreds of times, and of all values for parts
///   up to 1 km one in twenty is negative.
/// Nothing hides that. Light is parallel, from the disc's centre.
class Segments {
 public:
  explicit Segments(vulkan::Device& device);

  /// @param setup    first.separate or .reconstructed, and not gathered_view: tables for every
  ///                 altitude and sun
  /// @param ends_km  float by ray of the tile: distance from the camera to the point; what lies
  ///                 beyond the ground or the top is at that end. From space it is precise to
  ///                 an ulp of the camera's distance
  /// @param tile     left with the inscattered radiance of the orders asked for (at least one)
  ///                 and the transmittance, both of the air before the point, and no ground
  /// @throws OverLimit, Cancelled; std::invalid_argument for another setup or no orders
  void trace(Tracer& tracer, TableMaker& maker, const UploadedScene& scene, const Setup& setup,
             const vulkan::Buffer& ends_km, const Tile& tile);

 private:
  vulkan::Kernel kernel_;
};

}  // namespace cyanometer::bruneton
