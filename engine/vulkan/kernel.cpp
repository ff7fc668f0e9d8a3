#include "engine/vulkan/kernel.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "engine/vulkan/program.h"
#include "engine/vulkan/spirv.h"

namespace cyanometer::vulkan {
namespace {

void make_module(Kernel::Program& program) {
  VkShaderModuleCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  info.codeSize = std::span(program.spirv).size_bytes();
  info.pCode = program.spirv.data();
  check(vkCreateShaderModule(program.core->device, &info, nullptr, program.module.out()),
        "vkCreateShaderModule");
}

void make_set_layout(Kernel::Program& program) {
  std::vector<VkDescriptorSetLayoutBinding> bindings(program.bindings);
  for (std::uint32_t i = 0; i < program.bindings; ++i) {
    bindings[i].binding = i;
    bindings[i].descriptorType = program.descriptor_type(i);
    bindings[i].descriptorCount = 1;
    bindings[i].stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
  }
  VkDescriptorSetLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  info.bindingCount = program.bindings;
  info.pBindings = bindings.data();
  check(vkCreateDescriptorSetLayout(program.core->device, &info, nullptr,
                                    program.set_layout.out()),
        "vkCreateDescriptorSetLayout");
}

void make_layout(Kernel::Program& program) {
  const VkPushConstantRange push{VK_SHADER_STAGE_COMPUTE_BIT, 0,
                                 static_cast<std::uint32_t>(program.push_bytes)};
  const VkDescriptorSetLayout set = *program.set_layout;
  VkPipelineLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  info.setLayoutCount = 1;
  info.pSetLayouts = &set;
  info.pushConstantRangeCount = program.push_bytes ? 1 : 0;
  info.pPushConstantRanges = &push;
  check(vkCreatePipelineLayout(program.core->device, &info, nullptr, program.layout.out()),
        "vkCreatePipelineLayout");
}

void require(std::size_t asked, std::size_t allowed, const char* what) {
  if (asked > allowed)
    throw std::invalid_argument("a kernel with " + std::to_string(asked) + " " + what +
                                "; the device allows " + std::to_string(allowed));
}

std::shared_ptr<Kernel::Program> program_of(const std::shared_ptr<Device::Core>& core,
                                            std::span<const std::uint32_t> spirv,
                                            std::uint32_t bindings, std::size_t push_bytes) {
  for (Kernel::Program* known : core->programs) {
    if (known->bindings == bindings && known->push_bytes == push_bytes &&
        std::ranges::equal(known->spirv, spirv))
      return known->shared_from_this();
  }
  auto made = std::make_shared<Kernel::Program>(core, spirv, bindings, push_bytes);
  make_module(*made);
  make_set_layout(*made);
  make_layout(*made);
  return made;
}

}  // namespace

Kernel::Kernel(Device& device, std::span<const std::uint32_t> spirv, std::uint32_t bindings,
               std::size_t push_bytes) {
  require(bindings, device.limits().max_bindings, "buffers");
  require(push_bytes, device.limits().max_push_bytes, "bytes of push constants");
  program_ = program_of(device.core(), spirv, bindings, push_bytes);
}

void Kernel::prepare(const Specialization& specialization) const {
  program_->pipeline(specialization);
}

Kernel::Program::Program(const std::shared_ptr<Device::Core>& core_,
                         std::span<const std::uint32_t> spirv_, std::uint32_t bindings_,
                         std::size_t push_bytes_)
    : core(core_),
      spirv(spirv_.begin(), spirv_.end()),
      bindings(bindings_),
      constant_ids(vulkan::constant_ids(spirv)),
      texel_formats(vulkan::texel_formats(spirv, bindings)),
      push_bytes(push_bytes_),
      module(core_),
      set_layout(core_),
      layout(core_) {
  core->programs.push_back(this);
}

VkDescriptorType Kernel::Program::descriptor_type(std::uint32_t binding) const {
  return texel_formats[binding] == VK_FORMAT_UNDEFINED
             ? VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
             : VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
}

Kernel::Program::~Program() {
  std::erase(core->programs, this);
  core->pipelines_kept -= pipelines_.size();
}

Kernel::Program::Values Kernel::Program::values_of(const Specialization& specialization) const {
  Values values;
  for (std::uint32_t id : constant_ids) {
    if (id < specialization.size()) values.push_back(specialization[id]);
  }
  return values;
}

Kernel::Program::PipelineToBe Kernel::Program::pipeline(const Specialization& specialization) {
  const Values values = values_of(specialization);
  auto found = pipelines_.find(values);
  if (found == pipelines_.end()) {
    if (core->pipelines_kept >= core->most_pipelines) forget_least_used_pipeline(*core);
    // Deferred where there can be no other thread.
    PipelineToBe made = std::async(std::launch::async | std::launch::deferred,
                                   [this, values] { return make(values); });
    found = pipelines_.emplace(values, Kept{std::move(made)}).first;
    ++core->pipelines_kept;
    ++core->pipelines_made;
  }
  found->second.last_use = ++core->pipeline_uses;
  return found->second.pipeline;
}

void Kernel::Program::forget(const Specialization& specialization) {
  core->pipelines_kept -= pipelines_.erase(values_of(specialization));
}

void forget_least_used_pipeline(Device::Core& core) {
  Kernel::Program* owner = nullptr;
  decltype(owner->pipelines_)::iterator least;
  for (Kernel::Program* program : core.programs) {
    for (auto each = program->pipelines_.begin(); each != program->pipelines_.end(); ++each) {
      if (owner && each->second.last_use >= least->second.last_use) continue;
      owner = program;
      least = each;
    }
  }
  owner->pipelines_.erase(least);
  --core.pipelines_kept;
}

std::shared_ptr<Kernel::Program::Pipeline> Kernel::Program::make(const Values& values) const {
  std::vector<VkSpecializationMapEntry> entries;
  for (std::uint32_t i = 0; i < values.size(); ++i)
    entries.push_back(
        {constant_ids[i], i * std::uint32_t{sizeof(std::uint32_t)}, sizeof(std::uint32_t)});
  const VkSpecializationInfo constants{static_cast<std::uint32_t>(entries.size()),
                                       entries.data(), values.size() * sizeof(std::uint32_t),
                                       values.data()};
  VkComputePipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = *module;
  info.stage.pName = "main";
  info.stage.pSpecializationInfo = &constants;
  info.layout = *layout;
  auto pipeline = std::make_shared<Pipeline>(core);
  check(vkCreateComputePipelines(core->device, VK_NULL_HANDLE, 1, &info, nullptr,
                                 pipeline->out()),
        "vkCreateComputePipelines");
  return pipeline;
}

}  // namespace cyanometer::vulkan
