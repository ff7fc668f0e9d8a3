#include "server/queue/frames.h"

#include "engine/attention.h"
#include "engine/image/encode.h"

namespace cyanometer {
namespace {

using Clock = std::chrono::steady_clock;

}  // namespace

Frames::Got Frames::get(const Order& order, const Watch& watch) {
  if (auto kept = find(order.tag)) return {kept->frame, Origin::kept, kept->memory};
  const auto landed = flights_.get(order.tag, watch,
                                   [&](const Watch& shared) { return render(order, shared); });
  {
    const std::lock_guard lock(mutex_);
    ++(landed.joined ? counts_.joined : counts_.rendered);
  }
  if (order.keep && !landed.joined) keep(order.tag, *landed.value);
  return {landed.value->frame, landed.joined ? Origin::joined : Origin::rendered,
          landed.value->memory};
}

Frames::Flown Frames::render(const Order& order, const Watch& watch) {
  Frame frame;
  const Ticket ticket = queue_.run({.client = order.client,
                                    .expected_ms = order.plan.expected_ms,
                                    .place = order.place,
                                    .frame_bytes = order.frame_bytes,
                                    .watch = watch,
                                    .work = [&](Engine& engine, const Watch& w) {
                                      frame = engine.render(order.scene, order.plan, w);
                                    }});
  order.rendered();
  const Attention attention(watch);
  return encoded(frame, order.scene, ticket);
}

Frames::Flown Frames::encoded(const Frame& frame, const Scene& scene, const Ticket& ticket) {
  EncodedFrame encoded;
  const auto start = Clock::now();
  encoded.bytes = encode(frame, scene);
  encoded.encode_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  encoded.exposure_ev = frame.exposure_ev;
  encoded.queue_ms = ticket.queued_ms + ticket.given_away_ms;
  encoded.prepare_ms = frame.prepare_ms;
  encoded.render_ms = std::max(frame.render_ms - ticket.given_away_ms, 0.0);
  auto memory = queue_.hold(encoded.bytes.size());
  return {std::make_shared<const EncodedFrame>(std::move(encoded)), std::move(memory)};
}

std::optional<Frames::Flown> Frames::find(const std::string& tag) {
  const std::lock_guard lock(mutex_);
  const auto place = places_.find(tag);
  if (place == places_.end()) return std::nullopt;
  entries_.splice(entries_.begin(), entries_, place->second);
  ++counts_.kept;
  Entry& entry = *place->second;
  // Kept no longer, it may still be sent for a while: it counts as any other, once. The handle
  // points at nothing, so whether there is one is a question of who shares it.
  auto memory = entry.memory.lock();
  if (memory.use_count() == 0) memory = queue_.hold(entry.frame->bytes.size());
  entry.memory = memory;
  return Flown{entry.frame, std::move(memory)};
}

void Frames::keep(const std::string& tag, const Flown& flown) {
  const auto bytes_of = [](const Entry& entry) {
    constexpr std::size_t places = 256;  // in the list, in the map and on the heap, about
    return entry.frame->bytes.size() + sizeof(EncodedFrame) + 2 * entry.tag.size() + places;
  };
  Entry entry{tag, flown.frame, flown.memory};
  const std::lock_guard lock(mutex_);
  if (bytes_of(entry) > most_bytes_ || places_.contains(tag)) return;
  counts_.kept_bytes += bytes_of(entry);
  entries_.push_front(std::move(entry));
  places_[tag] = entries_.begin();
  while (counts_.kept_bytes > most_bytes_) {
    counts_.kept_bytes -= bytes_of(entries_.back());
    places_.erase(entries_.back().tag);
    entries_.pop_back();
  }
}

Frames::Counts Frames::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

}  // namespace cyanometer
