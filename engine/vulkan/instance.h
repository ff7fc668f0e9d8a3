// The Vulkan instance, with the validation layer where it is asked for.
#pragma once

#include <vulkan/vulkan.h>

#include <atomic>

namespace cyanometer::vulkan {

/// @throws Error, DeviceLost or OutOfDeviceMemory, naming the call
void check(VkResult result, const char* call);

class Instance {
 public:
  Instance();
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  VkInstance handle() const { return handle_; }
  int validation_messages() const { return messages_; }

 private:
  VkInstance handle_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  std::atomic<int> messages_ = 0;
};

}  // namespace cyanometer::vulkan
