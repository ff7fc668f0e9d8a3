#include "engine/accuracy/judgement.h"

#include <algorithm>

#include "engine/accuracy/banding.h"
#include "engine/accuracy/finest.h"
#include "engine/display/compositor.h"
#include "engine/display/displayed.h"
#include "engine/optics/ciede2000.h"

namespace cyanometer {
namespace {

using Samples = std::vector<std::vector<double>>;

std::array<const float*, 3> planes_of(const ExrImage& image) {
  return {image.planes[0].data(), image.planes[1].data(), image.planes[2].data()};
}

Triple pixel_of(const ExrImage& image, std::size_t i) {
  return {image.planes[0][i], image.planes[1][i], image.planes[2][i]};
}

/// At the wavelengths of the converged solution, with the ground and without the disc and
/// stars.
Scene converged_scene(const Scene& scene) {
  Scene result = scene;
  result.spectrum.wavelengths_nm = converged_wavelengths(scene);
  Image& image = result.image;
  image.format = ImageFormat::npy;
  image.channels = Channels::rgb;
  image.layers = {};
  image.show = {.sun = false, .stars = false, .ground = true, .clipped = false};
  return result;
}

/// Where the frame's ray meets air or ground and shows neither the disc nor a star.
std::vector<bool> counted_pixels(Engine& engine, const Scene& scene, const Watch& watch) {
  std::vector<bool> counted = measured_pixels(scene);
  const Show& show = scene.image.show;
  if (!show.sun && !show.stars) return counted;
  Scene lights = converged_scene(scene);
  lights.image.show = show;
  lights.method.scattering_orders = 0;
  Plan plan = finest_plan(lights, scene.spectrum.wavelengths_nm.empty()
                                      ? colour_wavelengths(4)
                                      : scene.spectrum.wavelengths_nm);
  plan.options = {{"view_nodes", 3}};  // transmittances do not depend on them
  Frame frame = engine.render(lights, plan, watch);
  for (const float* plane : image_planes(frame)) {
    for (std::size_t i = 0; i < counted.size(); ++i) {
      if (plane[i] != 0) counted[i] = false;
    }
  }
  return counted;
}

/// Walks along a ray in each half where four wavelengths or fewer are traced: some twenty
/// seconds on two cores of a software device.
constexpr std::int64_t most_walks_of_four = 16384;

Scene at(const Scene& scene, const std::vector<double>& wavelengths_nm) {
  Scene result = scene;
  result.spectrum.wavelengths_nm = wavelengths_nm;
  return result;
}

/// The converged solution of the sampled pixels as two halves, [half][pixel][channel]. Where
/// the scene leaves its wavelengths open, `path` walks at few, which leaves it more walks, and
/// what many would change is told without noise.
std::array<Samples, 2> converged_channels(Engine& engine, const Scene& asked,
                                          const JudgementGoal& goal, const Watch& watch) {
  bool open = asked.spectrum.wavelengths_nm.empty();
  Scene scene =
      at(converged_scene(asked), open ? colour_wavelengths(8) : asked.spectrum.wavelengths_nm);
  const std::vector<double>& few = scene.spectrum.wavelengths_nm;
  ReferenceGoal walked = goal.reference;
  auto groups = static_cast<std::int64_t>((few.size() + 3) / 4);
  walked.most_walks = std::min(walked.most_walks, most_walks_of_four / groups);
  Reference reference = make_reference(engine, scene, walked, "", part_of(watch, 0, 0.8));
  RayColours colours(scene, few);
  std::array halves{colours.error_channels(reference.halves[0]),
                    colours.error_channels(reference.halves[1])};
  if (!open) return halves;
  auto finest = [&](const std::vector<double>& wavelengths_nm) {
    Scene tinted = at(scene, wavelengths_nm);
    return RayColours(tinted, wavelengths_nm)
        .error_channels(engine
                            .radiance(tinted, reference.directions, false,
                                      finest_plan(tinted, wavelengths_nm),
                                      part_of(watch, 0.8, 1))
                            .relative);
  };
  Samples with_few = finest(few), with_many = finest(converged_wavelengths(asked));
  for (Samples& half : halves) {
    for (std::size_t i = 0; i < half.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) half[i][c] += with_many[i][c] - with_few[i][c];
    }
  }
  return halves;
}

/// The stratified pixels that count, and the image and the reference on them.
struct SampledImage {
  std::vector<std::size_t> pixels;
  Samples image;                  ///< [pixel][channel]
  std::array<Samples, 2> halves;  ///< [half][pixel][channel]
  std::vector<Triple> reference;  ///< linear, as displayed
};

SampledImage sample(const Scene& scene, const ExrImage& image,
                    const std::array<Samples, 2>& halves, const std::vector<int>& pixels,
                    const std::vector<bool>& counted) {
  bool cie = scene.spectrum.colour == Colour::cie;
  SampledImage sampled;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    auto pixel = static_cast<std::size_t>(pixels[i]);
    if (!counted[pixel]) continue;
    sampled.pixels.push_back(pixel);
    Triple value = pixel_of(image, pixel), mean;
    if (cie) value = xyz_from_rec709() * value;
    sampled.image.emplace_back(value.begin(), value.end());
    for (std::size_t half : {0, 1}) sampled.halves[half].push_back(halves[half][i]);
    for (std::size_t c = 0; c < 3; ++c) mean[c] = (halves[0][i][c] + halves[1][i][c]) / 2;
    sampled.reference.push_back(cie ? rec709_from_xyz() * mean : mean);
  }
  return sampled;
}

/// That of the scene, or what it would be for the sampled pixels.
double exposure_of(const Scene& scene, const SampledImage& sampled, const Output& output) {
  if (scene.image.exposure_ev) return *scene.image.exposure_ev;
  std::vector<float> luminance;
  for (const Triple& rgb : sampled.reference) {
    double y = scene.spectrum.colour == Colour::cie ? (xyz_from_rec709() * rgb)[1]
                                                    : (rgb[0] + rgb[1] + rgb[2]) / 3;
    luminance.push_back(static_cast<float>(y));
  }
  return automatic_exposure_ev(luminance, output.white_card);
}

double colour_difference(const SampledImage& sampled, const ExrImage& image,
                         const Displayed& displayed) {
  std::vector<double> differences;
  for (std::size_t i = 0; i < sampled.pixels.size(); ++i) {
    differences.push_back(
        ciede2000(lab_of_levels(displayed.levels(pixel_of(image, sampled.pixels[i]))),
                  lab_of_levels(displayed.levels(sampled.reference[i]))));
  }
  return percentile(std::move(differences), 0.99);
}

std::vector<unsigned char> display(const ExrImage& image, const Displayed& displayed,
                                   const std::vector<bool>& counted, const Watch& watch) {
  std::vector<unsigned char> rgbx(4 * counted.size());
  for (std::size_t i = 0; i < counted.size(); ++i) {
    if (i % 65536 == 0) watch.check();
    if (!counted[i]) continue;
    Triple levels = displayed.levels(pixel_of(image, i));
    for (std::size_t c = 0; c < 3; ++c) {
      rgbx[4 * i + c] = static_cast<unsigned char>(levels[c] + 0.5);
    }
  }
  return rgbx;
}

/// Of `found`, evenly spread, at most so many.
std::vector<Contour> some_of(const std::vector<Contour>& found, std::size_t most) {
  std::vector<Contour> some;
  std::size_t count = std::min(found.size(), most);
  for (std::size_t i = 0; i < count; ++i) some.push_back(found[i * found.size() / count]);
  return some;
}

/// The share of contours that the scene does not have, told from rays through the ends of some.
double share_of_bands(Engine& engine, const Scene& scene, const std::vector<Contour>& some,
                      const Displayed& displayed, const Watch& watch) {
  if (some.empty()) return 0;
  // How levels change from pixel to pixel, few wavelengths tell.
  std::vector<double> wavelengths = scene.spectrum.wavelengths_nm.empty()
                                        ? colour_wavelengths(8)
                                        : scene.spectrum.wavelengths_nm;
  RayColours colours(scene, wavelengths);
  std::vector<int> ends;
  for (const Contour& contour : some) {
    ends.push_back(static_cast<int>(contour.first));
    ends.push_back(static_cast<int>(contour.last));
  }
  Plan plan = finest_plan(scene, wavelengths);
  Samples radiance =
      engine.radiance(scene, pixel_directions(scene, ends), false, plan, watch).relative;
  std::size_t bands = 0;
  for (std::size_t i = 0; i < some.size(); ++i) {
    bands += is_band(some[i], [&](std::size_t pixel) {
      return displayed.levels(colours.rgb(radiance[2 * i + (pixel == some[i].last)]));
    });
  }
  return static_cast<double>(bands) / static_cast<double>(some.size());
}

}  // namespace

Comparison judge(Engine& engine, const Scene& asked, const ExrImage& image,
                 const JudgementGoal& goal, const Watch& watch) {
  std::vector<bool> counted = counted_pixels(engine, asked, part_of(watch, 0, 0.1));
  Scene scene = converged_scene(asked);
  std::array halves = converged_channels(engine, asked, goal, part_of(watch, 0.1, 0.8));
  SampledImage sampled =
      sample(scene, image, halves, sample_pixels(scene, goal.reference.rays), counted);
  Comparison result;
  EstimatedError error = measure_error(sampled.image, sampled.halves[0], sampled.halves[1]);
  result.measure = error.measure;
  result.error_95 = {error.low, error.high};
  Output output = make_output(scene, scene.spectrum.wavelengths_nm);
  Displayed displayed(scene.image, output, exposure_of(scene, sampled, output));
  result.ciede2000_p99 = colour_difference(sampled, image, displayed);
  std::vector<unsigned char> rgbx = display(image, displayed, counted, watch);
  std::vector<Contour> found =
      contours(rgbx.data(), static_cast<std::size_t>(scene.image.width),
               static_cast<std::size_t>(scene.image.height), counted);
  double beside =
      static_cast<double>(pixels_beside(found, counted.size())) /
      static_cast<double>(std::max<std::ptrdiff_t>(std::ranges::count(counted, true), 1));
  result.banding =
      beside * share_of_bands(engine, asked,
                              some_of(found, static_cast<std::size_t>(goal.contours)),
                              displayed, part_of(watch, 0.8, 1));
  return result;
}

std::vector<float> judged_map(Engine& engine, const Scene& asked, const ExrImage& image,
                              const Watch& watch) {
  std::vector<bool> counted = counted_pixels(engine, asked, part_of(watch, 0, 0.2));
  Scene scene = converged_scene(asked);
  Frame frame = engine.render(scene, finest_plan(scene, scene.spectrum.wavelengths_nm),
                              part_of(watch, 0.2, 1));
  return error_map(planes_of(image), image_planes(frame), scene.spectrum.colour, counted);
}

}  // namespace cyanometer
