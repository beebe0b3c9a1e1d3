// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/clocked_driver.h"

namespace vps::scenes {

LoopView LoopView::of(const device::HapticLoop& loop, device::OperatorPhase phase) noexcept {
  const device::TickReport& report = loop.last();
  return {static_cast<std::int32_t>(loop.ticks()),
          {report.X_WG, report.V_WG, report.time_s, loop.isHolding()},
          report,
          loop.safety(),
          loop.ledger(),
          phase};
}

void ClockedDriver::publish(const CouplingState& part, std::optional<double> stored_J) {
  store({part, stored_J.value_or(0), stored_J.has_value(), ++published_});
}

void ClockedDriver::obey(device::HapticLoop& loop, device::SyncEventKind what) noexcept {
  switch (what) {
    case device::SyncEventKind::Begin:
      return hand_.begin();
    case device::SyncEventKind::GoBack:
      return hand_.goBack(next_step_);
    case device::SyncEventKind::Recentre:
      return hand_.recentre();
    case device::SyncEventKind::GoOn:
      return hand_.goOn();
    case device::SyncEventKind::HandOver:
      return loop.handOver(X_WG_);
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
      return;
  }
}

void ClockedDriver::show(device::HapticLoop& loop, CouplingPort& port,
                         const PhysicsSnapshot& snapshot) noexcept {
  if (snapshot.number == shown_) return;
  shown_ = snapshot.number;
  port.part.write(snapshot.part);
  if (snapshot.has_stored) loop.observeStoredEnergy(snapshot.stored_J, 0);
}

void ClockedDriver::rearmIfFaulted() {
  if (view_.safety.fault == device::SafetyFault::None) return;
  order(device::SyncEventKind::Rearm);
  view_.safety.fault = device::SafetyFault::None;
}

void ClockedDriver::look(const LoopView& view) {
  view_ = view;
  if (view.safety.faults == told_faults_) return;
  told_faults_ = view.safety.faults;
  tell_(toText(view.safety.fault));
}

}  // namespace vps::scenes
