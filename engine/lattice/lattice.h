// Which rays of a frame are traced, so that the values of all other pixels follow between them:
// those at the corners of square cells, ever smaller ones where values bend, down to single
// pixels at horizons, limbs and the sun's disc.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <initializer_list>
#include <map>
#include <span>
#include <vector>

#include "engine/physics/pack.h"

namespace cyanometer {

/// What is interpolated: values by pixel, right at all that were traced.
struct Interpolated {
  std::span<const float> values;
  float tolerance = 0;    ///< how far an interpolated value may be off
  bool relative = false;  ///< to the larger of the values and `beside`, and to `floor` more
  std::span<const float> beside = {};
  float floor = 0;
};

class Lattice {
 public:
  /// Frames of fewer pixels are as quickly traced pixel by pixel.
  static constexpr int fewest_pixels = 1 << 14;
  /// Pixels a side of the cells that it begins with, at the most.
  static constexpr int coarsest = 32;

  /// @param camera  whose pixels these are, of a picture of that size
  explicit Lattice(Physics<double>& camera);

  /// Pixels that are to be traced next, each once. The first are an even grid of the frame's.
  const std::vector<int>& wanted() const { return wanted_; }
  bool settled() const { return parents_.empty(); }
  /// Of pixels that were wanted those that show nothing: they lie outside a fisheye's circle.
  const std::vector<int>& outside() const { return outside_; }
  /// Of what was wanted all values are there: settles the cells between whose corners they are
  /// linear, and wants more where they are not.
  void settle(std::span<const Interpolated> values);

  /// The first pixels of settled cells, by their sides. A cell's corners are that pixel and
  /// those a side further or, where the picture or a cube's face ends before, in the last
  /// column and row.
  const std::map<int, std::vector<int>>& cells() const { return cells_; }
  /// Pixels that are in no cell, each traced.
  const std::vector<int>& singles() const { return singles_; }
  /// Of a cell.
  std::array<int, 4> corners(int first, int side) const;
  int pixels(int first, int side) const;
  int width() const { return width_; }
  /// Rows after which neighbours are neighbours no more: of a face of a cube, or of the frame.
  int panel() const { return panel_; }
  int traced() const { return traced_; }

 private:
  /// What a ray sees, with the sun's disc or without; unknown of pixels that were never wanted.
  enum class Kind : char { unknown, outside, space, air, ground, disc = 8 };
  /// A circle in which rays turn from one kind into another.
  struct Edge {
    glm::dvec3 axis;
    double cosine, sine;
    double width_rad = 0;  ///< of the turning
  };
  struct Corners {
    std::array<glm::dvec3, 4> directions;
    double extent_rad;
  };
  /// Four cells of half the side together.
  struct Parent {
    int pixel;   ///< its first
    bool plain;  ///< all of its rays are of the same kind, and no two far apart near the sun
  };

  /// A side of a cell, and the pixels beyond its ends that have values, -1 where there are
  /// none.
  struct Side {
    int from, to;
    int length;
    int before = -1, after = -1;
    int to_after = 0;  ///< pixels

    bool told() const { return before >= 0 || after >= 0 || length <= 1; }
  };

  int last_row(int y) const { return (y / panel_ + 1) * panel_ - 1; }
  int pixel(int x, int y) const { return y * width_ + x; }
  Kind kind_of(int pixel);
  void want_nodes(const Parent& parent);
  void want(int pixel, Kind kind);
  void settle_pixels(const Parent& parent);
  void look_at(const Parent& parent, std::span<const Interpolated> values,
               std::vector<Parent>& smaller);
  bool is_straight(int x, int y, std::span<const Interpolated> values) const;
  Side side(int from, int length, int step, int before, int after) const;
  float off_of(const Side& side, const Interpolated& of) const;
  bool are_alike(std::initializer_list<int> columns, std::initializer_list<int> rows) const;
  bool is_plain(int x, int y) const;
  Corners corners_of(int x, int y, int x1, int y1) const;
  bool near_circle(int x, int y) const;
  bool near_edge(const Corners& corners, const Edge& edge) const;
  bool near_sun(const Corners& corners) const;

  Physics<double>& camera_;
  int width_, height_, panel_;
  std::vector<Edge> edges_;
  glm::dvec3 sun_;
  std::vector<Kind> kinds_;      ///< by pixel
  double bend_;                  ///< of rows of pixels on the sphere, radians a radian
  std::vector<Parent> parents_;  ///< that are looked at
  int side_;                     ///< of their four cells
  std::vector<int> wanted_, outside_;
  std::map<int, std::vector<int>> cells_;
  std::vector<int> singles_;
  int traced_ = 0;
};

}  // namespace cyanometer
