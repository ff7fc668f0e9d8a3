#include "engine/lattice/lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

namespace cyanometer {
namespace {

/// Of a cell's extent the share that a circle bends away from the line between two corners, at
/// the most, where it is no smaller than the cell.
constexpr double most_bend = 0.3;
/// Values may bend so much more between three pixels than these tell.
constexpr float bend_in_between = 1.3f;
/// How much rows and columns of pixels bend on the sphere, radians a radian, but for those of
/// pictures in which great circles are straight.
constexpr double bend_of_rows = 4;
/// Cells are no wider than this share of their distance from the sun, about which light may
/// change as fast, down to one that shows all of what is no narrower than the disc.
constexpr double share_of_distance = 1. / 3, narrowest_rad = 1e-3;
/// Cells that the frame begins with are no wider than this: what is narrower may lie between.
constexpr double widest_rad = 0.06;
/// Cells a side of the frame, at least.
constexpr int fewest_cells = 8;

double chord(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b); }

bool draws_straight(int projection) {
  return projection == Physics<double>::PROJECTION_PERSPECTIVE ||
         projection == Physics<double>::PROJECTION_CUBEMAP;
}

int first_side(int width, int panel, double pixel_rad) {
  int side = Lattice::coarsest;
  while (side > 2 &&
         (side * pixel_rad > widest_rad || side * fewest_cells > std::min(width, panel))) {
    side /= 2;
  }
  return side;
}

/// How far the middle of three values lies from the line between the others, `share` of the way
/// from one to the other.
float bend(const Interpolated& of, int from, int middle, int to, float share) {
  const float a = of.values[static_cast<std::size_t>(from)],
              b = of.values[static_cast<std::size_t>(middle)],
              c = of.values[static_cast<std::size_t>(to)];
  const float off = std::abs(b - (a + (c - a) * share));
  if (!of.relative) return off;
  float scale = std::max({std::abs(a), std::abs(b), std::abs(c)});
  if (!of.beside.empty())
    scale = std::max(scale, std::abs(of.beside[static_cast<std::size_t>(middle)]));
  const float whole = scale + of.floor;
  return whole > 0 ? off / whole : 0;
}

}  // namespace

Lattice::Lattice(Physics<double>& camera)
    : camera_(camera),
      width_(camera.scene.width),
      height_(camera.scene.height),
      panel_(camera.scene.projection == Physics<double>::PROJECTION_CUBEMAP ? width_ : height_),
      kinds_(static_cast<std::size_t>(width_) * height_),
      bend_(draws_straight(camera.scene.projection) ? 0 : bend_of_rows),
      side_(first_side(width_, panel_, camera.pixel_angle())) {
  const auto& scene = camera.scene;
  const glm::dvec3 down(0, 0, -1);
  const double from_centre = scene.planet_radius_km + scene.camera_altitude_km;
  auto add_circle = [&](double radius_km) {
    const double sine = std::min(radius_km / from_centre, 1.0);
    edges_.push_back({down, std::sqrt((1 - sine) * (1 + sine)), sine});
  };
  add_circle(scene.planet_radius_km);
  if (scene.camera_altitude_km > scene.thickness_km) {
    add_circle(scene.planet_radius_km + scene.thickness_km);
  }
  const auto sun = camera.sun_ray({0, 0, from_centre}, glm::dvec3(0));
  sun_ = sun.direction;
  const double sine = camera.disc_sine(sun);
  edges_.push_back({sun_, std::sqrt((1 - sine) * (1 + sine)), sine,
                    2 * camera.disc_fade(sine, scene.pixel_rad)});
  for (int panel = 0; panel < height_; panel += panel_) {
    for (int y = panel; y < panel + panel_; y += 2 * side_) {
      for (int x = 0; x < width_; x += 2 * side_) parents_.push_back({pixel(x, y), false});
    }
  }
  for (const Parent& parent : parents_) want_nodes(parent);
}

auto Lattice::kind_of(int pixel) -> Kind {
  const auto ray = camera_.pixel_ray(pixel);
  if (!ray.inside) return Kind::outside;
  const auto path = camera_.path_from_camera(ray.direction);
  const Kind kind = path.meets_ground            ? Kind::ground
                    : camera_.meets_planet(path) ? Kind::air
                                                 : Kind::space;
  const Edge& sun = edges_.back();
  if (glm::dot(ray.direction, sun.axis) <= sun.cosine) return kind;
  return static_cast<Kind>(static_cast<char>(kind) | static_cast<char>(Kind::disc));
}

/// The corners of its four cells.
void Lattice::want_nodes(const Parent& parent) {
  const int x = parent.pixel % width_, y = parent.pixel / width_;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      const int at =
          pixel(std::min(x + i * side_, width_ - 1), std::min(y + j * side_, last_row(y)));
      if (kinds_[static_cast<std::size_t>(at)] != Kind::unknown) continue;
      want(at, parent.plain ? kinds_[static_cast<std::size_t>(parent.pixel)] : kind_of(at));
    }
  }
}

void Lattice::want(int pixel, Kind kind) {
  kinds_[static_cast<std::size_t>(pixel)] = kind;
  (kind == Kind::outside ? outside_ : wanted_).push_back(pixel);
  ++traced_;
}

void Lattice::settle(std::span<const Interpolated> values) {
  wanted_.clear();
  outside_.clear();
  std::vector<Parent> smaller;
  for (const Parent& parent : parents_) {
    if (side_ > 1) {
      look_at(parent, values, smaller);
    } else {
      settle_pixels(parent);
    }
  }
  side_ /= 2;
  parents_ = std::move(smaller);
  for (const Parent& parent : parents_) want_nodes(parent);
}

void Lattice::settle_pixels(const Parent& parent) {
  const int x0 = parent.pixel % width_, y0 = parent.pixel / width_;
  for (int y = y0; y <= std::min(y0 + 1, last_row(y0)); ++y) {
    for (int x = x0; x <= std::min(x0 + 1, width_ - 1); ++x) singles_.push_back(pixel(x, y));
  }
}

std::array<int, 4> Lattice::corners(int first, int side) const {
  const int x = first % width_, y = first / width_, right = std::min(x + side, width_ - 1),
            below = std::min(y + side, last_row(y));
  return {first, pixel(right, y), pixel(x, below), pixel(right, below)};
}

int Lattice::pixels(int first, int side) const {
  const int x = first % width_, y = first / width_;
  return std::min(side, width_ - x) * std::min(side, last_row(y) + 1 - y);
}

/// Settles its cells, or wants them to be smaller.
void Lattice::look_at(const Parent& parent, std::span<const Interpolated> values,
                      std::vector<Parent>& smaller) {
  const int x0 = parent.pixel % width_, y0 = parent.pixel / width_;
  for (int y : {y0, y0 + side_}) {
    for (int x : {x0, x0 + side_}) {
      if (x > width_ - 1 || y > last_row(y0)) continue;
      const bool plain = parent.plain || is_plain(x, y);
      if (plain && is_straight(x, y, values)) {
        cells_[side_].push_back(pixel(x, y));
      } else {
        smaller.push_back({pixel(x, y), plain});
      }
    }
  }
}

bool Lattice::is_straight(int x, int y, std::span<const Interpolated> values) const {
  const int right = std::min(x + side_, width_ - 1), last = last_row(y),
            below = std::min(y + side_, last), first = last + 1 - panel_;
  const Side above = side(pixel(x, y), right - x, 1, x, width_ - 1 - right),
             under = side(pixel(x, below), right - x, 1, x, width_ - 1 - right),
             left = side(pixel(x, y), below - y, width_, y - first, last - below),
             far = side(pixel(right, y), below - y, width_, y - first, last - below);
  if (!above.told() || !under.told() || !left.told() || !far.told()) return false;
  return std::ranges::all_of(values, [&](const Interpolated& of) {
    const float off = std::max(off_of(above, of), off_of(under, of)) +
                      std::max(off_of(left, of), off_of(far, of));
    return off * bend_in_between <= of.tolerance;
  });
}

/// @param length  pixels @param step  from one to the next @param before, after  pixels that
/// there are beyond its ends
auto Lattice::side(int from, int length, int step, int before, int after) const -> Side {
  const Kind kind = kinds_[static_cast<std::size_t>(from)];
  auto known = [&](int pixel) { return kinds_[static_cast<std::size_t>(pixel)] == kind; };
  Side side{from, from + length * step, length};
  if (before >= side_ && known(from - side_ * step)) side.before = from - side_ * step;
  side.to_after = std::min(side_, after);
  if (side.to_after > 0 && known(side.to + side.to_after * step))
    side.after = side.to + side.to_after * step;
  return side;
}

/// How far the values of a side are off half way along the line between its ends, as a pixel
/// beyond either tells: where they bend evenly, an eighth of the second derivative times the
/// square of its length.
float Lattice::off_of(const Side& side, const Interpolated& of) const {
  const auto length = static_cast<float>(side.length);
  float off = 0;
  if (side.before >= 0 && side.length > 0) {
    const auto before = static_cast<float>(side_);
    off = bend(of, side.before, side.from, side.to, before / (before + length)) * length /
          (4 * before);
  }
  if (side.after >= 0 && side.length > 0) {
    const auto after = static_cast<float>(side.to_after);
    off = std::max(off, bend(of, side.from, side.to, side.after, length / (length + after)) *
                            length / (4 * after));
  }
  return off;
}

bool Lattice::are_alike(std::initializer_list<int> columns,
                        std::initializer_list<int> rows) const {
  const Kind first = kinds_[static_cast<std::size_t>(pixel(*columns.begin(), *rows.begin()))];
  return std::ranges::all_of(rows, [&](int row) {
    return std::ranges::all_of(columns, [&](int column) {
      return kinds_[static_cast<std::size_t>(pixel(column, row))] == first;
    });
  });
}

/// Whether geometry has nothing in a cell that its corners do not show.
bool Lattice::is_plain(int x, int y) const {
  const int right = std::min(x + side_, width_ - 1), below = std::min(y + side_, last_row(y));
  if (!are_alike({x, right}, {y, below}) || near_circle(x, y)) return false;
  const Corners corners = corners_of(x, y, right, below);
  return !near_sun(corners) && std::ranges::none_of(edges_, [&](const Edge& edge) {
    return near_edge(corners, edge);
  });
}

Lattice::Corners Lattice::corners_of(int x, int y, int x1, int y1) const {
  Corners corners;
  corners.directions = {
      camera_.pixel_ray(pixel(x, y)).direction, camera_.pixel_ray(pixel(x1, y)).direction,
      camera_.pixel_ray(pixel(x, y1)).direction, camera_.pixel_ray(pixel(x1, y1)).direction};
  corners.extent_rad = std::max(chord(corners.directions[0], corners.directions[3]),
                                chord(corners.directions[1], corners.directions[2]));
  return corners;
}

/// Whether the edge of a fisheye's picture may pass.
bool Lattice::near_circle(int x, int y) const {
  if (camera_.scene.projection != Physics<double>::PROJECTION_FISHEYE) return false;
  const double circle = 0.5 * std::min(width_, height_), margin = 1 + side_ / 8.0;
  for (int corner = 0; corner < 4; ++corner) {
    const double across = x + corner % 2 * side_ + 0.5 - 0.5 * width_,
                 down = y + corner / 2 * side_ + 0.5 - 0.5 * height_;
    if (std::abs(std::hypot(across, down) - circle) < margin) return true;
  }
  return false;
}

bool Lattice::near_edge(const Corners& corners, const Edge& edge) const {
  // A circle that is smaller than the cell may lie between its corners.
  const bool small = edge.cosine > 0 && edge.sine < corners.extent_rad;
  // A chord of an arc that bends k radians a radian lies an eighth of k times its square off.
  const double arc = (edge.cosine / edge.sine + bend_) * corners.extent_rad / 8;
  const double margin =
      edge.width_rad + corners.extent_rad * (small ? 1 : std::min(arc, most_bend));
  return std::ranges::any_of(corners.directions, [&](const glm::dvec3& direction) {
    const double from_axis = chord(direction, edge.axis);
    if (small && from_axis <= edge.sine + margin) return true;
    // |cos(a) - cos(b)| <= sin(b) |a - b| + |a - b|^2 / 2.
    return std::abs(1 - 0.5 * from_axis * from_axis - edge.cosine) <=
           (edge.sine + 0.5 * margin) * margin;
  });
}

bool Lattice::near_sun(const Corners& corners) const {
  if (corners.extent_rad <= narrowest_rad) return false;
  return std::ranges::any_of(corners.directions, [&](const glm::dvec3& direction) {
    return share_of_distance * (chord(direction, sun_) - corners.extent_rad) <
           corners.extent_rad;
  });
}

}  // namespace cyanometer
