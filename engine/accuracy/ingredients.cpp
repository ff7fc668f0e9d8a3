#include "engine/accuracy/ingredients.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include "engine/accuracy/error.h"
#include "engine/accuracy/finest.h"
#include "engine/accuracy/without_wavelength.h"
#include "engine/display/compositor.h"
#include "engine/display/displayed.h"
#include "engine/optics/ciede2000.h"

namespace cyanometer {
namespace {

using Samples = std::vector<std::vector<double>>;

constexpr int rays = 324;
constexpr int highest_order = 6;
constexpr double negligible = 1e-3;

bool is_numbered(const std::string& name, const std::string& kind) {
  return name.starts_with(kind) && name.size() > kind.size() &&
         std::all_of(name.begin() + static_cast<std::ptrdiff_t>(kind.size()), name.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::string key_of_constituent(const std::string& name) {
  bool reserved = name == "multiple_scattering" || name == "curvature" || name == "ground" ||
                  is_numbered(name, "order_") || is_numbered(name, "wavelength_");
  return (reserved ? "constituent." : "") + name;
}

/// Planned anew, whatever method it asks for.
Scene with_auto(const Scene& scene) {
  Scene result = scene;
  result.method = {};
  result.method.max_error = scene.method.max_error;
  result.method.max_ms = scene.method.max_ms;
  if (!result.method.max_error && !result.method.max_ms) result.method.max_error = 0.02;
  result.method.scattering_orders = scene.method.scattering_orders;
  return result;
}

Scene with_orders(const Scene& scene, int orders) {
  Scene result = scene;
  result.method.scattering_orders = orders;
  return result;
}

/// A scene, and what its light must be multiplied by.
struct Scaled {
  Scene scene;
  double factor = 1;
};

/// On a planet so large that the air is flat. A near sun stays as far from the foot point; its
/// irradiance holds at the planet's centre, which is farther now.
Scaled flat(const Scene& scene) {
  constexpr double huge_km = 1e7, large_km = 1e5;  // positions of a near sun are in float
  Scaled result{scene};
  double radius = scene.planet.radius_km;
  if (!scene.sun.distance_km) {
    result.scene.planet.radius_km = std::max(huge_km, radius);
    return result;
  }
  double larger = std::max(large_km, radius), from_centre = *scene.sun.distance_km;
  double up = std::sin(scene.sun.elevation_deg * std::numbers::pi / 180);
  double along = radius * up;  // from the foot point: d^2 + 2 d R sin e + R^2 = D^2
  double away = std::sqrt(along * along + from_centre * from_centre - radius * radius) - along;
  double farther = std::sqrt(larger * larger + away * away + 2 * larger * away * up);
  result.scene.planet.radius_km = larger;
  result.scene.sun.distance_km = farther;
  result.factor = from_centre * from_centre / (farther * farther);
  return result;
}

/// The ground black. Of a world with heights these stay, under ice, for a sea would mirror; a
/// map's go with its colours.
Scene over_black(const Scene& scene) {
  Scene result = scene;
  auto* world = std::get_if<ProceduralSurface>(&result.planet.surface);
  if (world && world->relief_km > 0) {
    world->ice_latitude_deg = 0;
    world->ice = 0.0;
  } else {
    result.planet.surface = UniformSurface();
    result.planet.ground_albedo = 0.0;
  }
  return result;
}

/// What the rays show, at some wavelengths.
struct Light {
  std::vector<double> wavelengths_nm;
  Samples radiance;
};

/// The same without one wavelength.
Light without(const Light& light, std::size_t wavelength) {
  auto place = static_cast<std::ptrdiff_t>(wavelength);
  Light rest = light;
  rest.wavelengths_nm.erase(rest.wavelengths_nm.begin() + place);
  for (std::vector<double>& ray : rest.radiance) ray.erase(ray.begin() + place);
  return rest;
}

double luminance(const Triple& rgb, Colour colour) {
  return colour == Colour::cie ? (xyz_from_rec709() * rgb)[1] : (rgb[0] + rgb[1] + rgb[2]) / 3;
}

class Explainer {
 public:
  Explainer(Engine& engine, const Scene& scene, const Watch& watch)
      : engine_(engine),
        watch_(watch),
        quiet_(watch),
        whole_(with_auto(scene)),
        directions_(sample_directions(scene, rays)) {
    quiet_.progress = [](double) {};
    plan_ = engine_.plan(whole_, quiet_);
    light_ = light(whole_, plan_.wavelengths_nm);
    display();
    steps_ = static_cast<double>(whole_.atmosphere.constituents.size()) + 2 +
             (has_multiple() ? highest_order : 0) +
             (open_wavelengths() ? static_cast<double>(plan_.wavelengths_nm.size()) : 0);
  }

  std::vector<Worth> all() {
    constituents();
    orders();
    add_without("curvature", flat(whole_));
    add_without("ground", {over_black(whole_)});
    if (whole_.spectrum.colour == Colour::cie) {
      open_wavelengths() ? numbers_of_wavelengths() : given_wavelengths();
    }
    return std::move(found_);
  }

 private:
  bool has_multiple() const { return whole_.method.scattering_orders.value_or(2) > 1; }
  bool open_wavelengths() const { return whole_.spectrum.wavelengths_nm.empty(); }

  Light light(const Scene& scene, const std::vector<double>& wavelengths_nm) {
    Plan finest = finest_plan(scene, wavelengths_nm);
    return {wavelengths_nm,
            engine_.radiance(scene, directions_, false, finest, quiet_).relative};
  }

  double planned_ms(const Scene& scene) { return engine_.plan(scene, quiet_).expected_ms; }

  /// The exposure of the whole scene, for all.
  void display() {
    RayColours colours(whole_, light_.wavelengths_nm);
    std::vector<float> bright;
    for (const std::vector<double>& ray : light_.radiance) {
      bright.push_back(static_cast<float>(luminance(colours.rgb(ray), whole_.spectrum.colour)));
    }
    double exposure_ev = whole_.image.exposure_ev.value_or(
        automatic_exposure_ev(bright, colours.output().white_card));
    displayed_.emplace(whole_.image, colours.output(), exposure_ev);
  }

  void add(const std::string& name, const Light& without, const Light& with, double ms_saved) {
    RayColours colours_without(whole_, without.wavelengths_nm),
        colours_with(whole_, with.wavelengths_nm);
    Worth worth{name,
                measure_error(colours_without.error_channels(without.radiance),
                              colours_with.error_channels(with.radiance))
                    .error,
                std::nullopt, ms_saved};
    std::vector<double> differences;
    for (std::size_t i = 0; i < directions_.size(); ++i) {
      auto lab = [&](const RayColours& colours, const Light& light) {
        return lab_of_levels(displayed_->levels(colours.rgb(light.radiance[i])));
      };
      differences.push_back(ciede2000(lab(colours_without, without), lab(colours_with, with)));
    }
    if (!differences.empty()) worth.ciede2000 = percentile(std::move(differences), 0.99);
    found_.push_back(std::move(worth));
    watch_.progress(std::min(static_cast<double>(found_.size()) / steps_, 1.0));
  }

  void add_without(const std::string& name, const Scaled& without) {
    Light rest = light(without.scene, light_.wavelengths_nm);
    for (std::vector<double>& ray : rest.radiance) {
      for (double& value : ray) value *= without.factor;
    }
    add(name, rest, light_, plan_.expected_ms - planned_ms(without.scene));
  }

  void constituents() {
    for (const auto& [name, unused] : whole_.atmosphere.constituents) {
      Scene without = whole_;
      without.atmosphere.constituents.erase(name);
      add_without(key_of_constituent(name), {without});
    }
  }

  void orders() {
    if (!has_multiple()) return;
    Scene scene = with_orders(whole_, 1);
    Light before = light(scene, light_.wavelengths_nm);
    double before_ms = planned_ms(scene);
    add("multiple_scattering", before, light_, plan_.expected_ms - before_ms);
    int last = std::min(highest_order, whole_.method.scattering_orders.value_or(highest_order));
    for (int order = 2; order <= last; ++order) {
      scene = with_orders(whole_, order);
      Light with = light(scene, light_.wavelengths_nm);
      double ms = planned_ms(scene);
      add("order_" + std::to_string(order), before, with, ms - before_ms);
      if (found_.back().error < negligible) break;
      before = std::move(with);
      before_ms = ms;
    }
  }

  void numbers_of_wavelengths() {
    auto scene_of = [&](int count) {
      Scene scene = whole_;
      scene.spectrum.wavelengths_nm = colour_wavelengths(count);
      return scene;
    };
    constexpr int fewest = 3;
    Light before = light(whole_, colour_wavelengths(fewest));
    double before_ms = planned_ms(scene_of(fewest));
    int most = static_cast<int>(plan_.wavelengths_nm.size());
    for (int count = fewest + 1; count <= most; ++count) {
      Light with = light(whole_, colour_wavelengths(count));
      double ms = planned_ms(scene_of(count));
      add("wavelength_" + std::to_string(count), before, with, ms - before_ms);
      before = std::move(with);
      before_ms = ms;
    }
  }

  void given_wavelengths() {
    std::size_t count = light_.wavelengths_nm.size();
    if (count < 2) return;
    double saved = plan_.expected_ms - planned_ms(without_wavelength(whole_, 0));
    for (std::size_t w = 0; w < count; ++w) {
      add("wavelength_" + std::to_string(w + 1), without(light_, w), light_, saved);
    }
  }

  Engine& engine_;
  const Watch& watch_;
  Watch quiet_;
  Scene whole_;
  std::vector<Direction> directions_;
  Plan plan_;
  Light light_;
  std::optional<Displayed> displayed_;
  double steps_ = 1;
  std::vector<Worth> found_;
};

}  // namespace

std::vector<Worth> explain(Engine& engine, const Scene& scene, const Watch& watch) {
  return Explainer(engine, scene, watch).all();
}

}  // namespace cyanometer
