#include "engine/vulkan/instance.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "engine/engine.h"
#include "engine/vulkan/device.h"

namespace cyanometer::vulkan {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

bool validation_is_asked_for() {
  const char* value = std::getenv("CYANOMETER_VALIDATION");
  return value && std::strcmp(value, "1") == 0;
}

void require_validation_layer() {
  uint32_t count = 0;
  check(vkEnumerateInstanceLayerProperties(&count, nullptr),
        "vkEnumerateInstanceLayerProperties");
  std::vector<VkLayerProperties> layers(count);
  check(vkEnumerateInstanceLayerProperties(&count, layers.data()),
        "vkEnumerateInstanceLayerProperties");
  if (std::none_of(layers.begin(), layers.end(), [](const VkLayerProperties& layer) {
        return std::strcmp(layer.layerName, kValidationLayer) == 0;
      }))
    throw Error(std::string("CYANOMETER_VALIDATION=1 needs ") + kValidationLayer +
                ", which is not installed");
}

VKAPI_ATTR VkBool32 VKAPI_CALL print_and_count(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                               VkDebugUtilsMessageTypeFlagsEXT,
                                               const VkDebugUtilsMessengerCallbackDataEXT* data,
                                               void* messages) {
  ++*static_cast<std::atomic<int>*>(messages);
  std::fprintf(stderr, "%s: %s\n", data->pMessageIdName ? data->pMessageIdName : "validation",
               data->pMessage);
  return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(std::atomic<int>& messages) {
  VkDebugUtilsMessengerCreateInfoEXT info{};
  info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
  info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                         VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  info.pfnUserCallback = print_and_count;
  info.pUserData = &messages;
  return info;
}

template <typename Function>
Function function(VkInstance instance, const char* name) {
  return reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
}

std::string name_of(VkResult result) {
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      return "out of host memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      return "out of device memory";
    case VK_ERROR_INITIALIZATION_FAILED:
      return "initialization failed";
    case VK_ERROR_DEVICE_LOST:
      return "device lost";
    case VK_ERROR_MEMORY_MAP_FAILED:
      return "memory map failed";
    case VK_ERROR_LAYER_NOT_PRESENT:
      return "layer not present";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
      return "extension not present";
    case VK_ERROR_FEATURE_NOT_PRESENT:
      return "feature not present";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
      return "no compatible driver";
    case VK_ERROR_TOO_MANY_OBJECTS:
      return "too many objects";
    default:
      return "VkResult " + std::to_string(result);
  }
}

}  // namespace

void check(VkResult result, const char* call) {
  if (result >= VK_SUCCESS) return;
  const std::string message = std::string(call) + " failed: " + name_of(result);
  if (result == VK_ERROR_DEVICE_LOST) throw DeviceLost(message);
  if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
    throw OutOfDeviceMemory(message);
  throw Error(message);
}

Instance::Instance() {
  VkApplicationInfo application{};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application.pApplicationName = "cyanometer";
  application.apiVersion = VK_API_VERSION_1_1;
  VkInstanceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  info.pApplicationInfo = &application;
  if (!validation_is_asked_for()) {
    check(vkCreateInstance(&info, nullptr, &handle_), "vkCreateInstance");
    return;
  }
  require_validation_layer();
  const char* extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME,
                              VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
  const VkValidationFeatureEnableEXT enabled[] = {
      VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
  VkValidationFeaturesEXT features{};
  features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
  features.enabledValidationFeatureCount = 1;
  features.pEnabledValidationFeatures = enabled;
  auto messenger = messenger_info(messages_);
  auto messenger_of_creation = messenger;
  messenger_of_creation.pNext = &features;
  info.pNext = &messenger_of_creation;
  info.enabledLayerCount = 1;
  info.ppEnabledLayerNames = &kValidationLayer;
  info.enabledExtensionCount = 2;
  info.ppEnabledExtensionNames = extensions;
  check(vkCreateInstance(&info, nullptr, &handle_), "vkCreateInstance");
  check(function<PFN_vkCreateDebugUtilsMessengerEXT>(handle_, "vkCreateDebugUtilsMessengerEXT")(
            handle_, &messenger, nullptr, &messenger_),
        "vkCreateDebugUtilsMessengerEXT");
}

Instance::~Instance() {
  if (messenger_)
    function<PFN_vkDestroyDebugUtilsMessengerEXT>(handle_, "vkDestroyDebugUtilsMessengerEXT")(
        handle_, messenger_, nullptr);
  vkDestroyInstance(handle_, nullptr);
}

}  // namespace cyanometer::vulkan
