// A buffer that a method works in, kept between frames because most want the same.
#pragma once

#include <optional>
#include <utility>

#include "engine/vulkan/buffer.h"

namespace cyanometer {

/// Whoever works in the buffer takes it for so long: a more urgent frame that is rendered in
/// between (Watch::gone) finds none here and makes its own.
class Scratch {
 public:
  explicit Scratch(vulkan::Memory memory = vulkan::Memory::device) : memory_(memory) {}

  class Loan {
   public:
    Loan(Scratch& home, vulkan::Buffer buffer) : home_(home), buffer_(std::move(buffer)) {}
    ~Loan() { home_.kept_ = std::move(buffer_); }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    const vulkan::Buffer& operator*() const { return buffer_; }

   private:
    Scratch& home_;
    vulkan::Buffer buffer_;
  };

  /// At least so many bytes, until the loan dies.
  Loan take(vulkan::Device& device, std::size_t bytes) {
    auto kept = std::exchange(kept_, std::nullopt);
    if (kept && kept->size() >= bytes) return {*this, *std::move(kept)};
    kept.reset();
    return {*this, vulkan::Buffer(device, bytes, memory_)};
  }

 private:
  vulkan::Memory memory_;
  std::optional<vulkan::Buffer> kept_;
};

}  // namespace cyanometer
