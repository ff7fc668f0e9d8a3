#include "engine/methods/nishita/nishita.h"

#include "engine/methods/scratch.h"
#include "spirv/nishita.spv.h"

namespace cyanometer {
namespace {

/// Part of a march (shaders/methods/nishita.glsl).
struct Range {
  std::int32_t first_view, end_view, first_sun, end_sun, first_light, end_light;
};
struct NishitaPush {
  std::int32_t first_ray, rays_in_tile, view_samples, light_samples;
  Range range;
};

/// What a ray has to do: samples towards each sun from each sample of the view ray and from the
/// ground, which counts as the view sample after the last.
struct March {
  int view, suns, light;

  bool ends_with(const Range& range) const {
    return range.end_view > view && range.end_sun == suns && range.end_light == light;
  }

  /// The part after `done` that holds at most `most` light samples (at least one).
  Range after(const Range& done, std::int64_t most) const {
    if (done.end_light < light)
      return light_part(done.first_view, done.first_sun, done.end_light, most);
    if (done.end_sun < suns) return sun_part(done.first_view, done.end_sun, most);
    return view_part(done.end_view, most);
  }
  static Range nothing(int suns, int light) { return {0, 0, 0, suns, 0, light}; }

 private:
  Range light_part(int v, int k, int first, std::int64_t most) const {
    return {v, v + 1, k, k + 1, first, up_to(light, first, most)};
  }
  Range sun_part(int v, int first, std::int64_t most) const {
    if (most < light) return light_part(v, first, 0, most);
    return {v, v + 1, first, up_to(suns, first, most / light), 0, light};
  }
  Range view_part(int first, std::int64_t most) const {
    std::int64_t all_suns = std::int64_t{suns} * light;
    if (most < all_suns) return sun_part(first, 0, most);
    int end = first == view ? view + 1 : up_to(view, first, most / all_suns);
    return {first, end, 0, suns, 0, light};
  }
  static int up_to(int end, int first, std::int64_t most) {
    return static_cast<int>(
        std::min<std::int64_t>(end, first + std::max<std::int64_t>(most, 1)));
  }
};

/// Light samples whose loops stay below the drivers' limit.
std::int64_t most_light_samples(const UploadedScene& scene, const March& march) {
  int media = scene.media(), groups = scene.groups();
  std::int64_t a_light_sample = 1 + scene.density_iterations() + media;
  std::int64_t a_sun = scene.density_iterations() + 4 * media + groups * (2 * media + 1) +
                       (march.suns > 1 ? media * (groups + 12) : 0);
  return most_loop_iterations / (a_light_sample + a_sun / march.light + 1);
}

class Nishita final : public Method {
 public:
  explicit Nishita(vulkan::Device& device)
      : kernel_(device, nishita_spirv, UploadedScene::bindings + 2, sizeof(NishitaPush)) {}

  const MethodDescription& description() const override { return nishita_description(); }

  double evaluations(const Problem& problem, const MethodOptions& options,
                     double rays) const override {
    return rays * options.at("view_samples") *
           (options.at("light_samples") * problem.sun_disc_samples + 1) *
           std::max<double>(static_cast<double>(problem.media.size()), 1);
  }

  int rays_at_once(const UploadedScene& scene, const MethodOptions& options,
                   const Pacer& pacer) const override {
    // Whole marches in one dispatch where they fit: each part of one costs a ray its set-up
    // again. Enough rays to keep a device busy, and a tile that stays in the processor's cache.
    constexpr std::int64_t fewest = 1024, most = 1 << 16;
    March march = march_of(scene, options);
    std::int64_t samples = std::int64_t{march.view} * march.suns * march.light;
    std::int64_t fit = pacer.evaluations() / cost(scene, samples);
    return static_cast<int>(std::clamp(fit / 64 * 64, fewest, most));
  }

  void trace(Tracer& tracer, const UploadedScene& scene, const MethodOptions& options,
             const Tile& tile) override {
    March march = march_of(scene, options);
    Scratch::Loan columns = columns_.take(
        tracer.device, sizeof(float) * 2 * std::max(scene.media(), 1) * tile.rays);
    std::vector<vulkan::Binding> bindings = scene.bind({tile.values, *columns});
    std::int64_t loop_limit = most_light_samples(scene, march);
    NishitaPush push{tile.first_ray, tile.rays, march.view, march.light,
                     March::nothing(march.suns, march.light)};
    while (!march.ends_with(push.range)) {
      std::int64_t fit = tracer.pacer.evaluations() / cost(scene, tile.rays);
      push.range = march.after(push.range, std::clamp<std::int64_t>(fit, 1, loop_limit));
      tracer.commands.dispatch(kernel_, scene.constants(), bindings, vulkan::bytes_of(push),
                               {vulkan::groups_for(tile.rays, 64)});
      const Range& r = push.range;
      tracer.pacer.took(cost(scene, tile.rays) * (r.end_view - r.first_view) *
                            (r.end_sun - r.first_sun) * (r.end_light - r.first_light),
                        tracer.submit());
    }
  }

 private:
  static March march_of(const UploadedScene& scene, const MethodOptions& options) {
    return {static_cast<int>(options.at("view_samples")), scene.disc_points(),
            static_cast<int>(options.at("light_samples"))};
  }

  /// Evaluations of a number of samples: one for each constituent.
  static std::int64_t cost(const UploadedScene& scene, std::int64_t samples) {
    return samples * std::max(scene.media(), 1);
  }

  vulkan::Kernel kernel_;
  Scratch columns_;  ///< between two dispatches
};

}  // namespace

const MethodDescription& nishita_description() {
  static const MethodDescription description = interpolated({
      .name = "nishita",
      .title = "Nishita's nested march",
      .summary =
          "Single scattering by the midpoint rule, uniform in distance on the view ray and "
          "on a light ray from each of its samples. Simple, exact in the limit, slow.",
      .highest_order = 1,
      .limits = {{"Multiple scattering is left out: the blue of the sky is up to half too "
                  "dark, twilight and thick haze far too dark.",
                  {},
                  [](const SceneTraits& scene) { return scene.scattering_orders != 1; }},
                 {"Few samples lose thin layers near the ground: a yellow horizon, and in "
                  "dense haze nearly all light.",
                  {2, 3, 6, 11, 13, 15, 18, 20, 22}},
                 {"The planet's shadow on a view ray converges slowly.",
                  {7, 9},
                  [](const SceneTraits& scene) { return scene.sun_deg < 2; }},
                 {"Heights of the ground do not shade the air.",
                  {},
                  [](const SceneTraits& scene) { return scene.varied_ground; }}},
      .options = {{.name = "view_samples",
                   .title = "View samples",
                   .description = "Samples along each view ray.",
                   .unit = "",
                   .minimum = 1,
                   .maximum = 2000,
                   .default_value = 64,
                   .integer = true,
                   .logarithmic = true,
                   .lessens = ErrorSource::quadrature},
                  {.name = "light_samples",
                   .title = "Light samples",
                   .description = "Samples towards the sun from each sample of the view ray.",
                   .unit = "",
                   .minimum = 1,
                   .maximum = 2000,
                   .default_value = 16,
                   .integer = true,
                   .logarithmic = true,
                   .lessens = ErrorSource::quadrature}},
      .variations = {{{"view_samples", 4}, {"light_samples", 4}},
                     {{"view_samples", 8}, {"light_samples", 4}},
                     {{"view_samples", 16}, {"light_samples", 4}},
                     {{"view_samples", 16}, {"light_samples", 8}},
                     {{"view_samples", 32}, {"light_samples", 8}},
                     {{"view_samples", 64}, {"light_samples", 16}},
                     {{"view_samples", 128}, {"light_samples", 32}},
                     {{"view_samples", 256}, {"light_samples", 64}}},
  });
  return description;
}

std::unique_ptr<Method> make_nishita(vulkan::Device& device) {
  return std::make_unique<Nishita>(device);
}

}  // namespace cyanometer
