#include "engine/sky/pixel.h"

#include <cmath>
#include <numbers>

namespace cyanometer {
namespace {

using P = Physics<double>;
constexpr double pi = std::numbers::pi;

/// Coordinates right, up, forward of a direction.
glm::dvec3 camera_frame(const P& p, const glm::dvec3& d) {
  return {glm::dot(glm::dvec3(p.scene.camera_right), d),
          glm::dot(glm::dvec3(p.scene.camera_up), d),
          glm::dot(glm::dvec3(p.scene.camera_forward), d)};
}

/// From offsets in half pixels from the image's centre (x right, y up).
std::optional<int> pixel_at(const P& p, double x, double y) {
  double column = std::floor((x + p.scene.width) / 2);
  double row = std::floor((p.scene.height - y) / 2);
  if (!(column >= 0 && column < p.scene.width && row >= 0 && row < p.scene.height)) return {};
  return static_cast<int>(row) * p.scene.width + static_cast<int>(column);
}

std::optional<int> perspective_pixel(const P& p, const glm::dvec3& v) {
  if (v.z <= 0) return {};
  double scale = p.scene.height / p.scene.tan_half_fov / v.z;
  return pixel_at(p, v.x * scale, v.y * scale);
}

std::optional<int> fisheye_pixel(const P& p, const glm::dvec3& v) {
  double sine = std::hypot(v.x, v.y);
  double theta = std::atan2(sine, v.z);
  if (theta > p.scene.half_fov_rad) return {};
  double radius = theta / p.scene.half_fov_rad * std::min(p.scene.width, p.scene.height);
  double scale = sine > 0 ? radius / sine : 0;
  return pixel_at(p, v.x * scale, v.y * scale);
}

std::optional<int> equirectangular_pixel(const P& p, const glm::dvec3& v) {
  double azimuth = std::atan2(v.x, v.z);
  double elevation = std::atan2(v.y, std::hypot(v.x, v.z));
  return pixel_at(p, azimuth / pi * p.scene.width, elevation / (pi / 2) * p.scene.height);
}

/// Faces as in shaders/physics/camera.glsl, with x right, y up and -z forward.
std::optional<int> cubemap_pixel(const P& p, const glm::dvec3& v) {
  glm::dvec3 c(v.x, v.y, -v.z), a = glm::abs(c);
  int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  bool positive = c[axis] > 0;
  double s = axis == 0 ? (positive ? -c.z : c.z) : axis == 1 ? c.x : (positive ? c.x : -c.x);
  double t = axis == 1 ? (positive ? c.z : -c.z) : -c.y;
  int n = p.scene.width, face = 2 * axis + (positive ? 0 : 1);
  auto index = [&](double u) {
    return std::min(static_cast<int>((u / a[axis] + 1) / 2 * n), n - 1);
  };
  return (face * n + index(t)) * n + index(s);
}

}  // namespace

std::optional<int> pixel_of(const P& camera, const glm::dvec3& direction) {
  glm::dvec3 v = camera_frame(camera, direction);
  switch (camera.scene.projection) {
    case P::PROJECTION_PERSPECTIVE:
      return perspective_pixel(camera, v);
    case P::PROJECTION_FISHEYE:
      return fisheye_pixel(camera, v);
    case P::PROJECTION_EQUIRECTANGULAR:
      return equirectangular_pixel(camera, v);
    case P::PROJECTION_CUBEMAP:
      return cubemap_pixel(camera, v);
    default:
      return {};
  }
}

double pixel_solid_angle(P& camera, int pixel) {
  glm::dvec3 v = camera_frame(camera, camera.pixel_ray(pixel).direction);
  auto square = [](double x) { return x * x; };
  switch (camera.scene.projection) {
    case P::PROJECTION_PERSPECTIVE:
      return square(2 * camera.scene.tan_half_fov / camera.scene.height) * v.z * v.z * v.z;
    case P::PROJECTION_FISHEYE: {
      double sine = std::hypot(v.x, v.y), theta = std::atan2(sine, v.z);
      double circle = std::min(camera.scene.width, camera.scene.height);
      return square(2 * camera.scene.half_fov_rad / circle) * (theta > 0 ? sine / theta : 1);
    }
    case P::PROJECTION_EQUIRECTANGULAR:
      return square(pi / camera.scene.height) * std::hypot(v.x, v.z);
    default: {
      glm::dvec3 a = glm::abs(v);
      double largest = std::max(a.x, std::max(a.y, a.z));
      return square(2.0 / camera.scene.width) * largest * largest * largest;
    }
  }
}

}  // namespace cyanometer
