// A list of work for the device: recorded, submitted, waited for.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>

#include "engine/vulkan/buffer.h"
#include "engine/vulkan/kernel.h"

namespace cyanometer::vulkan {

/// Part of a buffer, in bytes.
struct Binding {
  static constexpr std::size_t rest = ~std::size_t{0};  ///< all from the offset on
  Binding(const Buffer& buffer_, std::size_t offset_ = 0, std::size_t size_ = rest)
      : buffer(buffer_), offset(offset_), size(size_) {}
  const Buffer& buffer;
  std::size_t offset;
  std::size_t size;
};

struct Groups {
  std::uint32_t x = 1, y = 1, z = 1;
};
/// Groups of `size` invocations that cover `count`.
constexpr std::uint32_t groups_for(std::size_t count, std::size_t size) {
  return static_cast<std::uint32_t>((count + size - 1) / size);
}

enum class Order {
  after_previous,  ///< sees all that was written before it
  independent,     ///< touches nothing that the step before it writes
};

/// Recording begins by itself, in the constructor's state and after each submission. Buffers
/// and kernels that were recorded live on until the work is done. Pipelines of kernels that are
/// recorded are made side by side, and waited for when the work is submitted.
class Commands {
 public:
  explicit Commands(Device& device);
  ~Commands();
  Commands(Commands&&) noexcept;
  Commands& operator=(Commands&&) noexcept;

  /// Forgets what was recorded and not submitted.
  void begin();
  /// @throws std::invalid_argument where bindings, push constants or groups do not fit the
  /// kernel or the device's limits
  void dispatch(const Kernel& kernel, const Specialization& specialization,
                std::span<const Binding> bindings, std::span<const std::byte> push,
                Groups groups, Order order = Order::after_previous);
  void dispatch(const Kernel& kernel, const Specialization& specialization,
                std::initializer_list<Binding> bindings, std::span<const std::byte> push,
                Groups groups, Order order = Order::after_previous) {
    dispatch(kernel, specialization, std::span(bindings.begin(), bindings.size()), push, groups,
             order);
  }
  /// Both parts have the same size. @throws std::invalid_argument
  void copy(const Binding& from, const Binding& to, Order order = Order::after_previous);
  /// Repeats a value; offset and size are multiples of 4. @throws std::invalid_argument
  void fill(const Binding& to, std::uint32_t value, Order order = Order::after_previous);

  /// Returns when the work is done and the host may read it: its time on the device in ms, 0
  /// where the device has no clock.
  /// @throws DeviceLost, also where the work has not ended within `patience`, else within
  /// usual_patience()
  double submit_and_wait(std::optional<std::chrono::nanoseconds> patience = {});
  /// A minute; ten where the device is the processor itself, which does not hang but compiles
  /// kernels in their first dispatch, at whatever pace it is granted.
  std::chrono::nanoseconds usual_patience() const;

 private:
  struct State;
  static void abandon(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace cyanometer::vulkan
