#include "engine/methods/hillaire/hillaire.h"

#include "engine/methods/hillaire/sky_tracer.h"
#include "engine/methods/tables/fill.h"
#include "spirv/hillaire_march.spv.h"

namespace cyanometer {
namespace {

using namespace hillaire;

struct MarchPush {
  std::int32_t first, end, first_ray, rays_in_tile, all_orders, samples, sun;
  float scale_height_km;
  std::int32_t cut_only;
};

class Hillaire final : public Method {
 public:
  explicit Hillaire(vulkan::Device& device)
      : tables_(device),
        sky_(device),
        march_(device, hillaire_march_spirv, UploadedScene::bindings + 6, sizeof(MarchPush)) {}

  const MethodDescription& description() const override { return hillaire_description(); }

  double evaluations(const Problem& problem, const MethodOptions& options,
                     double rays) const override {
    Sizes sizes = Sizes::of(options, problem.scattering_orders);
    double media = std::max<double>(static_cast<double>(problem.media.size()), 1);
    bool inside = problem.camera.altitude_km <= problem.thickness_km;
    bool table = inside && options.at("march_pixels") == 0 && problem.sun_distance_km == 0 &&
                 problem.sun_disc_samples == 1;
    double marched =
        table ? double(sizes.azimuths) * sizes.elevations : rays * problem.sun_disc_samples;
    // Fitted to the times of random scenes (`audit`): a lookup of the light, and the density of
    // each constituent.
    double multiple = double(sizes.multiple_suns) * sizes.multiple_altitudes *
                      options.at("multiple_directions") * options.at("multiple_samples") *
                      (4 + 0.75 * media);
    constexpr double a_lookup = 6, a_ray = 46;
    double nodes = marched * sizes.view_samples * (3.2 + 0.5 * media);
    return multiple + nodes + rays * (table ? a_lookup : a_ray);
  }

  int rays_at_once(const UploadedScene&, const MethodOptions&, const Pacer&) const override {
    return 1 << 16;
  }

  void trace(Tracer& tracer, const UploadedScene& scene, const MethodOptions& options,
             const Tile& tile) override {
    Sizes sizes = Sizes::of(options, scene.problem().scattering_orders);
    if (options.at("march_pixels") != 0 || !sky_.serves(scene, sizes)) {
      march(tracer, scene, sizes, false, tile);
      return;
    }
    if (!scene.all_end(tile.first_ray, tile.rays)) sky_trace(tracer, scene, sizes, tile);
    if (!scene.any_ends(tile.first_ray, tile.rays)) return;
    if (sky_.serves(scene, sizes.of_parts())) {
      sky_trace(tracer, scene, sizes.of_parts(), tile);
    } else {
      march(tracer, scene, sizes, true, tile);
    }
  }

 private:
  void sky_trace(Tracer& tracer, const UploadedScene& scene, const Sizes& sizes,
                 const Tile& tile) {
    sky_.trace(tracer, scene, sizes, tables_.get(tracer, scene, sizes, true), tile);
  }

  /// @param cut_only  leaves alone the rays that go on as far as they can
  void march(Tracer& tracer, const UploadedScene& scene, const Sizes& sizes, bool cut_only,
             const Tile& tile) {
    TablesOfView tables = tables_.get(tracer, scene, sizes, false);
    vulkan::Specialization specialization = constants(scene, sizes);
    auto bindings = bind(scene, *tables.air, {tables.columns->values, tile.values});
    MarchPush push{0,
                   0,
                   tile.first_ray,
                   tile.rays,
                   sizes.several_orders(),
                   sizes.view_samples,
                   0,
                   scale_height_km(scene.problem()),
                   cut_only};
    for (push.sun = 0; push.sun < scene.disc_points(); ++push.sun) {
      fill_table(tracer, {march_, specialization, bindings}, tile.rays,
                 2 * most_nodes(sizes.view_samples) * evaluations_per_node(scene), push);
    }
  }

  TableMaker tables_;
  SkyTracer sky_;
  vulkan::Kernel march_;
};

MethodOption size_option(const char* name, const char* title, const char* description,
                         double minimum, double maximum, double default_value,
                         ErrorSource lessens) {
  return {.name = name,
          .title = title,
          .description = description,
          .unit = "",
          .minimum = minimum,
          .maximum = maximum,
          .default_value = default_value,
          .integer = true,
          .logarithmic = minimum > 0,
          .lessens = lessens,
          .finest = maximum > 1 ? std::nullopt : std::optional(maximum)};
}

/// All options, those of the sky view given.
MethodOptions sky_sizes(int azimuths, int elevations, int view_samples) {
  return {{"transmittance_cosines", 256},
          {"transmittance_altitudes", 64},
          {"multiple_suns", 32},
          {"multiple_altitudes", 32},
          {"multiple_directions", 64},
          {"multiple_samples", 20},
          {"sky_azimuths", azimuths},
          {"sky_elevations", elevations},
          {"view_samples", view_samples},
          {"forward_share", 0.5},
          {"march_pixels", 0}};
}

}  // namespace

const MethodDescription& hillaire_description() {
  static const MethodDescription description = interpolated(
      {.name = "hillaire",
       .title = "Hillaire's tables",
       .summary =
           "Small tables of transmittance, of multiple scattering as isotropic light closed by "
           "a geometric series, and of the sky as the camera sees it. Milliseconds for a "
           "frame.",
       .limits =
           {{"Orders two and up scatter evenly into all directions, and light of each is "
             "taken to be the same all around a point: a frame is off by 3 to 8 % by day "
             "in clear air, 9 to 22 % in haze, smoke and at sunset, a quarter under thick "
             "clouds, a third to a half from a sun of -9 deg on, at a limb and at an orbital "
             "sunrise.",
             {3, 7, 9, 11, 12, 16, 21, 22}},
            {"Light that went once sideways and once straight on is missing around the "
             "sun, and taken from half of each forward peak instead.",
             {3, 13, 14},
             [](const SceneTraits& scene) { return scene.asymmetry > 0.5; }},
            {"Of a number of orders above one, the series has as many terms; light that "
             "the ground reflects more than once is counted with all of its orders.",
             {8},
             [](const SceneTraits& scene) { return scene.scattering_orders > 1; }},
            {"Before objects near the camera most of the air's light is of orders two and "
             "up: it is off by 20 % in haze by day, by a third and more at sunset.",
             {2},
             [](const SceneTraits& scene) { return scene.haze > 0.02; }},
            {"Seen from below 10 m, ground within a tenth of a degree of the horizon is "
             "off by 2 %.",
             {1},
             [](const SceneTraits& scene) { return scene.altitude_km < 0.02; }},
            {"Layers thinner than a few hundred metres fall between the table's samples.",
             {15}},
            {"From outside the air, light that grazes a layer which nearly hides it changes "
             "between the samples of a ray along the limb: half of it was missing at 16 "
             "samples, 2 % at 64.",
             {},
             [](const SceneTraits& scene) {
               return scene.altitude_km > scene.thickness_km && scene.depth > 0.5;
             }},
            {"The sky of a camera between 20 and 100 km is off by up to 5 % next to the "
             "horizon, where few rows of the table lie.",
             {},
             [](const SceneTraits& scene) {
               return scene.altitude_km > 0.2 * scene.thickness_km &&
                      scene.altitude_km < scene.thickness_km;
             }},
            {"Light of a sun many degrees wide comes from its centre from the second "
             "order on.",
             {17},
             [](const SceneTraits& scene) { return scene.sun_diameter_deg > 5; }},
            {"Where the ground differs from place to place, the light that it sends back "
             "into the air is that of its mean albedo, slopes and the sea see an even "
             "sky, and heights shade the air not at all.",
             {},
             [](const SceneTraits& scene) { return scene.varied_ground; }}},
       // Sizes are the paper's, but for the sky view: of ratios and with Gauss nodes 64
       // azimuths and 16 samples do what 192 and 32 do.
       .options =
           {size_option("transmittance_cosines", "Transmittance: directions",
                        "Zenith cosines of the table of optical depths.", 8, 1024, 256,
                        ErrorSource::tables),
            size_option("transmittance_altitudes", "Transmittance: altitudes",
                        "Altitudes of the table of optical depths.", 8, 512, 64,
                        ErrorSource::tables),
            size_option("multiple_suns", "Multiple scattering: suns",
                        "Sun cosines of the table of multiple scattering.", 4, 256, 32,
                        ErrorSource::tables),
            size_option("multiple_altitudes", "Multiple scattering: altitudes",
                        "Altitudes of the table of multiple scattering.", 4, 256, 32,
                        ErrorSource::tables),
            size_option("multiple_directions", "Multiple scattering: directions",
                        "Directions over the sphere about each of its points.", 8, 1024, 64,
                        ErrorSource::quadrature),
            size_option("multiple_samples", "Multiple scattering: samples",
                        "Samples along each of these directions.", 4, 64, 20,
                        ErrorSource::quadrature),
            size_option("sky_azimuths", "Sky view: azimuths",
                        "Azimuths of the sky view, from the sun's to the opposite one.", 2, 512,
                        64, ErrorSource::tables),
            size_option("sky_elevations", "Sky view: elevations",
                        "Elevations of the sky view, half above and half below the horizon.", 4,
                        512, 108, ErrorSource::tables),
            size_option("view_samples", "View samples",
                        "Samples along each ray of the sky view, or of each pixel.", 4, 64, 16,
                        ErrorSource::quadrature),
            {.name = "forward_share",
             .title = "Forward share",
             .description = "Of the light that its mean cosine says a constituent scatters "
                            "forwards, the share that orders two and up take as not scattered; "
                            "0 is Hillaire's own method.",
             .unit = "",
             .minimum = 0,
             .maximum = 0.9,
             .default_value = 0.5,
             .integer = false},
            size_option(
                "march_pixels", "March each pixel",
                "1 marches every pixel instead of reading the sky view, as is always done "
                "from outside the air and for a near or wide sun.",
                0, 1, 0, ErrorSource::tables)},
       .ladder = {sky_sizes(32, 64, 12), sky_sizes(64, 108, 16), sky_sizes(192, 216, 32)},
       .variations = {{{"sky_azimuths", 16}, {"sky_elevations", 32}, {"view_samples", 8}},
                      {{"march_pixels", 1}},
                      {{"forward_share", 0}}}});
  return description;
}

std::unique_ptr<Method> make_hillaire(vulkan::Device& device) {
  return std::make_unique<Hillaire>(device);
}

}  // namespace cyanometer
