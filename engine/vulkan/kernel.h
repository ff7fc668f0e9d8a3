// A compute shader, ready to be specialised and dispatched.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/vulkan/device.h"

namespace cyanometer::vulkan {

/// The bits of the constant with constant_id i, i = 0, 1, ...; ids that a shader lacks are
/// idle.
using Specialization = std::vector<std::uint32_t>;

/// SPIR-V with entry point `main` that uses the buffers 0 to bindings - 1 of set 0, as storage
/// buffers or, where it declares an imageBuffer, as texels (shaders/device.glsl says why). Its
/// pipelines are made at first use, one for all specializations that are alike in the constants
/// that the code has; of all kernels' the device keeps those used last
/// (Device::keep_pipelines). Kernels of the same code share theirs.
class Kernel {
 public:
  /// @throws std::invalid_argument where the device has fewer bindings or push constants
  Kernel(Device& device, std::span<const std::uint32_t> spirv, std::uint32_t bindings,
         std::size_t push_bytes = 0);

  /// Begins the pipeline of a specialization that will be dispatched later, beside others.
  void prepare(const Specialization& specialization) const;

  struct Program;
  const std::shared_ptr<Program>& program() const { return program_; }

 private:
  std::shared_ptr<Program> program_;
};

}  // namespace cyanometer::vulkan
