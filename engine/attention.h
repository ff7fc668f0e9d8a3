// Whether work on the processor is still wanted, for what no Watch is handed down to: the
// spheres of a scene are solved, and a picture is encoded, in the middle of functions that are
// pure otherwise.
#pragma once

namespace cyanometer {

struct Watch;

/// While it lives, look_up() on this thread looks at the watch. One within another stands in
/// for it, so that work done in between is not taken for the work around it.
class Attention {
 public:
  explicit Attention(const Watch& watch);
  ~Attention();
  Attention(const Attention&) = delete;

 private:
  const Watch* around_;
};

/// To be called every few tens of milliseconds, and with no lock held: other work may be done
/// meanwhile (Watch::gone). @throws Cancelled
void look_up();

}  // namespace cyanometer
