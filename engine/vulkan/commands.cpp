#include "engine/vulkan/commands.h"

#include <algorithm>
#include <array>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/engine.h"
#include "engine/vulkan/buffer_allocation.h"
#include "engine/vulkan/program.h"

namespace cyanometer::vulkan {
namespace {

constexpr VkPipelineStageFlags kWork =
    VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
constexpr VkAccessFlags kWrites = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
constexpr VkAccessFlags kReads = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT;

using DescriptorPool = Owned<VkDescriptorPool, &vkDestroyDescriptorPool>;
using BufferView = Owned<VkBufferView, &vkDestroyBufferView>;

std::unique_ptr<DescriptorPool> make_descriptor_pool(const std::shared_ptr<Device::Core>& core,
                                                     std::uint32_t descriptors) {
  const std::array sizes{
      VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, descriptors},
      VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, descriptors}};
  VkDescriptorPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.maxSets = descriptors;
  info.poolSizeCount = sizes.size();
  info.pPoolSizes = sizes.data();
  auto pool = std::make_unique<DescriptorPool>(core);
  check(vkCreateDescriptorPool(core->device, &info, nullptr, pool->out()),
        "vkCreateDescriptorPool");
  return pool;
}

/// Descriptor sets that live until all are given back at once.
class DescriptorSets {
 public:
  explicit DescriptorSets(std::shared_ptr<Device::Core> core) : core_(std::move(core)) {}

  VkDescriptorSet make(const Kernel::Program& program) {
    const std::uint32_t needed = std::max(program.bindings, 1u);
    if (needed > left_) {
      const std::uint32_t descriptors = std::max(needed, 256u);
      pools_.push_back(make_descriptor_pool(core_, descriptors));
      left_ = descriptors;
    }
    left_ -= needed;
    const VkDescriptorSetLayout layout = *program.set_layout;
    VkDescriptorSetAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    info.descriptorPool = **pools_.back();
    info.descriptorSetCount = 1;
    info.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    check(vkAllocateDescriptorSets(core_->device, &info, &set), "vkAllocateDescriptorSets");
    return set;
  }
  void give_back() {
    pools_.clear();
    left_ = 0;
  }

 private:
  std::shared_ptr<Device::Core> core_;
  std::vector<std::unique_ptr<DescriptorPool>> pools_;
  std::uint32_t left_ = 0;  ///< descriptors of the last pool
};

std::size_t size_of(const Binding& binding) {
  return binding.size == Binding::rest && binding.offset <= binding.buffer.size()
             ? binding.buffer.size() - binding.offset
             : binding.size;
}

std::string text_of(const Binding& binding) {
  return std::to_string(size_of(binding)) + " bytes at " + std::to_string(binding.offset) +
         " of a buffer of " + std::to_string(binding.buffer.size());
}

/// @param what  tells it, and is asked only then: every dispatch requires dozens of things
template <typename Text>
void require(bool fits, Text what) {
  if (!fits) throw std::invalid_argument(what());
}

void require_inside(const Binding& binding) {
  const std::size_t size = size_of(binding), whole = binding.buffer.size();
  require(size > 0 && binding.offset <= whole && size <= whole - binding.offset,
          [&] { return text_of(binding) + " is not a part of it"; });
}

void require_bindable(const Binding& binding, const Limits& limits) {
  require_inside(binding);
  require(binding.offset % limits.storage_alignment == 0, [&] {
    return text_of(binding) + ": the device binds at multiples of " +
           std::to_string(limits.storage_alignment);
  });
  require(size_of(binding) <= limits.max_storage_range, [&] {
    return text_of(binding) + ": the device binds at most " +
           std::to_string(limits.max_storage_range) + " bytes";
  });
}

void require_groups(const Groups& groups, const Limits& limits) {
  const std::array<std::uint32_t, 3> counts{groups.x, groups.y, groups.z};
  for (std::size_t i = 0; i < 3; ++i)
    require(counts[i] > 0 && counts[i] <= limits.max_groups[i], [&] {
      return "a dispatch of " + std::to_string(counts[i]) + " groups along " + "xyz"[i] +
             "; the device allows 1 to " + std::to_string(limits.max_groups[i]);
    });
}

}  // namespace

struct Commands::State {
  explicit State(const std::shared_ptr<Device::Core>& core_)
      : core(core_), pool(core_), fence(core_), clock(core_), sets(core_) {}

  void make();
  void begin();
  /// Of work that is recorded when it is submitted, for by then its pipelines are made.
  void add(Order order, std::function<void()> step) {
    steps.push_back({order, std::move(step)});
  }
  void record();
  void wait_for_previous();
  void show_to_host();
  VkBufferView view(const Binding& binding, VkFormat format);
  VkDescriptorSet bind(const Kernel::Program& program, std::span<const Binding> bindings);
  void bind_pipeline(Kernel::Program& program, const Specialization& specialization,
                     const Kernel::Program::PipelineToBe& made);
  void submit();
  /// Both; work that could not be started is forgotten, or the next would fail with it.
  void start();
  /// False where the work has not ended in time.
  bool wait(std::chrono::nanoseconds patience);
  double elapsed_ms() const;
  void keep(std::shared_ptr<const void> used) { kept.push_back(std::move(used)); }

  std::shared_ptr<Device::Core> core;
  Owned<VkCommandPool, &vkDestroyCommandPool> pool;
  Owned<VkFence, &vkDestroyFence> fence;
  Owned<VkQueryPool, &vkDestroyQueryPool> clock;
  DescriptorSets sets;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  std::vector<std::shared_ptr<const void>> kept;  ///< what the work uses
  struct Step {
    Order order;
    std::function<void()> record;
  };
  std::vector<Step> steps;
};

void Commands::State::make() {
  VkCommandPoolCreateInfo pool_info{};
  pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  pool_info.queueFamilyIndex = core->family;
  check(vkCreateCommandPool(core->device, &pool_info, nullptr, pool.out()),
        "vkCreateCommandPool");
  VkCommandBufferAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  info.commandPool = *pool;
  info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  info.commandBufferCount = 1;
  check(vkAllocateCommandBuffers(core->device, &info, &commands), "vkAllocateCommandBuffers");
  VkFenceCreateInfo fence_info{};
  fence_info.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
  check(vkCreateFence(core->device, &fence_info, nullptr, fence.out()), "vkCreateFence");
  if (!core->timestamp_bits) return;
  VkQueryPoolCreateInfo clock_info{};
  clock_info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
  clock_info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  clock_info.queryCount = 2;
  check(vkCreateQueryPool(core->device, &clock_info, nullptr, clock.out()),
        "vkCreateQueryPool");
}

void Commands::State::begin() {
  steps.clear();
  kept.clear();
  sets.give_back();
}

void Commands::State::record() {
  check(vkResetCommandPool(core->device, *pool, 0), "vkResetCommandPool");
  VkCommandBufferBeginInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands, &info), "vkBeginCommandBuffer");
  if (*clock) {
    vkCmdResetQueryPool(commands, *clock, 0, 2);
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, *clock, 0);
  }
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (i > 0 && steps[i].order == Order::after_previous) wait_for_previous();
    steps[i].record();
  }
  show_to_host();
  if (*clock) vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, *clock, 1);
  check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
}

void Commands::State::wait_for_previous() {
  VkMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
  barrier.srcAccessMask = kWrites;
  barrier.dstAccessMask = kReads | kWrites;
  vkCmdPipelineBarrier(commands, kWork, kWork, 0, 1, &barrier, 0, nullptr, 0, nullptr);
}

void Commands::State::show_to_host() {
  VkMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
  barrier.srcAccessMask = kWrites;
  barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT | VK_ACCESS_HOST_WRITE_BIT;
  vkCmdPipelineBarrier(commands, kWork, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier, 0, nullptr,
                       0, nullptr);
}

/// Part of a buffer as texels.
VkBufferView Commands::State::view(const Binding& binding, VkFormat format) {
  VkBufferViewCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO;
  info.buffer = *binding.buffer.allocation()->buffer;
  info.format = format;
  info.offset = binding.offset;
  info.range = size_of(binding);
  auto view = std::make_shared<BufferView>(core);
  check(vkCreateBufferView(core->device, &info, nullptr, view->out()), "vkCreateBufferView");
  keep(view);
  return **view;
}

VkDescriptorSet Commands::State::bind(const Kernel::Program& program,
                                      std::span<const Binding> bindings) {
  const VkDescriptorSet set = sets.make(program);
  std::vector<VkDescriptorBufferInfo> buffers(bindings.size());
  std::vector<VkBufferView> views(bindings.size());
  std::vector<VkWriteDescriptorSet> writes;
  for (std::uint32_t i = 0; i < bindings.size(); ++i) {
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set;
    write.dstBinding = i;
    write.descriptorType = program.descriptor_type(i);
    write.descriptorCount = 1;
    if (program.texel_formats[i] == VK_FORMAT_UNDEFINED) {
      buffers[i] = {*bindings[i].buffer.allocation()->buffer, bindings[i].offset,
                    size_of(bindings[i])};
      write.pBufferInfo = &buffers[i];
    } else {
      views[i] = view(bindings[i], program.texel_formats[i]);
      write.pTexelBufferView = &views[i];
    }
    writes.push_back(write);
    keep(bindings[i].buffer.allocation());
  }
  vkUpdateDescriptorSets(core->device, static_cast<std::uint32_t>(writes.size()), writes.data(),
                         0, nullptr);
  return set;
}

void Commands::State::bind_pipeline(Kernel::Program& program,
                                    const Specialization& specialization,
                                    const Kernel::Program::PipelineToBe& made) {
  try {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, **made.get());
  } catch (...) {
    program.forget(specialization);
    throw;
  }
}

void Commands::State::submit() {
  if (core->submissions_until_loss > 0 && --core->submissions_until_loss == 0)
    core->lost = true;
  if (core->lost) throw DeviceLost("vkQueueSubmit failed: device lost");
  check(vkResetFences(core->device, 1, fence.out()), "vkResetFences");
  VkSubmitInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  info.commandBufferCount = 1;
  info.pCommandBuffers = &commands;
  check(vkQueueSubmit(core->queue, 1, &info, *fence), "vkQueueSubmit");
}

void Commands::State::start() {
  try {
    record();
    submit();
  } catch (...) {
    begin();
    throw;
  }
}

bool Commands::State::wait(std::chrono::nanoseconds patience) {
  const VkResult result =
      vkWaitForFences(core->device, 1, fence.out(), VK_TRUE,
                      static_cast<std::uint64_t>(std::max<std::int64_t>(patience.count(), 0)));
  check(result, "vkWaitForFences");
  return result == VK_SUCCESS;
}

double Commands::State::elapsed_ms() const {
  if (!*clock) return 0;
  std::array<std::uint64_t, 2> ticks{};
  check(vkGetQueryPoolResults(core->device, *clock, 0, 2, sizeof(ticks), ticks.data(),
                              sizeof(ticks[0]),
                              VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
        "vkGetQueryPoolResults");
  const std::uint64_t mask = ~std::uint64_t{0} >> (64 - core->timestamp_bits);
  return static_cast<double>((ticks[1] - ticks[0]) & mask) * core->ns_per_tick * 1e-6;
}

/// The device still works on it: nothing that it uses may ever be freed.
void Commands::abandon(std::unique_ptr<State> state) {
  static std::mutex mutex;
  static auto& abandoned = *new std::vector<std::unique_ptr<State>>;
  const std::lock_guard lock(mutex);
  abandoned.push_back(std::move(state));
}

Commands::Commands(Device& device) : state_(std::make_unique<State>(device.core())) {
  state_->make();
}
Commands::~Commands() = default;
Commands::Commands(Commands&&) noexcept = default;
Commands& Commands::operator=(Commands&&) noexcept = default;

void Commands::begin() { state_->begin(); }

void Commands::dispatch(const Kernel& kernel, const Specialization& specialization,
                        std::span<const Binding> bindings, std::span<const std::byte> push,
                        Groups groups, Order order) {
  Kernel::Program& program = *kernel.program();
  const Limits& limits = state_->core->limits;
  require(bindings.size() == program.bindings, [&] {
    return "a kernel of " + std::to_string(program.bindings) + " buffers was given " +
           std::to_string(bindings.size());
  });
  require(push.size() == program.push_bytes, [&] {
    return "a kernel of " + std::to_string(program.push_bytes) +
           " bytes of push constants was given " + std::to_string(push.size());
  });
  for (const Binding& binding : bindings) require_bindable(binding, limits);
  require_groups(groups, limits);
  const VkDescriptorSet set = state_->bind(program, bindings);
  state_->keep(kernel.program());
  state_->add(order, [state = state_.get(), &program, set, specialization, groups,
                      pipeline = program.pipeline(specialization),
                      push = std::vector(push.begin(), push.end())] {
    state->bind_pipeline(program, specialization, pipeline);
    const VkCommandBuffer commands = state->commands;
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, *program.layout, 0, 1,
                            &set, 0, nullptr);
    if (!push.empty())
      vkCmdPushConstants(commands, *program.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                         static_cast<std::uint32_t>(push.size()), push.data());
    vkCmdDispatch(commands, groups.x, groups.y, groups.z);
  });
}

void Commands::copy(const Binding& from, const Binding& to, Order order) {
  require_inside(from);
  require_inside(to);
  require(size_of(from) == size_of(to),
          [&] { return "a copy of " + text_of(from) + " to " + text_of(to); });
  state_->keep(from.buffer.allocation());
  state_->keep(to.buffer.allocation());
  const VkBufferCopy region{from.offset, to.offset, size_of(from)};
  state_->add(order, [state = state_.get(), region, from = *from.buffer.allocation()->buffer,
                      to = *to.buffer.allocation()->buffer] {
    vkCmdCopyBuffer(state->commands, from, to, 1, &region);
  });
}

void Commands::fill(const Binding& to, std::uint32_t value, Order order) {
  require_inside(to);
  require(to.offset % 4 == 0 && size_of(to) % 4 == 0,
          [&] { return text_of(to) + ": a fill takes multiples of 4"; });
  state_->keep(to.buffer.allocation());
  state_->add(order, [state = state_.get(), to = *to.buffer.allocation()->buffer,
                      offset = to.offset, size = size_of(to),
                      value] { vkCmdFillBuffer(state->commands, to, offset, size, value); });
}

std::chrono::nanoseconds Commands::usual_patience() const {
  return std::chrono::minutes(state_->core->info.type == "cpu" ? 10 : 1);
}

double Commands::submit_and_wait(std::optional<std::chrono::nanoseconds> given) {
  const std::chrono::nanoseconds patience = given.value_or(usual_patience());
  const std::shared_ptr<Device::Core> core = state_->core;
  try {
    state_->start();
    if (!state_->wait(patience)) {
      abandon(std::move(state_));
      Device device(core);
      *this = Commands(device);
      throw DeviceLost(core->info.name + " has not answered in " +
                       std::to_string(std::chrono::duration<double>(patience).count()) + " s");
    }
    const double ms = state_->elapsed_ms();
    begin();
    return ms;
  } catch (const DeviceLost&) {
    core->lost = true;
    throw;
  }
}

}  // namespace cyanometer::vulkan
