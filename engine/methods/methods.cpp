// The methods there are.
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
