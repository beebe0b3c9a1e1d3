// SPDX-License-Identifier: BSD-3-Clause
// Options of an assembly run, with the callbacks that report its progress.
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

/// Asks a run for a Snapshot, as a window does. The run makes the snapshot on request at the end of a physics
/// step. No other thread reads the run's state, and a watched run gives the same bits as an unwatched run.
struct SnapshotTap {
  std::atomic<bool> is_wanted{false};    ///< set by the watching thread, cleared by the run
  std::function<void(Snapshot&&)> give;  ///< called by the physics thread
};

struct AssembleOptions : ModelOptions {
  bool keep_going =
      true;  ///< after a failed step, place its part at its target and continue with the next step
  /// The judge measures every judge_stride-th pose of a step, and always the fifty poses with the deepest
  /// contacts. Affects only max_penetration_m and the fields that describe it.
  std::size_t judge_stride = 20;
  const std::atomic<bool>* stop =
      nullptr;  ///< set the flag to end the run early; the reason in the result is then "stopped"
  /// Runs the haptic loop on its own thread and physics on the caller's thread, both in real time, from the
  /// first step to the last. Other threads judge each step and cook the next field. A run in real time does
  /// not repeat bit for bit, but its recording replays bit for bit, because the recording holds the order in
  /// which the two threads exchanged state.
  bool is_real_time = false;
  /// In real time, a run that cannot hold its physics rate sheds load (load_level.h), and restores the load
  /// when the rate allows. False: the run only counts the periods that it missed. Lockstep never sheds load.
  bool degrades = true;
  /// Called by the physics thread after each step, with the simulated time; an empty function is not called.
  std::function<void(double time_s)> after_step;
  SnapshotTap* tap = nullptr;  ///< receives the requested snapshots; null: nobody requests snapshots
  /// Called by the physics thread with each fault, warning and notice of the loop and of a simulated arm; an
  /// empty function is not called.
  std::function<void(const device::DeviceEvent&)> on_device_event;
  /// Handle pose that the window's cursor asks for, in a run with [device] kind = "mouse". Null: a run with
  /// [device] kind = "mouse" is refused.
  std::shared_ptr<device::HandleWish> wish;
  /// Makes a device, moved by a person or a program, that replaces the one that the scene's [device] kind
  /// names. The run must be in real time. Empty: the scene's device is used.
  std::function<std::unique_ptr<device::Device>()> device;
  /// Axis snap: while the flag is set, a spring pulls the part in hand to its insertion axis
  /// (src/world/axis_snap.h). The flag may change at any time. Null: no axis snap. A recorded run in
  /// simulated time has no axis snap, since its recording would not hold the moment of the change.
  const std::atomic<bool>* snaps = nullptr;
  /// Requests to a run in real time, such as to release the part. Null: there are no requests.
  RunRequests* requests = nullptr;
  /// Called after each step of the procedure with the result so far; an empty function is not called. In this
  /// result the totals are not filled in yet, and the member `finished` holds the present poses of the parts.
  std::function<void(const AssembleResult&)> on_step;
  /// The haptic loop computes the part's motion itself between physics steps (vps_device/local_contact.h),
  /// for physics slower than the loop. A run with local contact cannot be recorded. In real time the loop is
  /// paused while a part is taken or released.
  bool has_local_contact = false;
};

/// Least time limit of a step in which a person moves the part. assumed: longer than a person tries to place
/// one part
inline constexpr double kPersonTimeout_s = 600;

}  // namespace vps::scenes
