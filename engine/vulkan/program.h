// A kernel's inner part: what the commands that dispatch it keep alive.
#pragma once

#include <map>

#include "engine/vulkan/core.h"
#include "engine/vulkan/kernel.h"

namespace cyanometer::vulkan {

struct Kernel::Program {
  using Pipeline = Owned<VkPipeline, &vkDestroyPipeline>;

  explicit Program(const std::shared_ptr<Device::Core>& core_);
  ~Program();
  Program(const Program&) = delete;

  /// The pipeline of a specialization, made where there is none yet.
  std::shared_ptr<Pipeline> pipeline(const Specialization& specialization);

  std::shared_ptr<Device::Core> core;
  std::uint32_t bindings = 0;
  std::size_t push_bytes = 0;
  Owned<VkShaderModule, &vkDestroyShaderModule> module;
  Owned<VkDescriptorSetLayout, &vkDestroyDescriptorSetLayout> set_layout;
  Owned<VkPipelineLayout, &vkDestroyPipelineLayout> layout;

 private:
  struct Kept {
    std::shared_ptr<Pipeline> pipeline;
    std::uint64_t last_use = 0;
  };
  std::shared_ptr<Pipeline> make(const Specialization& specialization);
  friend void forget_least_used_pipeline(Device::Core& core);

  std::map<Specialization, Kept> pipelines_;
};

/// Of all kernels'. @pre one is kept
void forget_least_used_pipeline(Device::Core& core);

}  // namespace cyanometer::vulkan
