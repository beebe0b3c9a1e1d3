// SPDX-License-Identifier: BSD-3-Clause
// What a run does by the clutch: from hand to hand at the change of a step, and a new grasp on the way.
#pragma once

#include <functional>
#include <utility>

#include "haptics/haptic_driver.h"

namespace vps::scenes {

/// Each waits in physics steps: all that a step asks for is in go_on, which is false where the run cannot go
/// on; so are they then. The part stands meanwhile, held by the proxy.
class ClutchWork {
 public:
  /// side outlives it.
  /// @param step_s  what a step of physics takes of the hand's time, which is the clock's; asked before each
  ClutchWork(HapticDriver& side, std::function<double()> step_s)
      : driver_(side), step_s_(std::move(step_s)) {}

  /// After handOver(): until the hand has all of the part.
  bool takeHold(const std::function<bool()>& go_on) const;
  /// Until it has none of it.
  bool comeFree(const std::function<bool()>& go_on) const;
  /// The proxy's grip on the part fades, over as long as the clutch takes: what the spring holds is given up
  /// bit by bit, and the part comes to rest on what it stands on before it is let go.
  /// @param go_on  gets the share of the grip that is left, down to 0
  bool setDown(const std::function<bool(double share)>& go_on) const;
  /// Lets go, goes back to where the next segment starts, takes hold again and goes on.
  bool index_point(const std::function<bool()>& go_on) const;

 private:
  bool waitForClutch(double ratio, const std::function<bool()>& go_on) const;
  bool goOnFor(double seconds, const std::function<bool()>& go_on) const;

  HapticDriver& driver_;
  std::function<double()> step_s_;
};

}  // namespace vps::scenes
