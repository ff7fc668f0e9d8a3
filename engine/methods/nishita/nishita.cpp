#include "engine/methods/nishita/nishita.h"

#include <optional>

#include "spirv/nishita.spv.h"

namespace cyanometer {
namespace {

struct Push {
  std::int32_t first_ray, rays_in_tile, first_sample, end_sample, view_samples, light_samples;
};

class Nishita final : public Method {
 public:
  explicit Nishita(vulkan::Device& device)
      : kernel_(device, nishita_spirv, UploadedScene::bindings + 2, sizeof(Push)) {}

  const MethodDescription& description() const override { return nishita_description(); }

  int rays_at_once(const UploadedScene& scene, const MethodOptions& options,
                   const Pacer& pacer) const override {
    constexpr int most = 1 << 16;  // keeps a tile of three wavelengths in the processor's cache
    std::int64_t fit = pacer.evaluations() / evaluations_per_sample(scene, options);
    return static_cast<int>(std::clamp<std::int64_t>(fit / 64 * 64, 64, most));
  }

  void trace(Tracer& tracer, const UploadedScene& scene, const MethodOptions& options,
             const Tile& tile) override {
    Push push{tile.first_ray, tile.rays, 0, 0, option(options, "view_samples"),
              option(options, "light_samples")};
    const vulkan::Buffer& columns = columns_for(tracer.device, scene, tile.rays);
    std::vector<vulkan::Binding> bindings = scene.bind({tile.values, columns});
    std::int64_t sample_cost = evaluations_per_sample(scene, options) * tile.rays;
    while (push.end_sample < push.view_samples) {
      std::int64_t fit = std::max<std::int64_t>(tracer.pacer.evaluations() / sample_cost, 1);
      push.first_sample = push.end_sample;
      push.end_sample = static_cast<int>(
          std::min<std::int64_t>(push.first_sample + fit, push.view_samples));
      tracer.commands.dispatch(kernel_, scene.constants(), bindings, vulkan::bytes_of(push),
                               {vulkan::groups_for(tile.rays, 64)});
      double ms = tracer.submit();
      tracer.pacer.took(sample_cost * (push.end_sample - push.first_sample), ms);
    }
  }

 private:
  static int option(const MethodOptions& options, const char* name) {
    return static_cast<int>(options.at(name));
  }

  /// Of one sample of one view ray: its light rays and itself, weighed by the constituents.
  static std::int64_t evaluations_per_sample(const UploadedScene& scene,
                                             const MethodOptions& options) {
    std::int64_t samples =
        std::int64_t{option(options, "light_samples")} * scene.disc_points() + 1;
    return samples * std::max(scene.media(), 1);
  }

  /// Column sums between two dispatches; kept, because most frames want the same.
  const vulkan::Buffer& columns_for(vulkan::Device& device, const UploadedScene& scene,
                                    int rays) {
    std::size_t bytes = sizeof(float) * std::max(scene.media(), 1) * rays;
    if (!columns_ || columns_->size() < bytes) {
      columns_.emplace(device, bytes, vulkan::Memory::device);
    }
    return *columns_;
  }

  vulkan::Kernel kernel_;
  std::optional<vulkan::Buffer> columns_;
};

}  // namespace

const MethodDescription& nishita_description() {
  static const MethodDescription description{
      .name = "nishita",
      .title = "Nishita's nested march",
      .summary = "Single scattering by the midpoint rule, uniform in distance on the view ray and "
                 "on a light ray from each of its samples. Simple, exact in the limit, slow.",
      .highest_order = 1,
      .limits = {"Multiple scattering is left out: the blue of the sky is up to half too dark, "
                 "twilight and thick haze far too dark.",
                 "Few samples lose thin layers near the ground: a yellow horizon.",
                 "The planet's shadow on a view ray converges slowly."},
      .options = {{.name = "view_samples",
                   .title = "View samples",
                   .description = "Samples along each view ray.",
                   .unit = "",
                   .minimum = 1,
                   .maximum = 2000,
                   .default_value = 64,
                   .integer = true,
                   .logarithmic = true},
                  {.name = "light_samples",
                   .title = "Light samples",
                   .description = "Samples towards the sun from each sample of the view ray.",
                   .unit = "",
                   .minimum = 1,
                   .maximum = 2000,
                   .default_value = 16,
                   .integer = true,
                   .logarithmic = true}},
  };
  return description;
}

std::unique_ptr<Method> make_nishita(vulkan::Device& device) {
  return std::make_unique<Nishita>(device);
}

}  // namespace cyanometer
