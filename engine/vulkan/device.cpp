#include "engine/vulkan/device.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <optional>
#include <stdexcept>

#include "engine/vulkan/core.h"
#include "engine/vulkan/program.h"

namespace cyanometer::vulkan {
namespace {

std::string version_text(std::uint32_t version) {
  return std::to_string(VK_API_VERSION_MAJOR(version)) + "." +
         std::to_string(VK_API_VERSION_MINOR(version)) + "." +
         std::to_string(VK_API_VERSION_PATCH(version));
}

std::string type_text(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return "cpu";
    default:
      return "other";
  }
}

/// 0 is the best.
int rank(const DeviceInfo& info) {
  const std::array<std::string, 4> order{"discrete", "integrated", "virtual", "cpu"};
  return static_cast<int>(std::find(order.begin(), order.end(), info.type) - order.begin());
}

/// The family for computing: one that cannot draw, where there is one, since nothing else waits
/// in its queues.
std::optional<std::uint32_t> compute_family(
    const std::vector<VkQueueFamilyProperties>& families) {
  std::optional<std::uint32_t> found;
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    if (!(families[i].queueFlags & VK_QUEUE_COMPUTE_BIT)) continue;
    const bool draws = families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT;
    if (!draws) return i;
    if (!found) found = i;
  }
  return found;
}

std::vector<VkQueueFamilyProperties> queue_families(VkPhysicalDevice physical) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  return families;
}

bool has_extension(VkPhysicalDevice physical, const char* name) {
  std::uint32_t count = 0;
  check(vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr),
        "vkEnumerateDeviceExtensionProperties");
  std::vector<VkExtensionProperties> extensions(count);
  check(vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data()),
        "vkEnumerateDeviceExtensionProperties");
  return std::any_of(extensions.begin(), extensions.end(), [&](const auto& extension) {
    return std::strcmp(extension.extensionName, name) == 0;
  });
}

std::string driver_text(VkPhysicalDevice physical,
                        const VkPhysicalDeviceProperties& properties) {
  if (!has_extension(physical, VK_KHR_DRIVER_PROPERTIES_EXTENSION_NAME))
    return version_text(properties.driverVersion);
  VkPhysicalDeviceDriverProperties driver{};
  driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
  VkPhysicalDeviceProperties2 both{};
  both.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  both.pNext = &driver;
  vkGetPhysicalDeviceProperties2(physical, &both);
  return std::string(driver.driverName) + " " + driver.driverInfo;
}

DeviceInfo describe(VkPhysicalDevice physical) {
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(physical, &properties);
  DeviceInfo info;
  info.name = properties.deviceName;
  info.api_version = version_text(properties.apiVersion);
  info.type = type_text(properties.deviceType);
  info.id = std::to_string(properties.vendorID) + "/" + std::to_string(properties.deviceID) +
            "/" + std::to_string(properties.driverVersion) + "/" + info.name;
  if (properties.apiVersion < VK_API_VERSION_1_1) {
    info.driver = version_text(properties.driverVersion);
    info.why = "needs Vulkan 1.1, has " + info.api_version;
    return info;
  }
  info.driver = driver_text(physical, properties);
  info.usable = compute_family(queue_families(physical)).has_value();
  info.why = info.usable ? "computes with Vulkan " + info.api_version : "has no compute queue";
  return info;
}

struct Candidate {
  VkPhysicalDevice physical;
  DeviceInfo info;
};

std::vector<Candidate> candidates(const Instance& instance) {
  std::uint32_t count = 0;
  check(vkEnumeratePhysicalDevices(instance.handle(), &count, nullptr),
        "vkEnumeratePhysicalDevices");
  std::vector<VkPhysicalDevice> devices(count);
  check(vkEnumeratePhysicalDevices(instance.handle(), &count, devices.data()),
        "vkEnumeratePhysicalDevices");
  std::vector<Candidate> result;
  for (VkPhysicalDevice physical : devices) result.push_back({physical, describe(physical)});
  std::stable_sort(result.begin(), result.end(), [](const Candidate& a, const Candidate& b) {
    return rank(a.info) < rank(b.info);
  });
  return result;
}

bool contains(std::string text, std::string part) {
  for (std::string* s : {&text, &part})
    for (char& c : *s) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text.find(part) != std::string::npos;
}

Candidate choose(const Instance& instance, const std::string& name_part) {
  std::string there;
  for (const Candidate& candidate : candidates(instance)) {
    const DeviceInfo& info = candidate.info;
    if (info.usable && (contains(info.name, name_part) || contains(info.driver, name_part)))
      return candidate;
    there += "\n  " + info.name + " (" + info.type + ", " + info.driver + "): " + info.why;
  }
  throw NoDevice("no usable Vulkan device" +
                 (name_part.empty() ? "" : " with \"" + name_part + "\" in its name") +
                 (there.empty() ? "; there is none at all" : "; there is:" + there));
}

VkPhysicalDeviceFeatures wanted_features(VkPhysicalDevice physical) {
  VkPhysicalDeviceFeatures available{}, wanted{};
  vkGetPhysicalDeviceFeatures(physical, &available);
  wanted.shaderFloat64 = available.shaderFloat64;
  wanted.shaderInt64 = available.shaderInt64;
  return wanted;
}

Limits limits_of(VkPhysicalDevice physical, const VkPhysicalDeviceMemoryProperties& memory) {
  VkPhysicalDeviceMaintenance3Properties allocation{};
  allocation.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES;
  VkPhysicalDeviceSubgroupProperties subgroup{};
  subgroup.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES;
  subgroup.pNext = &allocation;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = &subgroup;
  vkGetPhysicalDeviceProperties2(physical, &properties);
  const VkPhysicalDeviceLimits& device = properties.properties.limits;
  Limits limits;
  // Most tables hold texels of four floats; what holds one a texel is as long as a frame at
  // most.
  constexpr std::size_t texel_bytes = 16;
  limits.max_storage_range = std::min<std::size_t>(device.maxStorageBufferRange,
                                                   texel_bytes * device.maxTexelBufferElements);
  limits.max_allocation = allocation.maxMemoryAllocationSize;
  limits.storage_alignment =
      std::max(device.minStorageBufferOffsetAlignment, device.minTexelBufferOffsetAlignment);
  limits.max_groups = std::to_array(device.maxComputeWorkGroupCount);
  limits.max_group_size = std::to_array(device.maxComputeWorkGroupSize);
  limits.max_invocations = device.maxComputeWorkGroupInvocations;
  limits.max_bindings = std::min(device.maxPerStageDescriptorStorageBuffers,
                                 device.maxPerStageDescriptorStorageImages);
  limits.max_shared_bytes = device.maxComputeSharedMemorySize;
  limits.max_push_bytes = device.maxPushConstantsSize;
  limits.subgroup_size = subgroup.subgroupSize;
  limits.float64 = wanted_features(physical).shaderFloat64;
  limits.unified_memory = std::all_of(
      memory.memoryHeaps, memory.memoryHeaps + memory.memoryHeapCount,
      [](const VkMemoryHeap& heap) { return heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT; });
  return limits;
}

VkDevice make_device(VkPhysicalDevice physical, std::uint32_t family) {
  const float priority = 1;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = family;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  const VkPhysicalDeviceFeatures features = wanted_features(physical);
  VkDeviceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.pEnabledFeatures = &features;
  VkDevice device = VK_NULL_HANDLE;
  check(vkCreateDevice(physical, &info, nullptr, &device), "vkCreateDevice");
  return device;
}

}  // namespace

OutOfMemory::OutOfMemory(std::size_t bytes_)
    : OutOfDeviceMemory("no memory for a buffer of " + std::to_string(bytes_) + " bytes"),
      bytes(bytes_) {}

std::vector<DeviceInfo> list() {
  const Instance instance;
  std::vector<DeviceInfo> result;
  for (Candidate& candidate : candidates(instance)) result.push_back(std::move(candidate.info));
  return result;
}

Device::Core::~Core() {
  if (device) vkDestroyDevice(device, nullptr);
}

Device::Device(const std::string& name_part) : core_(std::make_shared<Core>()) {
  const Candidate chosen = choose(core_->instance, name_part);
  const auto families = queue_families(chosen.physical);
  VkPhysicalDeviceProperties properties{};
  vkGetPhysicalDeviceProperties(chosen.physical, &properties);
  core_->physical = chosen.physical;
  core_->info = chosen.info;
  core_->family = compute_family(families).value();
  core_->timestamp_bits = families[core_->family].timestampValidBits;
  core_->ns_per_tick = properties.limits.timestampPeriod;
  vkGetPhysicalDeviceMemoryProperties(chosen.physical, &core_->memory);
  core_->limits = limits_of(chosen.physical, core_->memory);
  core_->device = make_device(chosen.physical, core_->family);
  vkGetDeviceQueue(core_->device, core_->family, 0, &core_->queue);
}

const DeviceInfo& Device::info() const { return core_->info; }
const Limits& Device::limits() const { return core_->limits; }
void Device::lose_at_submission(int n) { core_->submissions_until_loss = n; }
void Device::limit_memory(std::size_t bytes) { core_->most_bytes = bytes; }
std::size_t Device::allocated_bytes() const { return core_->allocated_bytes; }
void Device::keep_pipelines(std::size_t most) {
  if (most == 0) throw std::invalid_argument("a device keeps at least one pipeline");
  core_->most_pipelines = most;
  while (core_->pipelines_kept > most) forget_least_used_pipeline(*core_);
}
PipelineUse Device::pipelines() const { return {core_->pipelines_kept, core_->pipelines_made}; }
int Device::validation_messages() const { return core_->instance.validation_messages(); }

}  // namespace cyanometer::vulkan
