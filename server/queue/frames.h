// Frames, encoded: equal ones in flight are rendered once, and some are kept, those used last,
// within a bound of memory.
#pragma once

#include <cstdint>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>

#include "server/queue/render_queue.h"
#include "server/queue/single_flight.h"

namespace cyanometer {

struct EncodedFrame {
  std::string bytes;
  double exposure_ev = 0;
  double queue_ms = 0, prepare_ms = 0, render_ms = 0, encode_ms = 0;
};

class Frames {
 public:
  /// @param most_bytes  of the frames that are kept
  Frames(RenderQueue& queue, std::size_t most_bytes) : queue_(queue), most_bytes_(most_bytes) {}

  enum class Origin { rendered, joined, kept };
  struct Got {
    std::shared_ptr<const EncodedFrame> frame;
    Origin origin = Origin::rendered;
    /// Held while the frame is sent: it counts among the frames alive until then.
    std::shared_ptr<void> memory = {};
  };
  struct Order {
    const Scene& scene;
    const Plan& plan;
    std::string tag;  ///< equal tags are equal frames
    std::string client;
    std::size_t frame_bytes = 0;
    std::optional<Place> place = {};
    bool keep = true;
    /// Called when the device has done this frame, which is not encoded yet; not where another
    /// rendered it.
    std::function<void()> rendered = [] {};
  };
  /// @throws as RenderQueue::run
  Got get(const Order& order, const Watch& watch);

  struct Flown {
    std::shared_ptr<const EncodedFrame> frame;
    std::shared_ptr<void> memory;  ///< as Got's
  };
  /// A frame that was rendered by the job of that ticket. Looks up (engine/attention.h).
  Flown encoded(const Frame& frame, const Scene& scene, const Ticket& ticket);

  struct Counts {
    std::uint64_t rendered = 0, joined = 0, kept = 0;
    std::size_t kept_bytes = 0;
  };
  Counts counts() const;

 private:
  struct Entry {
    std::string tag;
    std::shared_ptr<const EncodedFrame> frame;
    std::weak_ptr<void> memory;  ///< of those who are being sent it, all together
  };
  std::optional<Flown> find(const std::string& tag);
  Flown render(const Order& order, const Watch& watch);
  void keep(const std::string& tag, const Flown& flown);

  RenderQueue& queue_;
  std::size_t most_bytes_;
  SingleFlight<Flown> flights_;
  mutable std::mutex mutex_;
  std::list<Entry> entries_;  ///< used last first
  std::unordered_map<std::string, std::list<Entry>::iterator> places_;
  Counts counts_;
};

}  // namespace cyanometer
