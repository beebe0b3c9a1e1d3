// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/clocked_driver.h"

namespace vps {

LoopView LoopView::of(const HapticLoop& loop, OperatorPhase phase) noexcept {
  const TickReport& report = loop.last();
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

void ClockedDriver::obey(HapticLoop& loop, SyncEventKind what) noexcept {
  switch (what) {
    case SyncEventKind::Begin:
      return hand_.begin();
    case SyncEventKind::GoBack:
      return hand_.goBack(next_step_);
    case SyncEventKind::Recentre:
      return hand_.recentre();
    case SyncEventKind::GoOn:
      return hand_.goOn();
    case SyncEventKind::HandOver:
      return loop.handOver(X_WG_);
    case SyncEventKind::OpenClutch:
      return loop.disengage();
    case SyncEventKind::CloseClutch:
      return loop.engage();
    case SyncEventKind::LetGo:
      return loop.release();
    case SyncEventKind::Rearm:
      return loop.rearm();
    case SyncEventKind::Tick:
    case SyncEventKind::Step:
    case SyncEventKind::Settled:
    case SyncEventKind::Paused:
      return;
  }
}

void ClockedDriver::show(HapticLoop& loop, CouplingPort& port, const PhysicsSnapshot& snapshot) noexcept {
  if (snapshot.number == shown_) return;
  shown_ = snapshot.number;
  port.part.write(snapshot.part);
  if (snapshot.has_stored) loop.observeStoredEnergy(snapshot.stored_J, 0);
}

void ClockedDriver::rearmIfFaulted() {
  if (view_.safety.fault == SafetyFault::None) return;
  order(SyncEventKind::Rearm);
  view_.safety.fault = SafetyFault::None;
}

void ClockedDriver::look(const LoopView& view) {
  view_ = view;
  if (view.safety.faults == told_faults_) return;
  told_faults_ = view.safety.faults;
  tell_(toText(view.safety.fault));
}

}  // namespace vps
