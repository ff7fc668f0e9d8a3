// A Vulkan device that computes: choosing one, its limits, and what can go wrong with it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "engine/engine.h"

namespace cyanometer::vulkan {

/// No device there is fits what was asked for.
struct NoDevice : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// A call of Vulkan's failed; the message names the call and its result.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// The device or the host has no room for so many bytes.
struct OutOfMemory : OutOfDeviceMemory {
  explicit OutOfMemory(std::size_t bytes_);
  std::size_t bytes;
};

struct DeviceInfo {
  std::string name;
  std::string driver;       ///< name and version, as the driver calls them
  std::string api_version;  ///< "1.3.230"
  std::string type;         ///< "discrete", "integrated", "virtual", "cpu" or "other"
  std::string id;  ///< equal ids compute equal bits: vendor, device, driver version, name
  bool usable = false;
  std::string why;  ///< why it is usable, or not
};

/// All physical devices in the order of preference: discrete, integrated, virtual, cpu.
std::vector<DeviceInfo> list();

struct Limits {
  std::size_t max_storage_range = 0;  ///< bytes that one binding may reach
  std::size_t max_allocation = 0;     ///< bytes of one buffer
  std::size_t storage_alignment = 1;  ///< an offset of a binding is a multiple of it, in bytes
  std::array<std::uint32_t, 3> max_groups{};      ///< of one dispatch, by dimension
  std::array<std::uint32_t, 3> max_group_size{};  ///< invocations of a group, by dimension
  std::uint32_t max_invocations = 0;              ///< of a group
  std::uint32_t max_bindings = 0;                 ///< buffers of a kernel
  std::size_t max_shared_bytes = 0;               ///< of a group
  std::size_t max_push_bytes = 0;
  std::uint32_t subgroup_size = 1;
  bool float64 = false;         ///< shaders may use double
  bool unified_memory = false;  ///< device memory is the host's too
};

struct PipelineUse {
  std::size_t kept = 0;
  std::uint64_t made = 0;  ///< since the device was
};

/// One logical device with one queue. The device and all that is made from it belong to one
/// thread; only buffers may be read and freed on any. Whatever was made from it keeps its inner
/// part alive.
class Device {
 public:
  /// Takes the first usable device of list() whose name or driver contains `name_part`,
  /// whatever the case of its letters. With CYANOMETER_VALIDATION=1 in the environment the
  /// validation layer and its synchronization checks are on, and print to standard error.
  /// @throws NoDevice saying what was asked for and what there is
  explicit Device(const std::string& name_part = "");

  const DeviceInfo& info() const;
  const Limits& limits() const;

  /// For tests of recovery: the n-th submission from now (1 is the next one) and all that
  /// follow fail as on a device that went away.
  void lose_at_submission(int n);
  /// For tests: buffers that would make all memory in use more than this find none.
  void limit_memory(std::size_t bytes);
  /// Of the device's memory, in use by buffers; also from other threads.
  std::size_t allocated_bytes() const;
  /// Of all kernels together at most so many pipelines are kept, those used last. Ones that
  /// recorded commands use live until that work is done, beside them.
  /// @throws std::invalid_argument of none
  void keep_pipelines(std::size_t most);
  /// Also from other threads.
  PipelineUse pipelines() const;
  /// Warnings and errors of the validation layer so far; 0 where it is off.
  int validation_messages() const;

  struct Core;
  const std::shared_ptr<Core>& core() const { return core_; }
  /// The same device again.
  explicit Device(std::shared_ptr<Core> core) : core_(std::move(core)) {}

 private:
  std::shared_ptr<Core> core_;
};

}  // namespace cyanometer::vulkan
