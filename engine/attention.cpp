#include "engine/attention.h"

#include <utility>

#include "engine/engine.h"

namespace cyanometer {
namespace {

thread_local const Watch* watched = nullptr;

}  // namespace

Attention::Attention(const Watch& watch) : around_(std::exchange(watched, &watch)) {}
Attention::~Attention() { watched = around_; }

void look_up() {
  if (watched) watched->check();
}

}  // namespace cyanometer
