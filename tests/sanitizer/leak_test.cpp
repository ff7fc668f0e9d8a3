// What makes the silence of the other suites mean something.
#include <gtest/gtest.h>
#include <sanitizer/lsan_interface.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/vulkan/core.h"
#include "engine/vulkan/device.h"

namespace cyanometer::vulkan {
namespace {

/// Handles which the leak checker cannot recognise as pointers.
using Hidden = std::vector<std::uint64_t>;

/// Many, since an old copy of a handle on the stack hides one.
[[gnu::noinline]] Hidden lost_buffers(VkDevice device) {
  Hidden hidden;
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = 64;
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  for (int i = 0; i < 64; ++i) {
    VkBuffer buffer = VK_NULL_HANDLE;
    check(vkCreateBuffer(device, &info, nullptr, &buffer), "vkCreateBuffer");
    hidden.push_back(~reinterpret_cast<std::uint64_t>(buffer));
  }
  return hidden;
}

TEST(Leaks, OfADevicesObjectsAreFound) {
  const Device device;
  ASSERT_EQ(__lsan_do_recoverable_leak_check(), 0);

  const Hidden buffers = lost_buffers(device.core()->device);
  EXPECT_EQ(__lsan_do_recoverable_leak_check(), 1);

  for (std::uint64_t hidden : buffers)
    vkDestroyBuffer(device.core()->device, reinterpret_cast<VkBuffer>(~hidden), nullptr);
  EXPECT_EQ(__lsan_do_recoverable_leak_check(), 0);
}

}  // namespace
}  // namespace cyanometer::vulkan
