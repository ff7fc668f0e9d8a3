#include "server/admission.h"

#include <functional>
#include <string_view>

namespace cyanometer {
namespace {

constexpr std::size_t most_remembered = 16384;

/// Of all that makes the frame.
std::size_t hash_of(const Request& request) {
  std::size_t hash = 0;
  const auto add = [&](std::string_view text) {
    constexpr std::size_t odd = 0x9e3779b97f4a7c15;
    hash = (hash ^ std::hash<std::string_view>{}(text)) * odd;
  };
  add(request.path);
  add(request.header("accept"));
  add(request.body);
  for (const auto& [name, value] : request.query) {
    add(name);
    add(value);
  }
  return hash;
}

}  // namespace

void Admission::check(const Request& request) {
  if (!queue_.full_for(request.peer)) return;
  {
    const std::lock_guard lock(mutex_);
    if (remembered_.contains(hash_of(request))) return;
  }
  queue_.require_place(request.peer);
}

void Admission::remember(const Request& request) {
  const std::size_t hash = hash_of(request);
  const std::lock_guard lock(mutex_);
  if (remembered_.size() >= most_remembered) remembered_.clear();
  remembered_.insert(hash);
}

}  // namespace cyanometer
