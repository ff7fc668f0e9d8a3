// Frames: all pixels of a plan, composed and displayed.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/image/encode.h"
#include "engine/parts.h"
#include "engine/scene/document.h"

namespace cyanometer {
namespace {

std::string describe(const Scene& scene, const Plan& plan) {
  nlohmann::json document = plan_document(plan);
  document["scene"] = canonical(scene);
  document["version"] = version();
  return document.dump();
}

/// The camera's rays, as a picture ends them.
Rays rays_of(const Picture* picture) {
  return picture ? Rays{{}, picture->distance_km} : Rays{};
}

}  // namespace

void Engine::Parts::trace_frame(const FrameWork& work, const Watch& watch) {
  std::vector<Batch> batches =
      upload_with_ground(work.problem, rays_of(work.picture), work.plan.method, watch);
  std::vector<Compositor::Job> jobs;
  for (const Batch& batch : batches) {
    jobs.push_back(compositor.prepare(device, batch.scene, work.groups, batch.first,
                                      work.problem.wavelengths_nm.size()));
  }
  Tracer tracer = this->tracer(work.plan.method, watch);
  auto compose = [&](std::size_t b, const Tile& tile) {
    compositor.compose(commands, jobs[b], batches[b].scene, tile, work.store);
    tracer.submit();
  };
  trace_tiles(tracer, work.plan.method, work.plan.options, batches,
              static_cast<int>(work.store.pixels), compose);
}

void Engine::Parts::overlay(const FrameWork& work, const Watch& watch) {
  std::vector<double> wavelengths = wavelengths_of_transmittance(work.scene);
  std::vector<UploadedScene> scenes;
  Problem problem = make_problem(work.scene, wavelengths);
  Picture shown = before_heights(problem, *work.picture, watch);
  for (Batch& batch : upload(problem, rays_of(&shown), transmittance_wavelengths)) {
    scenes.push_back(std::move(batch.scene));
  }
  std::array<double, 3> luminance{1. / 3, 1. / 3, 1. / 3};
  if (work.scene.spectrum.colour == Colour::cie) {
    std::ranges::copy_n(xyz_from_rec709().begin() + 3, 3, luminance.begin());
  }
  Tracer tracer = this->tracer("overlay", watch);
  compositor.overlay(tracer, scenes, transmittance_rows(work.scene, wavelengths), shown,
                     work.groups, luminance, work.store);
}

double Engine::Parts::exposure_of(const FrameWork& work, std::span<const float> luminance,
                                  std::span<const float> areas) {
  return work.scene.image.exposure_ev.value_or(
      automatic_exposure_ev(luminance, work.output.white_card, areas));
}

void Engine::Parts::make_pixel_by_pixel(const FrameWork& work, const Watch& watch) {
  trace_frame(work, watch);
  if (work.picture) overlay(work, watch);
  work.frame.exposure_ev = exposure_of(work, work.store.samples(0, 3));
  if (!work.store.rgbx) return;
  Tracer tracer = this->tracer("display", watch);
  compositor.display(tracer, work.scene.image, work.output, work.frame.exposure_ev, work.store);
}

Frame Engine::render(const Scene& scene, const Watch& watch) {
  auto start = Parts::Clock::now();
  Plan plan = parts_->plan_frame(scene, watch);
  double planning_ms = ms_since(start);
  Frame frame = render(scene, plan, watch);
  frame.prepare_ms += planning_ms;
  return frame;
}

Frame Engine::render(const Scene& scene, const Plan& plan, const Watch& watch) {
  return render(scene, plan, nullptr, watch);
}

Frame Engine::composite(const Scene& scene, const Picture& picture, const Watch& watch) {
  auto start = Parts::Clock::now();
  Plan plan = this->plan(scene, picture, watch);
  double planning_ms = ms_since(start);
  Frame frame = composite(scene, picture, plan, watch);
  frame.prepare_ms += planning_ms;
  return frame;
}

Frame Engine::composite(const Scene& scene, const Picture& picture, const Plan& plan,
                        const Watch& watch) {
  return render(scene, plan, &picture, watch);
}

Frame Engine::render(const Scene& scene, const Plan& plan, const Picture* picture,
                     const Watch& watch) {
  auto start = Parts::Clock::now();
  Frame frame;
  frame.width = scene.image.width;
  frame.height = scene.image.height;
  frame.plan = plan;
  Problem problem = make_problem(scene, frame.plan.wavelengths_nm);
  Output output = make_output(scene, frame.plan.wavelengths_nm);
  std::vector<PlaneGroup> groups =
      picture ? composite_groups(scene, problem, output) : plane_groups(scene, problem, output);
  auto store = std::make_shared<FrameStore>(
      parts_->device, parts_->buffers, static_cast<std::size_t>(frame.width) * frame.height,
      groups.size(), encoding(scene.image.format).displayed);
  const FrameWork work{scene, problem, output, frame.plan, groups, picture, frame, *store};
  frame.prepare_ms = ms_since(start);
  auto rendering = Parts::Clock::now();
  double tables_before = parts_->tables.making_ms();
  const bool sparse = Parts::is_sparse(work);
  if (sparse) {
    parts_->make_sparsely(work, watch);
  } else {
    parts_->make_pixel_by_pixel(work, watch);
  }
  double tables_ms = parts_->tables.making_ms() - tables_before;
  frame.prepare_ms += tables_ms;
  frame.render_ms = ms_since(rendering) - tables_ms;
  if (store->rgbx) frame.rgbx = store->rgbx->as<const unsigned char>().data();
  bool rgb = scene.image.channels == Channels::rgb;
  // What is interpolated as it is displayed has no other values.
  const bool linear = !sparse || !frame.rgbx;
  for (std::size_t g = rgb ? 0 : 1; linear && g < groups.size(); ++g) {
    for (std::size_t k = 0; k < groups[g].channels.size(); ++k) {
      frame.planes.push_back({groups[g].channels[k], store->samples(g, k).data()});
    }
  }
  frame.white_luminance =
      rgb && scene.spectrum.colour == Colour::cie ? output.white_luminance : 0;
  frame.description = describe(scene, frame.plan);
  frame.storage = store;
  return frame;
}

double Engine::store_ms(const Image& image, const Watch& watch) {
  constexpr int repeats = 15;
  const FrameStore store(parts_->device, parts_->buffers,
                         static_cast<std::size_t>(image.width) * image.height, 1,
                         encoding(image.format).displayed);
  Tracer tracer = parts_->tracer("display", watch);
  std::vector<double> times;
  for (int i = 0; i <= repeats; ++i) {
    const double ms = parts_->compositor.store_only(tracer, store);
    if (i > 0) times.push_back(ms);  // the first also compiles, and touches the memory
  }
  std::ranges::nth_element(times, times.begin() + repeats / 2);
  return times[repeats / 2];
}

}  // namespace cyanometer
