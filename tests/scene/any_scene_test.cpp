// What the random scenes of the stability suite are drawn from: the whole schema.
#include "engine/stability/any_scene.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "engine/scene/document.h"

namespace cyanometer {
namespace {

using nlohmann::json;

/// A scene of each form.
json of_form(std::uint64_t form) { return any_scene(form * scenes_of_a_form); }

TEST(AnyScene, IsAllowedAndTheSameForTheSameSeed) {
  for (std::uint64_t form = 0; form < 60; ++form) {
    EXPECT_NO_THROW(read_scene(of_form(form))) << form;
    EXPECT_EQ(of_form(form), of_form(form));
  }
}

TEST(AnyScene, OfAFormDiffersInItsNumbersAlone) {
  int alike = 0;
  for (std::uint64_t form = 0; form < 20; ++form) {
    const json first = of_form(form), second = any_scene(form * scenes_of_a_form + 1);
    EXPECT_NE(first, second) << form;
    std::set<std::string> a, b;
    const json flat = first.flatten(), other = second.flatten();
    for (const auto& [pointer, value] : flat.items()) a.insert(pointer);
    for (const auto& [pointer, value] : other.items()) b.insert(pointer);
    alike += a == b;
  }
  // Numbers decide what is refused, and so left out.
  EXPECT_GE(alike, 8);
}

TEST(AnyScene, SaysWhateverASceneCanSay) {
  std::set<std::string> said;
  for (std::uint64_t form = 0; form < 400; ++form) {
    const json flat = of_form(form).flatten();
    for (const auto& [pointer, value] : flat.items()) {
      said.insert(pointer);
      if (value.is_string()) said.insert(value.get<std::string>());
    }
  }
  for (const char* word : {"exponential",
                           "tent",
                           "quadratic",
                           "uniform",
                           "table",
                           "henyey_greenstein",
                           "cornette_shanks",
                           "mie",
                           "molecules",
                           "particles",
                           "absorber",
                           "procedural",
                           "fisheye",
                           "equirectangular",
                           "cubemap",
                           "spectral",
                           "sun",
                           "solar",
                           "/sun/place/time",
                           "/sun/distance_km",
                           "/sun/irradiance/blackbody_k",
                           "/spectrum/wavelengths_nm/5",
                           "/planet/surface/relief_km",
                           "/planet/ground_albedo/values/0"})
    EXPECT_TRUE(said.contains(word)) << word;
}

}  // namespace
}  // namespace cyanometer
