// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/recorded_events.h"

namespace vps::scenes {

std::vector<RecordedEvent> recordedEvents(const std::vector<device::LogEntry>& entries) {
  std::vector<RecordedEvent> all;
  std::size_t since = 0;  // the physics thread's last event
  device::OperatorState hand;
  for (const device::LogEntry& entry : entries) {
    const auto* run_event = std::get_if<device::RunEvent>(&entry);
    if (run_event != nullptr && run_event->kind == device::RunEventKind::Phase) {
      hand = device::stateFromByte(run_event->phase);
      for (std::size_t i = since; i < all.size(); ++i) all[i].hand = hand;
    }
    const auto* event = std::get_if<device::SyncEvent>(&entry);
    if (event == nullptr) continue;
    using enum device::SyncEventKind;
    if (event->kind != Tick && event->kind != Silent) since = all.size();
    all.push_back({*event, hand});
  }
  return all;
}

}  // namespace vps::scenes
