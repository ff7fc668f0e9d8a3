// The methods there are.
#include "engine/lattice/lattice.h"
#include "engine/methods/bruneton/bruneton.h"
#include "engine/methods/hillaire/hillaire.h"
#include "engine/methods/method.h"
#include "engine/methods/moments/moments.h"
#include "engine/methods/nishita/nishita.h"
#include "engine/methods/path/path.h"
#include "engine/methods/raymarch/raymarch.h"

namespace cyanometer {
const std::vector<MethodDescription>& methods() {
  static const std::vector<MethodDescription> all{
      nishita_description(),  raymarch_description(), hillaire_description(),
      bruneton_description(), moments_description(),  path_description(),
  };
  return all;
}

MethodDescription interpolated(MethodDescription description) {
  description.options.push_back(
      {.name = "interpolation",
       .title = "Interpolation",
       .description = "How far a pixel between rays that are traced may be off, as a share of "
                      "its value; rays are as many as that takes, in frames of " +
                      std::to_string(Lattice::fewest_pixels) +
                      " pixels and more over an even ground. 0 traces every pixel.",
       .unit = "",
       .minimum = 0,
       .maximum = 0.1,
       .default_value = 0,
       .integer = false,
       .finest = 0});
  double tolerance = 0.004;
  for (auto& options : description.ladder) {
    options["interpolation"] = tolerance;
    tolerance /= 2;
  }
  return description;
}

std::vector<Panels> Method::tables(Tracer&, const UploadedScene&, const MethodOptions&) {
  return {};
}

std::vector<std::unique_ptr<Method>> make_methods(vulkan::Device& device) {
  std::vector<std::unique_ptr<Method>> all;
  all.push_back(make_nishita(device));
  all.push_back(make_raymarch(device));
  all.push_back(make_hillaire(device));
  all.push_back(make_bruneton(device));
  all.push_back(make_moments(device));
  all.push_back(make_path(device));
  return all;
}

double Tracer::submit() {
  double ms = commands.submit_and_wait();
  device_ms += ms;
  watch.check();
  return ms;
}

}  // namespace cyanometer
