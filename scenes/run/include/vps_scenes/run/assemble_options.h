// SPDX-License-Identifier: BSD-3-Clause
// How an assembly procedure is run, and what its caller hears of it.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>

#include "vps_device/device.h"
#include "vps_device/pulled_handle.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/run/run_requests.h"
#include "vps_scenes/scene/model_options.h"

namespace vps::scenes {

/// Asks a run for a Snapshot, as a window does. A run makes one at the end of a physics step where it is
/// asked, so that nobody else reads its state, and a run that is watched has the same bits as one that is
/// not.
struct SnapshotTap {
  std::atomic<bool> is_wanted{false};    ///< set by the one who watches, cleared by the run
  std::function<void(Snapshot&&)> give;  ///< called by the physics thread
};

struct AssembleOptions : ModelOptions {
  bool keep_going = true;  ///< after a failed step, place its part at its target and go on with the next step
  /// The judge measures every judge_stride-th pose of a step, and always the fifty poses with the deepest
  /// contacts. Affects only max_penetration_m and the fields that describe it.
  std::size_t judge_stride = 20;
  const std::atomic<bool>* stop = nullptr;  ///< set it to end early; the result then says "stopped"
  /// Runs the haptic loop on a thread of its own and physics on the caller's, both by the system's clock,
  /// from the first step to the last. Each step is judged and the next field cooked on other threads
  /// meanwhile. Such a run does not repeat bit for bit, but its recording replays bit for bit, because it
  /// holds the order in which the two threads exchanged state.
  bool is_real_time = false;
  /// In real time, a run that cannot hold its physics rate sheds load (load_level.h), and restores it when it
  /// can. False: it only counts the periods it missed. Lockstep never sheds load.
  bool degrades = true;
  /// Called by the physics thread after each step, with the simulated time. May be empty.
  std::function<void(double time_s)> after_step;
  SnapshotTap* tap = nullptr;  ///< may be null
  /// Called by the physics thread with each fault, warning and notice of the loop and of a simulated arm. May
  /// be empty.
  std::function<void(const device::DeviceEvent&)> on_device_event;
  /// Of a run by hand with [device] kind = "mouse": where the window's cursor wants the handle. Null: a run
  /// with that kind is refused.
  std::shared_ptr<device::HandleWish> wish;
  /// A device of one's own in place of the one that the scene's [device] kind names, moved by a person or a
  /// program. The run is in real time. Empty: there is none.
  std::function<std::unique_ptr<device::Device>()> device;
  /// Axis snap: while set, a spring pulls the part in hand to the axis along which its step brings it home
  /// (src/procedure/axis_snap.h). It may change at any time. Null: none. A recorded run in simulated time has
  /// none, since its recording would not hold the moment of the change.
  const std::atomic<bool>* snaps = nullptr;
  /// What others ask of a run by the clock. Null: nobody asks.
  RunRequests* requests = nullptr;
  /// Called after each step of the procedure with the result so far, whose sums are not filled in yet; its
  /// `finished` shows where the parts are. May be empty.
  std::function<void(const AssembleResult&)> on_step;
  /// The haptic loop computes the part's motion itself between physics steps (vps_device/local_contact.h),
  /// for physics slower than the loop. Such a run cannot be recorded. In real time the loop is paused where a
  /// part is taken and released.
  bool has_local_contact = false;
};

/// Least time that a person has for each step of a run by hand. assumed: longer than a person tries
inline constexpr double kPersonTimeout_s = 600;

}  // namespace vps::scenes
