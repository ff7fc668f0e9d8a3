// A kernel's inner part: what the commands that dispatch it keep alive.
#pragma once

#include <future>
#include <map>

#include "engine/vulkan/core.h"
#include "engine/vulkan/kernel.h"

namespace cyanometer::vulkan {

struct Kernel::Program : std::enable_shared_from_this<Kernel::Program> {
  using Pipeline = Owned<VkPipeline, &vkDestroyPipeline>;
  /// Drivers work on one for some tenths of a second: on a thread of its own, so that those
  /// that are dispatched together are made side by side.
  using PipelineToBe = std::shared_future<std::shared_ptr<Pipeline>>;

  Program(const std::shared_ptr<Device::Core>& core_, std::span<const std::uint32_t> spirv_,
          std::uint32_t bindings_, std::size_t push_bytes_);
  ~Program();
  Program(const Program&) = delete;

  /// That of a specialization, which is begun where there is none yet. Those that differ only
  /// in constants that the code lacks are one.
  PipelineToBe pipeline(const Specialization& specialization);
  VkDescriptorType descriptor_type(std::uint32_t binding) const;
  /// Where it could not be made: the next that asks tries again.
  void forget(const Specialization& specialization);

  const std::shared_ptr<Device::Core> core;
  const std::vector<std::uint32_t> spirv;
  const std::uint32_t bindings;
  const std::vector<std::uint32_t> constant_ids;  ///< of the constants that it has
  const std::vector<VkFormat> texel_formats;      ///< by binding; undefined: no texels
  const std::size_t push_bytes;
  Owned<VkShaderModule, &vkDestroyShaderModule> module;
  Owned<VkDescriptorSetLayout, &vkDestroyDescriptorSetLayout> set_layout;
  Owned<VkPipelineLayout, &vkDestroyPipelineLayout> layout;

 private:
  struct Kept {
    PipelineToBe pipeline;
    std::uint64_t last_use = 0;
  };
  /// By constant of the code, in the order of constant_ids; fewer where not all are given.
  using Values = std::vector<std::uint32_t>;
  Values values_of(const Specialization& specialization) const;
  std::shared_ptr<Pipeline> make(const Values& values) const;
  friend void forget_least_used_pipeline(Device::Core& core);

  std::map<Values, Kept> pipelines_;  ///< last: ends before what its threads use
};

/// Of all kernels'. @pre one is kept
void forget_least_used_pipeline(Device::Core& core);

}  // namespace cyanometer::vulkan
