// The inner part of a device, shared by all that is made from it.
#pragma once

#include <vulkan/vulkan.h>

#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "engine/vulkan/device.h"
#include "engine/vulkan/instance.h"
#include "engine/vulkan/kernel.h"

namespace cyanometer::vulkan {

struct Device::Core {
  Core() = default;
  ~Core();
  Core(const Core&) = delete;
  Core& operator=(const Core&) = delete;

  Instance instance;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  std::uint32_t family = 0;
  std::uint32_t timestamp_bits = 0;  ///< of the queue's clock; 0: it has none
  double ns_per_tick = 0;
  VkPhysicalDeviceMemoryProperties memory{};
  DeviceInfo info;
  Limits limits;
  bool lost = false;
  int submissions_until_loss = 0;               ///< 0: none is planned
  std::atomic<std::size_t> allocated_bytes{0};  ///< by buffers; these may be freed anywhere
  std::size_t most_bytes = std::numeric_limits<std::size_t>::max();
  std::vector<Kernel::Program*> programs;  ///< those alive, which hold the pipelines
  std::size_t most_pipelines = std::numeric_limits<std::size_t>::max();
  std::uint64_t pipeline_uses = 0;
  std::atomic<std::size_t> pipelines_kept{0};
  std::atomic<std::uint64_t> pipelines_made{0};
};

/// A handle made from a device, and the device kept alive until it is destroyed.
template <typename Handle, auto destroy>
class Owned {
 public:
  explicit Owned(std::shared_ptr<Device::Core> core) : core_(std::move(core)) {}
  ~Owned() {
    if (handle_) destroy(core_->device, handle_, nullptr);
  }
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;

  /// Where the call that makes the handle puts it.
  Handle* out() { return &handle_; }
  Handle operator*() const { return handle_; }

 private:
  std::shared_ptr<Device::Core> core_;
  Handle handle_ = VK_NULL_HANDLE;
};

}  // namespace cyanometer::vulkan
