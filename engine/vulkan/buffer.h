// Storage that shaders read and write.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "engine/vulkan/device.h"

namespace cyanometer::vulkan {

enum class Memory {
  host,    ///< host-visible, coherent, cached where possible: device writes are read in place
  device,  ///< device-local; on unified memory the host sees it too
};

/// A storage buffer with memory of its own. Movable; may be freed on any thread, even while the
/// device works on it.
class Buffer {
 public:
  /// @throws OutOfMemory
  Buffer(Device& device, std::size_t bytes, Memory memory);

  std::size_t size() const;
  /// The bytes themselves; null where the host does not see them, never so for Memory::host.
  void* mapped() const;
  template <typename T>
  std::span<T> as() const {
    return {static_cast<T*>(mapped()), mapped() ? size() / sizeof(T) : 0};
  }

  /// Copies into and out of the buffer, through staging where the host does not see it. Not
  /// while the device works on the buffer. @throws std::out_of_range
  void write(std::size_t offset, std::span<const std::byte> bytes);
  void read(std::size_t offset, std::span<std::byte> bytes) const;

  struct Allocation;
  const std::shared_ptr<Allocation>& allocation() const { return allocation_; }

 private:
  std::shared_ptr<Allocation> allocation_;
};

/// A value's bytes, as buffers and push constants take them.
template <typename T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span<const T, 1>(&value, 1));
}

}  // namespace cyanometer::vulkan
