#include "engine/vulkan/buffer.h"

#include <cstring>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>

#include "engine/vulkan/buffer_allocation.h"
#include "engine/vulkan/commands.h"

namespace cyanometer::vulkan {
namespace {

constexpr VkMemoryPropertyFlags kVisible =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags kCached = kVisible | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;

/// The first of the wanted kinds of memory that there is.
std::uint32_t memory_type(const Device::Core& core, std::uint32_t allowed,
                          std::initializer_list<VkMemoryPropertyFlags> wanted) {
  for (const VkMemoryPropertyFlags flags : wanted)
    for (std::uint32_t i = 0; i < core.memory.memoryTypeCount; ++i)
      if ((allowed >> i & 1u) && (core.memory.memoryTypes[i].propertyFlags & flags) == flags)
        return i;
  throw Error(core.info.name + " has no memory for storage buffers");
}

std::uint32_t memory_type(const Device::Core& core, std::uint32_t allowed, Memory memory) {
  if (memory == Memory::host) return memory_type(core, allowed, {kCached, kVisible});
  if (core.limits.unified_memory)
    return memory_type(core, allowed, {kLocal | kCached, kLocal | kVisible, kLocal, 0});
  return memory_type(core, allowed, {kLocal, 0});
}

void allocate(Buffer::Allocation& a, Memory memory) {
  Device::Core& core = *a.core;
  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(core.device, *a.buffer, &needs);
  VkMemoryAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  info.allocationSize = needs.size;
  info.memoryTypeIndex = memory_type(core, needs.memoryTypeBits, memory);
  const VkMemoryType& type = core.memory.memoryTypes[info.memoryTypeIndex];
  if (needs.size > core.memory.memoryHeaps[type.heapIndex].size ||
      core.allocated_bytes + needs.size > core.most_bytes) {
    throw OutOfMemory(a.size);
  }
  const VkResult result = vkAllocateMemory(core.device, &info, nullptr, a.memory.out());
  if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
    throw OutOfMemory(a.size);
  check(result, "vkAllocateMemory");
  a.memory_bytes = needs.size;
  core.allocated_bytes += needs.size;
  check(vkBindBufferMemory(core.device, *a.buffer, *a.memory, 0), "vkBindBufferMemory");
  if ((type.propertyFlags & kVisible) == kVisible)
    check(vkMapMemory(core.device, *a.memory, 0, VK_WHOLE_SIZE, 0, &a.mapped), "vkMapMemory");
}

void require_range(std::size_t size, std::size_t offset, std::size_t bytes) {
  if (offset > size || bytes > size - offset)
    throw std::out_of_range("bytes " + std::to_string(offset) + " to " +
                            std::to_string(offset + bytes) + " of a buffer of " +
                            std::to_string(size));
}

}  // namespace

Buffer::Buffer(Device& device, std::size_t bytes, Memory memory)
    : allocation_(std::make_shared<Allocation>(device.core())) {
  if (bytes == 0) throw std::invalid_argument("a buffer needs at least one byte");
  if (bytes > device.limits().max_allocation) throw OutOfMemory(bytes);
  allocation_->size = bytes;
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = bytes;
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT |
               VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
  check(vkCreateBuffer(device.core()->device, &info, nullptr, allocation_->buffer.out()),
        "vkCreateBuffer");
  allocate(*allocation_, memory);
}

std::size_t Buffer::size() const { return allocation_->size; }
void* Buffer::mapped() const { return allocation_->mapped; }

void Buffer::write(std::size_t offset, std::span<const std::byte> bytes) {
  require_range(size(), offset, bytes.size());
  if (bytes.empty()) return;
  if (mapped()) {
    std::memcpy(static_cast<std::byte*>(mapped()) + offset, bytes.data(), bytes.size());
    return;
  }
  Device device(allocation_->core);
  Buffer staging(device, bytes.size(), Memory::host);
  staging.write(0, bytes);
  Commands commands(device);
  commands.copy(staging, {*this, offset, bytes.size()});
  commands.submit_and_wait();
}

void Buffer::read(std::size_t offset, std::span<std::byte> bytes) const {
  require_range(size(), offset, bytes.size());
  if (bytes.empty()) return;
  if (mapped()) {
    std::memcpy(bytes.data(), static_cast<std::byte*>(mapped()) + offset, bytes.size());
    return;
  }
  Device device(allocation_->core);
  Buffer staging(device, bytes.size(), Memory::host);
  Commands commands(device);
  commands.copy({*this, offset, bytes.size()}, staging);
  commands.submit_and_wait();
  staging.read(0, bytes);
}

}  // namespace cyanometer::vulkan
