// What makes the silence of the other suites mean something.
#include <gtest/gtest.h>

#include "engine/vulkan/instance.h"

namespace cyanometer::vulkan {
namespace {

TEST(Validation, AWrongCallIsReported) {
  const Instance instance;
  ASSERT_EQ(instance.validation_messages(), 0);
  uint32_t count = 1;
  VkPhysicalDevice device = VK_NULL_HANDLE;
  ASSERT_GE(vkEnumeratePhysicalDevices(instance.handle(), &count, &device), VK_SUCCESS);

  VkPhysicalDeviceProperties2 wrong{};  // without its sType
  vkGetPhysicalDeviceProperties2(device, &wrong);

  EXPECT_EQ(instance.validation_messages(), 1);
}

}  // namespace
}  // namespace cyanometer::vulkan
