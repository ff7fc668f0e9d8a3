// What compiled shaders say of themselves.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <span>
#include <vector>

namespace cyanometer::vulkan {

/// Ids of the constants that SPIR-V leaves to its pipelines, in order. Optimised code has those
/// that it uses.
std::vector<std::uint32_t> constant_ids(std::span<const std::uint32_t> spirv);

/// What the bindings 0 to count - 1 of set 0 hold: texels of a format where the shader declares
/// an imageBuffer, VK_FORMAT_UNDEFINED where it declares a buffer of its own layout, or
/// nothing.
/// @throws std::invalid_argument where a format is none of r32f, rgba32f, r32ui, rgba32ui
std::vector<VkFormat> texel_formats(std::span<const std::uint32_t> spirv, std::uint32_t count);

}  // namespace cyanometer::vulkan
