// Large buffers, kept when they are done with: the pages of fresh memory cost a frame more than
// what is written into them.
#pragma once

#include <memory>

#include "engine/vulkan/buffer.h"

namespace cyanometer::vulkan {

class BufferPool {
 public:
  /// @param most_idle_bytes  that are kept while nobody uses them; those given back last are
  BufferPool(Device& device, std::size_t most_idle_bytes);
  ~BufferPool();
  BufferPool(const BufferPool&) = delete;

  /// At least so many bytes, whose content is whatever was left there: who takes it writes all
  /// that is read. It comes back when its last owner lets it go, on any thread, also when the
  /// pool is no more.
  /// @throws OutOfMemory
  std::shared_ptr<const Buffer> take(std::size_t bytes, Memory memory);
  /// Frees all that nobody uses.
  void clear();
  /// Kept while nobody uses it; also from other threads.
  std::size_t idle_bytes() const;

 private:
  struct Idle;
  Device& device_;
  std::shared_ptr<Idle> idle_;
};

}  // namespace cyanometer::vulkan
