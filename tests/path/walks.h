// The walks of shaders/methods/path.glsl in double: the device's own code, on the CPU.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/methods/path/guide.h"
#include "engine/physics/pack.h"

namespace cyanometer {

class Walks {
 public:
  using P = Physics<double>;

  explicit Walks(const Problem& problem, std::uint32_t seed = 0)
      : p_(pack<double>(problem)), orders_(problem.scattering_orders), seed_(seed) {
    set_path_guide(p_, problem);
  }

  /// What one walk finds from the second order on, by wavelength; `ray` and `number` only
  /// choose its random numbers.
  glm::dvec4 walk(const glm::dvec3& direction, std::uint32_t ray, std::uint32_t number) {
    P::Stream stream{ray, number, seed_};
    glm::dvec4 throughput[P::GROUPS_SIZE], radiance[P::GROUPS_SIZE] = {};
    P::Path path = p_.path_from_camera(direction);
    if (!p_.meets_planet(path)) return radiance[0];
    P::Walk walk = p_.start_walk(path, stream, throughput);
    bool ground_first = false;
    while (p_.step_walk(walk, stream, orders_, p_.end_of_flight(path, walk), 0, throughput,
                        radiance, ground_first)) {
    }
    return radiance[0];
  }

  P& physics() { return p_; }

 private:
  P p_;
  int orders_;
  std::uint32_t seed_;
};

}  // namespace cyanometer
