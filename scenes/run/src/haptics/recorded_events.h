// SPDX-License-Identifier: BSD-3-Clause
// The events of a recorded run by the clock, each with what physics knew of the hand after it.
#pragma once

#include <vector>

#include "vps_device/operator.h"
#include "vps_device/run_log.h"

namespace vps::scenes {

struct RecordedEvent {
  device::SyncEvent event;
  /// As the run logged it between this event of the physics thread and the next one. The loop's samples do
  /// not tell it: physics may take two steps between two ticks of a loop that is late, and learn of a new
  /// phase in the second.
  device::OperatorState hand;
};

std::vector<RecordedEvent> recordedEvents(const std::vector<device::LogEntry>& entries);

}  // namespace vps::scenes
