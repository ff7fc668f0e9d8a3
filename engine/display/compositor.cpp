#include "engine/display/compositor.h"

#include <algorithm>
#include <cmath>

#include "engine/display/displayed.h"
#include "engine/methods/tables/fill.h"
#include "spirv/compose.spv.h"
#include "spirv/display.spv.h"
#include "spirv/fill_levels.spv.h"
#include "spirv/fill_planes.spv.h"
#include "spirv/overlay.spv.h"
#include "spirv/stars.spv.h"
#include "spirv/store.spv.h"

namespace cyanometer {
namespace {

struct ComposePush {
  std::array<float, 4> inscatter, ground, sun, transmittance;
  std::int32_t first_ray, rays_in_tile, first_row, accumulate, mark_outside, listed;
};
struct StarsPush {
  std::int32_t first_ray, rays_in_tile, first_row, first_star, stars, planes, listed;
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
struct FillPush {
  std::int32_t side, width, panel, first, end;
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

/// As texels of four words: whole ones.
vulkan::Binding in_fours(const vulkan::Binding& words) {
  constexpr std::size_t four = 16;
  return {words.buffer, words.offset, words.size / four * four};
}

}  // namespace

FrameStore::FrameStore(vulkan::Device& device, vulkan::BufferPool& pool, std::size_t pixels_,
                       std::size_t groups, bool displayed)
    : pixels(pixels_) {
  std::size_t alignment = std::max<std::size_t>(device.limits().storage_alignment, 64);
  stride = (pixels * sizeof(float) + alignment - 1) / alignment * alignment / sizeof(float);
  for (std::size_t g = 0; g < groups; ++g) {
    buffers.push_back(pool.take(4 * stride * sizeof(float), vulkan::Memory::host));
  }
  if (displayed) rgbx = pool.take(pixels * 4, vulkan::Memory::host);
}

vulkan::Binding FrameStore::plane(std::size_t group, std::size_t k) const {
  return {*buffers[group], k * stride * sizeof(float), pixels * sizeof(float)};
}

std::span<float> FrameStore::samples(std::size_t group, std::size_t k) const {
  return buffers[group]->as<float>().subspan(k * stride, pixels);
}

void FrameStore::add_levels(vulkan::BufferPool& pool) {
  level_planes = pool.take(3 * stride * sizeof(float), vulkan::Memory::host);
}

vulkan::Binding FrameStore::level(std::size_t c) const {
  return {*level_planes, c * stride * sizeof(float), pixels * sizeof(float)};
}

std::span<float> FrameStore::levels(std::size_t c) const {
  return level_planes->as<float>().subspan(c * stride, pixels);
}

PixelList::PixelList(vulkan::Device& device, const std::vector<int>& pixels)
    : numbers(upload(device, pixels)), count(static_cast<int>(pixels.size())) {}

double automatic_exposure_ev(std::span<const float> luminance, double white_card,
                             std::span<const float> areas) {
  // A stop above middle grey: skies are bright things.
  constexpr double aim = 0.36;
  // What is 8 stops below the mean is black in the picture however it is exposed: night sides
  // and grounds in the shade don't make the rest too bright.
  constexpr double black = 1.0 / 256;
  // A sample of the pixels is as good: their mean varies far less than an eye can tell.
  std::size_t step = areas.empty() ? std::max<std::size_t>(luminance.size() / 65536, 1) | 1 : 1;
  auto mean_over = [&](double least, auto value) {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < luminance.size(); i += step) {
      if (luminance[i] <= least) continue;
      const double area = areas.empty() ? 1 : areas[i];
      sum += area * value(luminance[i]);
      count += area;
    }
    return count > 0 ? sum / count : 0;
  };
  double mean = mean_over(0, [](double y) { return y; });
  if (!(mean > 0)) return 0;
  double log_mean = mean_over(black * mean, [](double y) { return std::log2(y); });
  return std::log2(aim * white_card) - log_mean;
}

Compositor::Compositor(vulkan::Device& device)
    : compose_(device, compose_spirv, UploadedScene::bindings + 7, sizeof(ComposePush)),
      stars_(device, stars_spirv, UploadedScene::bindings + 8, sizeof(StarsPush)),
      overlay_(device, overlay_spirv, UploadedScene::bindings + 8, sizeof(OverlayPush)),
      display_(device, display_spirv, 8, sizeof(DisplayPush)),
      fill_levels_(device, fill_levels_spirv, 6, sizeof(FillPush)),
      fill_planes_(device, fill_planes_spirv, 4, sizeof(FillPush)),
      store_(device, store_spirv, 1, sizeof(std::int32_t)) {}

Compositor::Job Compositor::prepare(vulkan::Device& device, const UploadedScene& scene,
                                    const std::vector<PlaneGroup>& groups, std::size_t first,
                                    std::size_t wavelengths) {
  const Problem& problem = scene.problem();
  std::size_t count = problem.wavelengths_nm.size();
  Job job{groups,
          first == 0,
          first + count == wavelengths,
          {},
          upload(device, matrix_rows(groups, first, count)),
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

void Compositor::compose(vulkan::Commands& commands, const Job& job, const UploadedScene& scene,
                         const Tile& tile, const FrameStore& store, const PixelList* listed) {
  for (std::size_t g = 0; g < job.groups.size(); ++g) {
    const PlaneGroup& group = job.groups[g];
    std::vector<vulkan::Binding> bindings =
        scene.bind({tile.values, job.matrix, store.plane(g, 0), store.plane(g, 1),
                    store.plane(g, 2), store.plane(g, 3)});
    std::vector<vulkan::Binding> composed = bindings;
    composed.push_back(listed ? vulkan::Binding(listed->numbers) : bindings.back());
    ComposePush push{group.inscatter,         group.ground,   group.sun,
                     group.transmittance,     tile.first_ray, tile.rays,
                     static_cast<int>(4 * g), !job.first,     job.last && g == 0,
                     listed != nullptr};
    commands.dispatch(compose_, scene.constants(), composed, vulkan::bytes_of(push),
                      {vulkan::groups_for(tile.rays, 64)});
    if (group.stars && (!listed || listed->stars))
      compose_stars(commands, job, scene, tile, g, std::move(bindings), listed);
  }
}

void Compositor::compose_stars(vulkan::Commands& commands, const Job& job,
                               const UploadedScene& scene, const Tile& tile, std::size_t group,
                               std::vector<vulkan::Binding> bindings, const PixelList* listed) {
  const std::vector<int>& pixels = job.stars.pixels;
  int first = tile.first_ray, stars = tile.rays;
  if (!listed) {
    auto from = std::lower_bound(pixels.begin(), pixels.end(), tile.first_ray);
    auto end = std::lower_bound(from, pixels.end(), tile.first_ray + tile.rays);
    first = static_cast<int>(from - pixels.begin());
    stars = static_cast<int>(end - from);
  }
  if (stars == 0) return;
  bindings.push_back(job.star_buffers[0]);
  bindings.push_back(job.star_buffers[1]);
  StarsPush push{tile.first_ray,
                 tile.rays,
                 static_cast<int>(4 * group),
                 first,
                 stars,
                 static_cast<int>(job.groups[group].channels.size()),
                 listed != nullptr};
  commands.dispatch(stars_, scene.constants(), bindings, vulkan::bytes_of(push),
                    {vulkan::groups_for(stars, 64)});
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
  display(tracer, image, output, exposure_ev, store, nullptr);
}

void Compositor::display(Tracer& tracer, const Image& image, const Output& output,
                         double exposure_ev, const FrameStore& store, const PixelList& listed) {
  display(tracer, image, output, exposure_ev, store, &listed);
}

void Compositor::display(Tracer& tracer, const Image& image, const Output& output,
                         double exposure_ev, const FrameStore& store, const PixelList* listed) {
  constexpr int pixels_at_once = 1 << 20;
  Matrix matrix = display_matrix(output, exposure_ev);
  DisplayPush push{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t c = 0; c < 3; ++c) {
      push.rows[row][c] = static_cast<float>(matrix[3 * row + c]);
    }
  }
  vulkan::Specialization constants{static_cast<std::uint32_t>(image.tone_map),
                                   image.show.clipped, listed != nullptr};
  const vulkan::Binding rgbx(*store.rgbx, 0, store.pixels * 4);
  std::vector<vulkan::Binding> bindings{store.plane(0, 0), store.plane(0, 1), store.plane(0, 2),
                                        rgbx};
  if (listed) {
    bindings.emplace_back(listed->numbers);
    for (std::size_t c = 0; c < 3; ++c) bindings.push_back(store.level(c));
  } else {
    for (int i = 0; i < 4; ++i) bindings.push_back(rgbx);
  }
  int pixels = listed ? listed->count : static_cast<int>(store.pixels);
  for (push.first = 0; push.first < pixels; push.first = push.end) {
    push.end = std::min(push.first + pixels_at_once, pixels);
    tracer.commands.dispatch(display_, constants, bindings, vulkan::bytes_of(push),
                             {vulkan::groups_for(push.end - push.first, 64)});
    tracer.submit();
  }
}

double Compositor::store_only(Tracer& tracer, const FrameStore& store) {
  const auto words = static_cast<std::int32_t>(store.pixels / 4);
  auto run = [&](const vulkan::Binding& to) {
    tracer.commands.dispatch(store_, {}, {to}, vulkan::bytes_of(words),
                             {vulkan::groups_for(static_cast<std::size_t>(words), 64)},
                             vulkan::Order::independent);
  };
  if (store.rgbx) {
    run(in_fours({*store.rgbx, 0, store.pixels * 4}));
  } else {
    for (std::size_t c = 0; c < 3; ++c) run(in_fours(store.plane(0, c)));
  }
  const auto start = std::chrono::steady_clock::now();
  tracer.submit();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

void Compositor::fill(Tracer& tracer, const Lattice& lattice,
                      const std::vector<PlaneGroup>& groups, const FrameStore& store) {
  const bool levels = store.level_planes != nullptr;
  for (const auto& [side, corners] : lattice.cells()) {
    const int at_once = side >= 4 && lattice.width() % 4 == 0 ? 4 : 1;
    const vulkan::Specialization constants{static_cast<std::uint32_t>(at_once)};
    const vulkan::Buffer cells = upload(tracer.device, corners);
    const int invocations = static_cast<int>(corners.size()) * side / at_once;
    const FillPush push{side, lattice.width(), lattice.panel(), 0, invocations};
    auto run = [&](const vulkan::Kernel& kernel, const std::vector<vulkan::Binding>& bindings) {
      tracer.commands.dispatch(kernel, constants, bindings, vulkan::bytes_of(push),
                               {vulkan::groups_for(invocations, 64)});
    };
    if (levels) {
      const vulkan::Binding rgbx(*store.rgbx, 0, store.pixels * 4);
      run(fill_levels_,
          {cells, store.level(0), store.level(1), store.level(2), rgbx, in_fours(rgbx)});
    } else {
      for (std::size_t g = 0; g < groups.size(); ++g) {
        for (std::size_t k = 0; k < groups[g].channels.size(); ++k) {
          const vulkan::Binding plane = store.plane(g, k);
          run(fill_planes_, {cells, plane, plane, in_fours(plane)});
        }
      }
    }
    tracer.submit();
  }
}

}  // namespace cyanometer
