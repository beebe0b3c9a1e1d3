// SPDX-License-Identifier: BSD-3-Clause
// Who moves the handle during a run: a simulated device with a virtual operator, or a recording of any
// device.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "vps_device/loop.h"
#include "vps_device/operator.h"
#include "vps_device/recording.h"
#include "vps_scenes/scene.h"

namespace vps::scenes {

/// The part in hand as it is now, in W.
struct HeldPart {
  Pose X_WP;
  Twist V_WP;
  Vec3 weight_W = Vec3::Zero();  ///< [N]
};

/// Device and hand together. A run asks it for nothing else.
class Hand {
 public:
  virtual ~Hand() = default;
  virtual device::Device& device() = 0;
  /// Makes up its mind how to do a step from time now_s on. May allocate; beside step(), by another thread.
  virtual void prepare(const device::OperatorTask& task, std::size_t step, double now_s) = 0;
  /// Starts what was prepared. As step(), never allocates.
  virtual void begin() = 0;
  /// Empty, goes back to where that step starts, in kHandReturn_s; beyond the last: to the middle. Never
  /// allocates.
  virtual void goBack(std::size_t next) = 0;
  /// In OperatorPhase::Regrasp: goes, with the clutch open, to where the next segment starts, in
  /// kHandReturn_s, and stays until goOn(). Neither allocates.
  virtual void recentre() = 0;
  /// Has the part again, where it was: goes on.
  virtual void goOn() = 0;
  /// One tick of the hand, after the loop's own.
  virtual void step(const HeldPart& part, const device::HapticLoop& loop, double dt_s) = 0;
  [[nodiscard]] virtual device::OperatorPhase phase() const = 0;
  /// Of a run by the clock that is done again; empty: of none.
  [[nodiscard]] virtual std::vector<device::SyncEvent> sync_events() const { return {}; }
  /// Has it so many ticks left?
  [[nodiscard]] virtual bool canGoOn(int ticks) const = 0;
};

inline constexpr double kHandReturn_s = 1.5;  ///< the hand's way back to the next part

/// The simulated dual arm and the virtual operator. Throws LoadError for a scene they cannot serve: a device
/// of another kind, a way that the device cannot reach.
std::unique_ptr<Hand> simulatedHand(const Scene& scene);

/// A recording, of whatever device and hand; it outlives the hand.
std::unique_ptr<Hand> recordedHand(device::Recording& recording);

}  // namespace vps::scenes
