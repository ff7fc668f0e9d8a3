#include "engine/display/compositor.h"

#include <algorithm>
#include <cmath>

#include "engine/display/displayed.h"
#include "engine/methods/tables/fill.h"
#include "spirv/compose.spv.h"
#include "spirv/display.spv.h"
#include "spirv/overlay.spv.h"
#include "spirv/stars.spv.h"

namespace cyanometer {
namespace {

struct ComposePush {
  std::array<float, 4> inscatter, ground, sun, transmittance;
  std::int32_t first_ray, rays_in_tile, first_row, accumulate, mark_outside;
};
struct StarsPush {
  std::int32_t first_ray, rays_in_tile, first_row, first_star, stars, planes;
};
struct OverlayPush {
  std::array<float, 4> luminance;
  float object, background, transmittance;
  std::int32_t first, end;
};
struct DisplayPush {
  std::array<std::array<float, 4>, 3> rows;
  std::int32_t first, end;
};

/// A row in groups of four wavelengths, `count` from the `first` on.
void append_row(std::vector<glm::vec4>& matrix, const std::vector<double>& row,
                std::size_t first, std::size_t count) {
  for (std::size_t g = 0; g < (count + 3) / 4; ++g) {
    glm::vec4 part(0);
    for (std::size_t lane = 0; lane < 4; ++lane) {
      std::size_t w = 4 * g + lane;
      if (w < count && first + w < row.size()) {
        part[static_cast<int>(lane)] = static_cast<float>(row[first + w]);
      }
    }
    matrix.push_back(part);
  }
}

/// Rows of all groups, one after another.
std::vector<glm::vec4> matrix_rows(const std::vector<PlaneGroup>& groups, std::size_t first,
                                   std::size_t count) {
  std::vector<glm::vec4> matrix;
  for (const PlaneGroup& group : groups) {
    for (const std::vector<double>& row : group.rows) append_row(matrix, row, first, count);
  }
  return matrix;
}

template <typename T>
vulkan::Buffer upload(vulkan::Device& device, const std::vector<T>& values) {
  auto bytes = std::as_bytes(std::span(values));
  vulkan::Buffer buffer(device, bytes.size(), vulkan::Memory::device);
  buffer.write(0, bytes);
  return buffer;
}

}  // namespace

FrameStore::FrameStore(vulkan::Device& device, std::size_t pixels_, std::size_t groups,
                       bool displayed)
    : pixels(pixels_) {
  std::size_t alignment = std::max<std::size_t>(device.limits().storage_alignment, 64);
  stride = (pixels * sizeof(float) + alignment - 1) / alignment * alignment / sizeof(float);
  for (std::size_t g = 0; g < groups; ++g) {
    buffers.emplace_back(device, 4 * stride * sizeof(float), vulkan::Memory::host);
  }
  if (displayed) rgbx.emplace_back(device, pixels * 4, vulkan::Memory::host);
}

vulkan::Binding FrameStore::plane(std::size_t group, std::size_t k) const {
  return {buffers[group], k * stride * sizeof(float), pixels * sizeof(float)};
}

std::span<const float> FrameStore::samples(std::size_t group, std::size_t k) const {
  return buffers[group].as<const float>().subspan(k * stride, pixels);
}

double automatic_exposure_ev(std::span<const float> luminance, double white_card) {
  // A stop above middle grey: skies are bright things.
  constexpr double aim = 0.36;
  // What is 8 stops below the mean is black in the picture however it is exposed: night sides
  // and grounds in the shade don't make the rest too bright.
  constexpr double black = 1.0 / 256;
  // A sample of the pixels is as good: their mean varies far less than an eye can tell.
  std::size_t step = std::max<std::size_t>(luminance.size() / 65536, 1) | 1;
  auto mean_over = [&](double least, auto value) {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < luminance.size(); i += step) {
      if (luminance[i] <= least) continue;
      sum += value(luminance[i]);
      ++count;
    }
    return count > 0 ? sum / count : 0;
  };
  double mean = mean_over(0, [](double y) { return y; });
  if (!(mean > 0)) return 0;
  double log_mean = mean_over(black * mean, [](double y) { return std::log2(y); });
  return std::log2(aim * white_card) - log_mean;
}

Compositor::Compositor(vulkan::Device& device)
    : compose_(device, compose_spirv, UploadedScene::bindings + 6, sizeof(ComposePush)),
      stars_(device, stars_spirv, UploadedScene::bindings + 8, sizeof(StarsPush)),
      overlay_(device, overlay_spirv, UploadedScene::bindings + 8, sizeof(OverlayPush)),
      display_(device, display_spirv, 4, sizeof(DisplayPush)) {}

Compositor::Job Compositor::prepare(vulkan::Device& device, const UploadedScene& scene,
                                    const std::vector<PlaneGroup>& groups, std::size_t first,
                                    std::size_t wavelengths) {
  const Problem& problem = scene.problem();
  std::size_t count = problem.wavelengths_nm.size();
  Job job{scene,      groups,
          first == 0, first + count == wavelengths,
          {},         upload(device, matrix_rows(groups, first, count)),
          {}};
  if (problem.show.stars) {
    Physics<double> camera = pack<double>(problem);
    job.stars = star_pixels(problem, camera, star_light_);
  }
  if (!job.stars.pixels.empty()) {
    job.star_buffers.push_back(upload(device, job.stars.pixels));
    job.star_buffers.push_back(upload(device, job.stars.radiance));
  }
  return job;
}

void Compositor::compose(vulkan::Commands& commands, const Job& job, const Tile& tile,
                         const FrameStore& store) {
  auto first =
      std::lower_bound(job.stars.pixels.begin(), job.stars.pixels.end(), tile.first_ray);
  auto end = std::lower_bound(first, job.stars.pixels.end(), tile.first_ray + tile.rays);
  int stars = static_cast<int>(end - first);
  for (std::size_t g = 0; g < job.groups.size(); ++g) {
    const PlaneGroup& group = job.groups[g];
    std::vector<vulkan::Binding> bindings =
        job.scene.bind({tile.values, job.matrix, store.plane(g, 0), store.plane(g, 1),
                        store.plane(g, 2), store.plane(g, 3)});
    int first_row = static_cast<int>(4 * g);
    ComposePush push{group.inscatter,     group.ground,   group.sun,
                     group.transmittance, tile.first_ray, tile.rays,
                     first_row,           !job.first,     job.last && g == 0};
    commands.dispatch(compose_, job.scene.constants(), bindings, vulkan::bytes_of(push),
                      {vulkan::groups_for(tile.rays, 64)});
    if (!group.stars || stars == 0) continue;
    bindings.push_back(job.star_buffers[0]);
    bindings.push_back(job.star_buffers[1]);
    StarsPush stars_push{tile.first_ray, tile.rays,
                         first_row,      static_cast<int>(first - job.stars.pixels.begin()),
                         stars,          static_cast<int>(group.channels.size())};
    commands.dispatch(stars_, job.scene.constants(), bindings, vulkan::bytes_of(stars_push),
                      {vulkan::groups_for(stars, 64)});
  }
}

void Compositor::overlay(Tracer& tracer, const std::vector<UploadedScene>& scenes,
                         const std::array<std::vector<double>, 3>& rows, const Picture& picture,
                         const std::vector<PlaneGroup>& groups,
                         const std::array<double, 3>& luminance, const FrameStore& store) {
  std::vector<vulkan::Buffer> colours;
  for (const std::vector<float>& plane : picture.rgb) {
    colours.push_back(upload(tracer.device, plane));
  }
  std::size_t first = 0;
  for (const UploadedScene& scene : scenes) {
    std::size_t count = scene.problem().wavelengths_nm.size();
    std::vector<glm::vec4> matrix;
    for (const std::vector<double>& row : rows) append_row(matrix, row, first, count);
    first += count;
    vulkan::Buffer matrix_buffer = upload(tracer.device, matrix);
    std::int64_t evaluations =
        evaluations_per_column(scene.problem()) * scene.media() + 4 * scene.groups();
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const PlaneGroup& group = groups[g];
      if (!group.objects && !group.background && !group.transmittance_itself) continue;
      OverlayPush push{};
      for (std::size_t k = 0; g == 0 && k < 3; ++k) {
        push.luminance[k] = static_cast<float>(luminance[k]);
      }
      push.object = group.objects;
      push.background = group.background;
      push.transmittance = group.transmittance_itself;
      std::vector<vulkan::Binding> bindings =
          scene.bind({matrix_buffer, colours[0], colours[1], colours[2], store.plane(g, 0),
                      store.plane(g, 1), store.plane(g, 2), store.plane(g, 3)});
      fill_table(tracer, {overlay_, scene.constants(), bindings},
                 static_cast<int>(store.pixels), evaluations, push);
    }
  }
}

void Compositor::display(Tracer& tracer, const Image& image, const Output& output,
                         double exposure_ev, const FrameStore& store) {
  constexpr int pixels_at_once = 1 << 20;
  Matrix matrix = display_matrix(output, exposure_ev);
  DisplayPush push{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t c = 0; c < 3; ++c) {
      push.rows[row][c] = static_cast<float>(matrix[3 * row + c]);
    }
  }
  vulkan::Specialization constants{static_cast<std::uint32_t>(image.tone_map),
                                   image.show.clipped};
  int pixels = static_cast<int>(store.pixels);
  for (push.first = 0; push.first < pixels; push.first = push.end) {
    push.end = std::min(push.first + pixels_at_once, pixels);
    tracer.commands.dispatch(
        display_, constants,
        {store.plane(0, 0), store.plane(0, 1), store.plane(0, 2), store.rgbx.front()},
        vulkan::bytes_of(push), {vulkan::groups_for(push.end - push.first, 64)});
    tracer.submit();
  }
}

}  // namespace cyanometer
