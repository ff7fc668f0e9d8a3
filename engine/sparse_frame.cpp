// Frames of which some rays are traced and the other pixels follow between them (lattice/).
#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/parts.h"

namespace cyanometer {
namespace {

/// Of a displayed frame: well below the half of a level that 8 bits leave open.
constexpr float tolerance_of_levels = 0.3f;

float median_of_positive(std::span<const float> values, const std::vector<int>& pixels) {
  std::vector<float> positive;
  for (int pixel : pixels) {
    const float value = values[static_cast<std::size_t>(pixel)];
    if (value > 0) positive.push_back(value);
  }
  if (positive.empty()) return 0;
  auto middle = positive.begin() + static_cast<std::ptrdiff_t>(positive.size() / 2);
  std::ranges::nth_element(positive, middle);
  return *middle;
}

}  // namespace

class Engine::Parts::SparseFrame {
 public:
  /// @param work  outlives it
  SparseFrame(Parts& parts, const FrameWork& work, const Watch& watch)
      : parts_(parts),
        work_(work),
        watch_(watch),
        quiet_{watch.gone, watch.deadline, [](double) {}},
        camera_(pack<double>(work.problem)),
        lattice_(camera_),
        tracer_(parts.tracer(work.plan.method, quiet_)),
        displayed_(work.store.rgbx != nullptr) {
    if (displayed_) work.store.add_levels(parts.buffers);
    batches_ = parts_.upload(work.problem, {{glm::dvec3(0, 0, 1)}});
    for (const Batch& batch : batches_) {
      jobs_.push_back(parts_.compositor.prepare(parts_.device, batch.scene, work.groups,
                                                batch.first,
                                                work.problem.wavelengths_nm.size()));
    }
  }

  /// Traces what the lattice wants until it is settled.
  void settle() {
    const std::vector<int> first = lattice_.wanted();
    trace(first);
    tracer_.submit();
    // Near enough to tell what levels bend.
    work_.frame.exposure_ev = Parts::exposure_of(work_, luminance_of(first));
    show(first);
    const std::vector<Interpolated> values = interpolated(first);
    double left = 1;
    for (lattice_.settle(values); !lattice_.settled(); lattice_.settle(values)) {
      trace(lattice_.wanted());
      show(lattice_.wanted());
      watch_.progress(1 - (left /= 2));
    }
  }

  void make() {
    settle();
    expose();
    parts_.compositor.fill(tracer_, lattice_, work_.groups, work_.store);
    add_stars();
    work_.store.level_planes.reset();  // the frame's memory is that of what it shows
  }

  int traced() const { return lattice_.traced(); }

 private:
  /// Leaves the planes of these pixels to be submitted.
  void trace(const std::vector<int>& pixels, bool stars = false) {
    darken_outside();
    if (pixels.empty()) return;
    if (!stars) traced_.insert(traced_.end(), pixels.begin(), pixels.end());
    std::vector<glm::dvec3> directions;
    directions.reserve(pixels.size());
    for (int pixel : pixels) directions.push_back(camera_.pixel_ray(pixel).direction);
    std::vector<Batch> listed;
    for (const Batch& batch : batches_) {
      listed.push_back({batch.first, batch.scene.with_directions(parts_.device, directions)});
    }
    PixelList list(parts_.device, pixels);
    list.stars = stars;
    parts_.trace_tiles(tracer_, work_.plan.method, work_.plan.options, listed, list.count,
                       [&](std::size_t b, const Tile& tile) {
                         parts_.compositor.compose(parts_.commands, jobs_[b], listed[b].scene,
                                                   tile, work_.store, &list);
                         const bool last = tile.first_ray + tile.rays == list.count;
                         if (b + 1 < listed.size() || !last) tracer_.submit();
                       });
  }

  /// What lies outside a fisheye's circle, as a frame whose pixels are all traced has it.
  void darken_outside() {
    for (int pixel : lattice_.outside()) {
      const auto at = static_cast<std::size_t>(pixel);
      for (std::size_t g = 0; g < work_.groups.size(); ++g) {
        for (std::size_t k = 0; k < 4; ++k) work_.store.samples(g, k)[at] = 0;
      }
      work_.store.samples(0, 3)[at] = -1;
      if (!displayed_) continue;
      for (std::size_t c = 0; c < 3; ++c) work_.store.levels(c)[at] = 0;
      work_.store.rgbx->as<std::uint32_t>()[at] = 0xff000000u;
    }
  }

  void show(const std::vector<int>& pixels) {
    if (pixels.empty()) return;
    if (!displayed_) {
      tracer_.submit();
      return;
    }
    parts_.compositor.display(tracer_, work_.scene.image, work_.output, work_.frame.exposure_ev,
                              work_.store, PixelList(parts_.device, pixels));
  }

  std::vector<float> luminance_of(const std::vector<int>& pixels) const {
    std::vector<float> luminance;
    for (int pixel : pixels)
      luminance.push_back(work_.store.samples(0, 3)[static_cast<std::size_t>(pixel)]);
    return luminance;
  }

  /// By all of the frame; what was shown before is shown again.
  void expose() {
    std::vector<float> luminance = luminance_of(lattice_.singles()),
                       areas(luminance.size(), 1.f);
    for (const auto& [side, cells] : lattice_.cells()) {
      for (int first : cells) {
        float sum = 0;
        for (int corner : lattice_.corners(first, side))
          sum += work_.store.samples(0, 3)[static_cast<std::size_t>(corner)];
        luminance.push_back(sum / 4);
        areas.push_back(static_cast<float>(lattice_.pixels(first, side)));
      }
    }
    const double before =
        std::exchange(work_.frame.exposure_ev, Parts::exposure_of(work_, luminance, areas));
    if (work_.frame.exposure_ev != before) show(traced_);
  }

  /// All planes that the frame has, by the contract's measure of errors; colours beside the
  /// luminance.
  std::vector<Interpolated> interpolated(const std::vector<int>& pixels) const {
    constexpr float share_of_median = 0.01f;
    const auto tolerance = static_cast<float>(work_.plan.options.at("interpolation"));
    std::vector<Interpolated> values;
    for (std::size_t g = 0; g < work_.groups.size(); ++g) {
      for (std::size_t k = 0; k < work_.groups[g].channels.size(); ++k) {
        const std::span<const float> plane = work_.store.samples(g, k);
        values.push_back({plane, tolerance, true,
                          g == 0 ? work_.store.samples(0, 3) : std::span<const float>(),
                          share_of_median * median_of_positive(plane, pixels)});
      }
    }
    for (std::size_t c = 0; displayed_ && c < 3; ++c)
      values.push_back({work_.store.levels(c), tolerance_of_levels});
    return values;
  }

  void add_stars() {
    const std::vector<int>& pixels = jobs_.front().stars.pixels;
    if (pixels.empty()) return;
    trace(pixels, true);
    show(pixels);
  }

  Parts& parts_;
  const FrameWork& work_;
  const Watch& watch_;
  const Watch quiet_;
  Physics<double> camera_;
  Lattice lattice_;
  Tracer tracer_;
  bool displayed_;
  std::vector<Batch> batches_;
  std::vector<Compositor::Job> jobs_;
  std::vector<int> traced_;  ///< pixels
};

namespace {

/// The same picture of so many pixels at the most, without what it is stored for.
Scene counted_scene(const Scene& scene, double most_pixels) {
  Scene small = scene;
  Image& image = small.image;
  const double scale =
      std::min(1.0, std::sqrt(most_pixels / (1.0 * image.width * image.height)));
  const bool cube = scene.camera.projection == Projection::cubemap;
  image.width = std::max(1, static_cast<int>(image.width * scale));
  image.height = cube ? 6 * image.width : std::max(1, static_cast<int>(image.height * scale));
  image.format = ImageFormat::npy;
  image.channels = Channels::rgb;
  image.layers = {};
  image.show.stars = false;
  return small;
}

}  // namespace

bool Engine::Parts::is_sparse(const FrameWork& work) {
  const auto tolerance = work.plan.options.find("interpolation");
  return tolerance != work.plan.options.end() && tolerance->second > 0 && !work.picture &&
         !work.problem.ground && work.store.pixels >= Lattice::fewest_pixels;
}

void Engine::Parts::make_sparsely(const FrameWork& work, const Watch& watch) {
  SparseFrame(*this, work, watch).make();
}

double Engine::Parts::sparse_rays_of(const Scene& scene, const Watch& watch) {
  constexpr double counted_pixels = 1 << 17;
  const double pixels = 1.0 * scene.image.width * scene.image.height;
  const auto& options = scene.method.options;
  const auto asked = options.find("interpolation");
  const bool all_rays =
      scene.method.name != "auto" && (asked == options.end() || asked->second == 0);
  if (all_rays || pixels < Lattice::fewest_pixels ||
      !std::holds_alternative<UniformSurface>(scene.planet.surface))
    return 0;
  const Scene small = counted_scene(scene, counted_pixels);
  Plan plan;
  plan.method = "raymarch";
  plan.options = {{"view_nodes", 3}, {"interpolation", Extent::tolerance}};
  plan.wavelengths_nm = some_wavelengths_of(small);
  plan.wavelengths_nm.resize(std::min<std::size_t>(plan.wavelengths_nm.size(), 4));
  const Problem problem = make_problem(small, plan.wavelengths_nm);
  const Output output = make_output(small, plan.wavelengths_nm);
  const std::vector<PlaneGroup> groups = plane_groups(small, problem, output);
  Frame frame;
  FrameStore store(device, buffers, static_cast<std::size_t>(problem.width) * problem.height,
                   groups.size(), false);
  const FrameWork work{small, problem, output, plan, groups, nullptr, frame, store};
  SparseFrame counted(*this, work, watch);
  counted.settle();
  // What bends along lines takes more rays as their length, what bends everywhere as the area.
  const double share = counted.traced() / static_cast<double>(store.pixels),
               power = std::min(0.6 + 1.7 * share, 2.0),
               finer = std::sqrt(pixels / static_cast<double>(store.pixels));
  return counted.traced() * std::pow(finer, power);
}

}  // namespace cyanometer
