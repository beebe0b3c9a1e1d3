// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/sync_events.h"

#include "haptics/hand.h"

namespace vps::scenes {

void prepare(Hand& hand, const HandCommand& command) {
  if (command.what == device::SyncEventKind::Begin) hand.prepare(command.task, command.step, command.now_s);
}

void carryOut(Hand& hand, device::HapticLoop& loop, const HandCommand& command) noexcept {
  switch (command.what) {
    case device::SyncEventKind::Begin:
      return hand.begin();
    case device::SyncEventKind::GoBack:
      return hand.goBack(command.step);
    case device::SyncEventKind::Recentre:
      return hand.recentre();
    case device::SyncEventKind::GoOn:
      return hand.goOn();
    case device::SyncEventKind::HandOver:
      return loop.handOver(command.X_WG);
    case device::SyncEventKind::OpenClutch:
      return loop.disengage();
    case device::SyncEventKind::CloseClutch:
      return loop.engage();
    case device::SyncEventKind::LetGo:
      return loop.release();
    case device::SyncEventKind::Rearm:
      return loop.rearm();
    case device::SyncEventKind::Tick:
    case device::SyncEventKind::Step:
    case device::SyncEventKind::Settled:
    case device::SyncEventKind::Paused:
    case device::SyncEventKind::SnapOn:
    case device::SyncEventKind::SnapOff:
    case device::SyncEventKind::GiveUp:
    case device::SyncEventKind::Silent:
      return;
  }
}

std::vector<RecordedEvent> recordedEvents(const std::vector<device::LogEntry>& entries) {
  std::vector<RecordedEvent> all;
  std::size_t since = 0;  // index of the physics thread's last event
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
