#include "engine/accuracy/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/accuracy/banding.h"
#include "engine/accuracy/finest.h"
#include "engine/display/displayed.h"
#include "engine/optics/ciede2000.h"
#include "engine/scene/document.h"

namespace cyanometer {
namespace {

/// As errors are taken of, and displayed.
Scene bare(const Scene& scene) {
  Scene result = scene;
  Image& image = result.image;
  image.format = ImageFormat::png;
  image.channels = Channels::rgb;
  image.layers = {};
  image.show.sun = image.show.stars = image.show.clipped = false;
  return result;
}

void require_equal(const char* pointer, const std::string& a, const std::string& b) {
  if (a == b) return;
  throw SceneError(pointer, b, a,
                   std::string(pointer) + " must be that of a, " + a + ", not " + b +
                       ": pixels are compared one by one.");
}

Triple at(const std::array<const float*, 3>& planes, std::size_t i) {
  return {planes[0][i], planes[1][i], planes[2][i]};
}

Triple displayed_lab(const Frame& frame, std::size_t i) {
  const unsigned char* p = frame.rgbx + 4 * i;
  return lab_of_levels({double(p[0]), double(p[1]), double(p[2])});
}

double colour_difference(const FramePair& frames, const std::vector<bool>& counted,
                         const Watch& watch) {
  std::vector<double> differences;
  for (std::size_t i = 0; i < counted.size(); ++i) {
    if (i % 65536 == 0) watch.check();
    if (!counted[i]) continue;
    const unsigned char *a = frames.a.rgbx + 4 * i, *b = frames.b.rgbx + 4 * i;
    differences.push_back(std::equal(a, a + 3, b) ? 0
                                                  : ciede2000(displayed_lab(frames.a, i),
                                                              displayed_lab(frames.b, i)));
  }
  return percentile(std::move(differences), 0.99);
}

double banding(const FramePair& frames, const std::vector<bool>& counted) {
  auto width = static_cast<std::size_t>(frames.b.width);
  auto height = static_cast<std::size_t>(frames.b.height);
  std::vector<Contour> found = contours(frames.a.rgbx, width, height, counted);
  Displayed displayed(frames.scene_b.image,
                      make_output(frames.scene_b, frames.b.plan.wavelengths_nm),
                      frames.b.exposure_ev);
  std::array planes = image_planes(frames.linear_b);
  std::erase_if(found, [&](const Contour& contour) {
    return !is_band(contour, [&](std::size_t i) { return displayed.levels(at(planes, i)); });
  });
  auto all = std::ranges::count(counted, true);
  double beside = static_cast<double>(pixels_beside(found, counted.size()));
  return all > 0 ? beside / static_cast<double>(all) : 0;
}

}  // namespace

void check_comparable(const Scene& a, const Scene& b) {
  auto colour = [](const Scene& scene) {
    return scene.spectrum.colour == Colour::cie ? "\"cie\"" : "\"channels\"";
  };
  require_equal("/b/image/width", std::to_string(a.image.width), std::to_string(b.image.width));
  require_equal("/b/image/height", std::to_string(a.image.height),
                std::to_string(b.image.height));
  require_equal("/b/spectrum/colour", colour(a), colour(b));
}

namespace {

/// By the plan of a frame that is displayed, where that has no planes.
Frame linear_frame(Engine& engine, const Scene& scene, const Frame& displayed,
                   const Watch& watch) {
  if (!displayed.planes.empty()) return displayed;
  Scene linear = scene;
  linear.image.format = ImageFormat::npy;
  return engine.render(linear, displayed.plan, watch);
}

}  // namespace

FramePair render_pair(Engine& engine, const Scene& a, const Scene& b, const Watch& watch) {
  FramePair pair;
  pair.scene_b = bare(b);
  pair.b = engine.render(pair.scene_b, part_of(watch, 0, 0.4));
  pair.linear_b = linear_frame(engine, pair.scene_b, pair.b, part_of(watch, 0.4, 0.5));
  Scene scene_a = bare(a);
  Plan plan = engine.plan(scene_a, watch);
  // The exposure of a scene is relative to its own sun.
  double sun_a = make_output(scene_a, plan.wavelengths_nm).white_card,
         sun_b = make_output(pair.scene_b, pair.b.plan.wavelengths_nm).white_card;
  scene_a.image.exposure_ev = pair.b.exposure_ev + std::log2(sun_a / sun_b);
  scene_a.image.tone_map = b.image.tone_map;
  scene_a.image.white = b.image.white;
  pair.a = engine.render(scene_a, plan, part_of(watch, 0.5, 0.9));
  pair.linear_a = linear_frame(engine, scene_a, pair.a, part_of(watch, 0.9, 1));
  return pair;
}

Comparison compare(const FramePair& frames, const Watch& watch) {
  std::vector<bool> counted = measured_pixels(frames.scene_b);
  Comparison result;
  Colour colour = frames.scene_b.spectrum.colour;
  result.measure =
      measure_error(in_error_channels(image_planes(frames.linear_a), colour, counted),
                    in_error_channels(image_planes(frames.linear_b), colour, counted), 3);
  watch.check();
  result.ciede2000_p99 = colour_difference(frames, counted, watch);
  result.banding = banding(frames, counted);
  return result;
}

std::vector<double> in_error_channels(const std::array<const float*, 3>& rgb, Colour colour,
                                      const std::vector<bool>& counted) {
  std::vector<double> values;
  values.reserve(3 * static_cast<std::size_t>(std::ranges::count(counted, true)));
  for (std::size_t i = 0; i < counted.size(); ++i) {
    if (!counted[i]) continue;
    Triple pixel = at(rgb, i);
    if (colour == Colour::cie) pixel = xyz_from_rec709() * pixel;
    values.insert(values.end(), pixel.begin(), pixel.end());
  }
  return values;
}

std::vector<float> error_map(const std::array<const float*, 3>& a,
                             const std::array<const float*, 3>& b, Colour colour,
                             const std::vector<bool>& counted) {
  std::vector<double> d = relative_differences(in_error_channels(a, colour, counted),
                                               in_error_channels(b, colour, counted), 3);
  std::vector<float> map(counted.size(), std::numeric_limits<float>::quiet_NaN());
  auto from = d.begin();
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (!counted[i]) continue;
    map[i] = static_cast<float>((from[0] + from[1] + from[2]) / 3);
    from += 3;
  }
  return map;
}

std::vector<float> error_map(const FramePair& frames) {
  return error_map(image_planes(frames.linear_a), image_planes(frames.linear_b),
                   frames.scene_b.spectrum.colour, measured_pixels(frames.scene_b));
}

std::array<const float*, 3> image_planes(const Frame& frame) {
  return {frame.planes[0].samples, frame.planes[1].samples, frame.planes[2].samples};
}

}  // namespace cyanometer
