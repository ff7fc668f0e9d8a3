#include "engine/vulkan/spirv.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>

namespace cyanometer::vulkan {
namespace {

using Words = std::span<const std::uint32_t>;

// SPIR-V 1.6, chapter 3.
constexpr std::uint32_t op_type_image = 25, op_type_pointer = 32, op_variable = 59,
                        op_decorate = 71;
constexpr std::uint32_t decoration_spec_id = 1, decoration_binding = 33;

/// All instructions of an opcode, each with its operands, of which there are at least so many.
std::vector<Words> instructions(Words spirv, std::uint32_t opcode, std::size_t operands) {
  constexpr std::size_t header_words = 5;
  std::vector<Words> found;
  for (std::size_t at = header_words; at < spirv.size();) {
    const std::size_t words = spirv[at] >> 16;
    if (words == 0 || words > spirv.size() - at)
      throw std::invalid_argument("SPIR-V ends within an instruction");
    if ((spirv[at] & 0xffff) == opcode && words > operands)
      found.push_back(spirv.subspan(at + 1, words - 1));
    at += words;
  }
  return found;
}

/// The number that a decoration gives, by id of what is decorated.
std::map<std::uint32_t, std::uint32_t> decorations(Words spirv, std::uint32_t decoration) {
  std::map<std::uint32_t, std::uint32_t> found;
  for (Words operands : instructions(spirv, op_decorate, 3))
    if (operands[1] == decoration) found[operands[0]] = operands[2];
  return found;
}

VkFormat format_of(std::uint32_t image_format) {
  switch (image_format) {  // SPIR-V 3.11
    case 1:
      return VK_FORMAT_R32G32B32A32_SFLOAT;
    case 3:
      return VK_FORMAT_R32_SFLOAT;
    case 30:
      return VK_FORMAT_R32G32B32A32_UINT;
    case 33:
      return VK_FORMAT_R32_UINT;
    default:
      throw std::invalid_argument("a kernel's imageBuffer has format " +
                                  std::to_string(image_format) +
                                  " of SPIR-V; known are r32f, rgba32f, r32ui, rgba32ui");
  }
}

}  // namespace

std::vector<std::uint32_t> constant_ids(Words spirv) {
  std::vector<std::uint32_t> ids;
  for (const auto& [constant, id] : decorations(spirv, decoration_spec_id)) ids.push_back(id);
  std::ranges::sort(ids);
  return ids;
}

std::vector<VkFormat> texel_formats(Words spirv, std::uint32_t count) {
  std::map<std::uint32_t, std::uint32_t> image_formats, pointed_at;
  for (Words image : instructions(spirv, op_type_image, 8)) image_formats[image[0]] = image[7];
  for (Words pointer : instructions(spirv, op_type_pointer, 3))
    pointed_at[pointer[0]] = pointer[2];
  const auto bindings = decorations(spirv, decoration_binding);
  std::vector<VkFormat> formats(count, VK_FORMAT_UNDEFINED);
  for (Words variable : instructions(spirv, op_variable, 3)) {
    const auto binding = bindings.find(variable[1]);
    const auto image = image_formats.find(pointed_at[variable[0]]);
    if (binding == bindings.end() || image == image_formats.end()) continue;
    if (binding->second < count) formats[binding->second] = format_of(image->second);
  }
  return formats;
}

}  // namespace cyanometer::vulkan
