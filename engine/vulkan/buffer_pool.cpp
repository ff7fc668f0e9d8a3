#include "engine/vulkan/buffer_pool.h"

#include <algorithm>
#include <bit>
#include <list>
#include <mutex>
#include <optional>

namespace cyanometer::vulkan {
namespace {

/// Sizes that change a little from frame to frame are made equal; large ones are left alone.
std::size_t rounded(std::size_t bytes) {
  constexpr std::size_t largest = std::size_t{16} << 20, least = std::size_t{1} << 16;
  if (bytes > largest) return bytes;
  const std::size_t step = std::max(std::bit_floor(bytes) / 4, least);
  return (bytes + step - 1) / step * step;
}

}  // namespace

struct BufferPool::Idle {
  struct Kept {
    Buffer buffer;
    Memory memory;
  };

  explicit Idle(std::size_t most_bytes_) : most_bytes(most_bytes_) {}

  std::optional<Buffer> find(std::size_t bytes, Memory memory) {
    const std::lock_guard lock(mutex);
    auto found = std::ranges::find_if(kept, [&](const Kept& each) {
      return each.memory == memory && each.buffer.size() == bytes;
    });
    if (found == kept.end()) return std::nullopt;
    Buffer buffer = std::move(found->buffer);
    kept.erase(found);
    total -= bytes;
    return buffer;
  }

  void give_back(Buffer buffer, Memory memory) {
    std::list<Kept> freed;  // outside of the lock
    const std::lock_guard lock(mutex);
    if (buffer.size() > most_bytes) return;
    total += buffer.size();
    kept.push_front({std::move(buffer), memory});
    while (total > most_bytes) {
      total -= kept.back().buffer.size();
      freed.splice(freed.begin(), kept, std::prev(kept.end()));
    }
  }

  const std::size_t most_bytes;
  std::mutex mutex;
  std::list<Kept> kept;  ///< given back last first
  std::size_t total = 0;
};

BufferPool::BufferPool(Device& device, std::size_t most_idle_bytes)
    : device_(device), idle_(std::make_shared<Idle>(most_idle_bytes)) {}
BufferPool::~BufferPool() = default;

std::shared_ptr<const Buffer> BufferPool::take(std::size_t bytes, Memory memory) {
  const std::size_t size = rounded(bytes);
  std::optional<Buffer> buffer = idle_->find(size, memory);
  if (!buffer) {
    try {
      buffer.emplace(device_, size, memory);
    } catch (const OutOfMemory&) {
      clear();
      buffer.emplace(device_, bytes, memory);
    }
  }
  auto back = [idle = std::weak_ptr(idle_), memory](Buffer* given) {
    const std::unique_ptr<Buffer> owner(given);
    if (auto alive = idle.lock()) alive->give_back(std::move(*given), memory);
  };
  return {new Buffer(*std::move(buffer)), back};
}

std::size_t BufferPool::idle_bytes() const {
  const std::lock_guard lock(idle_->mutex);
  return idle_->total;
}

void BufferPool::clear() {
  std::list<Idle::Kept> freed;
  const std::lock_guard lock(idle_->mutex);
  freed.swap(idle_->kept);
  idle_->total = 0;
}

}  // namespace cyanometer::vulkan
