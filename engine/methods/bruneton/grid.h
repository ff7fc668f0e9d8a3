// The nodes of the tables (shaders/methods/bruneton/grid.glsl) for a scene and its options.
#pragma once

#include <vector>

#include "engine/methods/method.h"
#include "engine/physics/pack.h"

namespace cyanometer::bruneton {

using ScatteringGrid = Physics<float>::ScatteringGrid;

/// What the method can be told, as it is used.
struct Setup {
  explicit Setup(const MethodOptions& options);

  int orders;                              ///< computed; those beyond are estimated
  int altitudes, zeniths, suns, azimuths;  ///< nodes; zeniths: of both sides together
  int source_zeniths, source_azimuths;     ///< of the source's directions
  int refinement;                          ///< of the source in each coordinate, for reading
  int cells;                               ///< of a path, in orders from the second on
  int view_cells;                          ///< of a path that is gathered for the view
  int view_nodes;                          ///< on each piece of a path, in the first order
  int mapping;
  bool two_sided;
  bool logarithmic;
  bool gathered_view;  ///< the view gathers the source anew, instead of reading a table
  enum class First { quadrature, separate, reconstructed } first;

  /// Nodes of a coordinate of the finer grid, from which the source is read.
  int refined(int nodes) const { return (nodes - 1) * refinement + 1; }
  /// All that tables depend on beside the air, as text.
  std::string key() const;
};

/// The rays of a table: its grid, and its nodes as the shaders want them.
struct Rays {
  ScatteringGrid grid;
  std::vector<float> nodes;

  int count() const { return grid.altitudes * grid.zeniths; }
  int texels() const { return count() * grid.suns * grid.azimuths; }
  int directions() const { return grid.zeniths * grid.azimuths; }
};

/// Over all altitudes, directions and suns.
Rays all_rays(const Problem& problem, const Setup& setup);
/// From one altitude (km, up to the top) under one sun; and from the top inwards under all.
Rays rays_from(const Problem& problem, const Setup& setup, double altitude_km, double mu_s);
Rays rays_from_space(const Problem& problem, const Setup& setup);
/// What the rays gather: the altitudes and suns of `all_rays` and directions even in angle, all
/// refined.
ScatteringGrid source_grid(const Problem& problem, const Setup& setup);

/// Nodes of a grid.
struct Places {
  std::vector<double> altitudes_km;
  std::vector<double> sun_cosines;  ///< of the zenith angle
};
Places source_places(const Problem& problem, const Setup& setup);

}  // namespace cyanometer::bruneton
