// SPDX-License-Identifier: BSD-3-Clause
// Who moves the handle during a run: a simulated device with a virtual operator, or a recording of any
// device.
#pragma once

#include <cstddef>
#include <memory>

#include "vps_device/loop.h"
#include "vps_device/operator.h"
#include "vps_device/recording.h"
#include "vps_scenes/scene.h"

namespace vps {

/// The part in hand as it is now, in W.
struct HeldPart {
  Pose X_WP;
  Twist V_WP;
};

/// Device and hand together. A run asks it for nothing else.
class Hand {
 public:
  virtual ~Hand() = default;
  virtual Device& device() = 0;
  /// Makes up its mind how to do a step from time now_s on. May allocate; beside step(), by another thread.
  virtual void prepare(const OperatorTask& task, std::size_t step, double now_s) = 0;
  /// Starts what was prepared. As step(), never allocates.
  virtual void begin() = 0;
  /// Empty, goes back to where the coming step starts, in kHandReturn_s; null: to the middle. Never allocates
  /// for a step that can be reached.
  virtual void goBack(const SceneStep* next) = 0;
  /// Throws LoadError for a step that the device cannot reach.
  virtual void requireReachable(const SceneStep& step) const = 0;
  /// One tick of the hand, after the loop's own.
  virtual void step(const HeldPart& part, const HapticLoop& loop, double dt_s) = 0;
  [[nodiscard]] virtual OperatorPhase phase() const = 0;
  /// Has it so many ticks left?
  [[nodiscard]] virtual bool canGoOn(int ticks) const = 0;
};

inline constexpr double kHandReturn_s = 1.5;  ///< the hand's way back to the next part

/// The simulated dual arm and the virtual operator. Throws LoadError for a scene they cannot serve.
std::unique_ptr<Hand> simulatedHand(const Scene& scene);

/// A recording, of whatever device and hand; it outlives the hand.
std::unique_ptr<Hand> recordedHand(Recording& recording);

/// Where the handle starts so that a step's path lies around the middle of a workspace of this size. Throws
/// LoadError for a path that is longer than the workspace.
Pose handleStart(const Scene& scene, const SceneStep& step, const Vec3& workspace_m);

}  // namespace vps
