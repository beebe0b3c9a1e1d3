// SPDX-License-Identifier: BSD-3-Clause
// How the physics thread and the haptic loop of a run in real time interact: the commands of the physics
// thread, and the events of a recorded run.
#pragma once

#include <cstddef>
#include <vector>

#include "vps_device/loop.h"
#include "vps_device/operator.h"
#include "vps_device/run_log.h"

namespace vps::scenes {

class Hand;

struct HandCommand {
  device::SyncEventKind what = device::SyncEventKind::Tick;  ///< Begin or a later kind
  Pose X_WG;                                                 ///< argument of HandOver
  std::size_t step = 0;       ///< argument of Begin, and of GoBack: the next step
  double now_s = 0;           ///< argument of Begin
  device::OperatorTask task;  ///< argument of Begin
};

/// Allocates the memory that a command needs, on any thread, before carryOut().
void prepare(Hand& hand, const HandCommand& command);
/// Carries out the command, on the thread that runs the loop. Never allocates.
void carryOut(Hand& hand, device::HapticLoop& loop, const HandCommand& command) noexcept;

struct RecordedEvent {
  device::SyncEvent event;
  /// The hand's state that the run logged between this event of the physics thread and the next one. The
  /// loop's samples do not contain this state: physics may take two steps between two ticks of a late loop,
  /// and learn of a new phase in the second step.
  device::OperatorState hand;
};

std::vector<RecordedEvent> recordedEvents(const std::vector<device::LogEntry>& entries);

}  // namespace vps::scenes
