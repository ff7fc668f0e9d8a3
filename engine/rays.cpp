#include "engine/rays.h"

#include <algorithm>
#include <cmath>

#include "engine/engine.h"
#include "engine/problem.h"

namespace cyanometer {
namespace {

bool meets_air_or_ground(Physics<double>& camera, int pixel) {
  auto ray = camera.pixel_ray(pixel);
  return ray.inside && camera.meets_planet(camera.path_from_camera(ray.direction));
}

}  // namespace

std::vector<int> pixels_of_grid(Physics<double>& camera, int columns, int rows) {
  int width = camera.scene.width, height = camera.scene.height;
  std::vector<int> pixels;
  for (int cell = 0; cell < columns * rows; ++cell) {
    // Additive recurrence on the plastic number: evenly spread offsets without a random number.
    double u = std::fmod(0.5 + cell * 0.7548776662466927, 1.0);
    double v = std::fmod(0.5 + cell * 0.5698402909980532, 1.0);
    int x = static_cast<int>((cell % columns + u) / columns * width);
    int y = static_cast<int>((cell / columns + v) / rows * height);
    int pixel = std::min(y, height - 1) * width + std::min(x, width - 1);
    if (meets_air_or_ground(camera, pixel)) pixels.push_back(pixel);
  }
  return pixels;
}

std::vector<int> stratified_pixels(Physics<double>& camera, int count) {
  constexpr int finest = 1024;
  int width = camera.scene.width, height = camera.scene.height;
  for (int side = static_cast<int>(std::lround(std::sqrt(count)));;) {
    std::vector<int> pixels =
        pixels_of_grid(camera, std::min(side, width), std::min(side, height));
    auto found = static_cast<int>(pixels.size());
    if (found >= count || side >= std::min(finest, std::max(width, height))) return pixels;
    double finer = std::sqrt(static_cast<double>(count) / std::max(found, 1));
    side = std::min(std::max(side + 1, static_cast<int>(1.03 * finer * side)), finest);
  }
}

Rays stratified_rays(Physics<double>& camera, int count, const Picture* picture) {
  Rays rays;
  for (int pixel : stratified_pixels(camera, count)) {
    rays.directions.push_back(camera.pixel_ray(pixel).direction);
    if (!picture) continue;
    auto at = static_cast<std::size_t>(pixel);
    const auto& rgb = picture->rgb;
    rays.ends_km.push_back(picture->distance_km[at]);
    rays.colours.push_back({rgb[0][at], rgb[1][at], rgb[2][at]});
  }
  return rays;
}

std::vector<double> some_wavelengths_of(const Scene& scene) {
  return scene.spectrum.wavelengths_nm.empty() ? colour_wavelengths(4)
                                               : scene.spectrum.wavelengths_nm;
}

namespace {

Physics<double> camera_of(const Scene& scene) {
  return pack<double>(make_problem(scene, some_wavelengths_of(scene)));
}

}  // namespace

std::vector<int> sample_pixels(const Scene& scene, int count) {
  Physics<double> camera = camera_of(scene);
  return stratified_pixels(camera, count);
}

std::vector<Direction> pixel_directions(const Scene& scene, const std::vector<int>& pixels) {
  Physics<double> camera = camera_of(scene);
  std::vector<Direction> directions;
  for (int pixel : pixels) {
    glm::dvec3 ray = camera.pixel_ray(pixel).direction;
    directions.push_back({glm::degrees(std::atan2(ray.z, std::hypot(ray.x, ray.y))),
                          glm::degrees(std::atan2(ray.x, ray.y))});
  }
  return directions;
}

std::vector<Direction> sample_directions(const Scene& scene, int count) {
  return pixel_directions(scene, sample_pixels(scene, count));
}

std::vector<bool> measured_pixels(const Scene& scene) {
  Physics<double> camera = camera_of(scene);
  std::vector<bool> measured(static_cast<std::size_t>(scene.image.width) * scene.image.height);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    measured[i] = meets_air_or_ground(camera, static_cast<int>(i));
  }
  return measured;
}

}  // namespace cyanometer
