// The table of optical depths to the top of the air (shaders/tables/optical_depth.glsl), made
// on the device and kept between requests under the air that it belongs to.
#pragma once

#include <memory>

#include "engine/methods/method.h"

namespace cyanometer {

/// Texels, at least 2 each; the defaults are those of Bruneton [2017].
struct OpticalDepthSize {
  int cosines = 256, altitudes = 64;
};

class OpticalDepthTable final : public Tables {
 public:
  OpticalDepthTable(vulkan::Device& device, OpticalDepthSize size, int groups);

  /// A Vec4 for each texel (rows of cosines) and group of wavelengths.
  const vulkan::Buffer& values() const { return values_; }
  std::size_t bytes() const override { return values_.size(); }

  /// A scene's constants and those of the table's size, ids 10 and 11: what a kernel with
  /// shaders/tables/optical_depth_buffer.glsl is specialised by. Its own begin at 12.
  static vulkan::Specialization constants(const UploadedScene& scene, OpticalDepthSize size);

 private:
  vulkan::Buffer values_;
};

class OpticalDepthTableMaker {
 public:
  explicit OpticalDepthTableMaker(vulkan::Device& device);

  std::shared_ptr<const OpticalDepthTable> get(Tracer& tracer, const UploadedScene& scene,
                                               OpticalDepthSize size);

 private:
  std::shared_ptr<const OpticalDepthTable> make(Tracer& tracer, const UploadedScene& scene,
                                                OpticalDepthSize size);

  vulkan::Kernel kernel_;
};

}  // namespace cyanometer
