// A buffer's inner part, which the commands that use it keep alive.
#pragma once

#include "engine/vulkan/buffer.h"
#include "engine/vulkan/core.h"

namespace cyanometer::vulkan {

struct Buffer::Allocation {
  explicit Allocation(const std::shared_ptr<Device::Core>& core_)
      : core(core_), memory(core_), buffer(core_) {}
  ~Allocation() { core->allocated_bytes -= memory_bytes; }

  std::shared_ptr<Device::Core> core;
  Owned<VkDeviceMemory, &vkFreeMemory> memory;
  Owned<VkBuffer, &vkDestroyBuffer> buffer;  // goes before its memory
  std::size_t size = 0;
  std::size_t memory_bytes = 0;  ///< what the device gave for it
  void* mapped = nullptr;
};

}  // namespace cyanometer::vulkan
