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

void ClockedSide::publish(const CouplingState& part, std::optional<double> stored_J) {
  store({part, stored_J.value_or(0), stored_J.has_value(), ++published_});
}

void ClockedSide::obey(HapticLoop& loop, MeetingKind what) noexcept {
  switch (what) {
    case MeetingKind::Begin:
      return hand_.begin();
    case MeetingKind::GoBack:
      return hand_.goBack(next_step_);
    case MeetingKind::Recentre:
      return hand_.recentre();
    case MeetingKind::GoOn:
      return hand_.goOn();
    case MeetingKind::HandOver:
      return loop.handOver(X_WG_);
    case MeetingKind::OpenClutch:
      return loop.disengage();
    case MeetingKind::CloseClutch:
      return loop.engage();
    case MeetingKind::LetGo:
      return loop.release();
    case MeetingKind::Rearm:
      return loop.rearm();
    case MeetingKind::Tick:
    case MeetingKind::Step:
    case MeetingKind::Settled:
    case MeetingKind::Paused:
      return;
  }
}

void ClockedSide::show(HapticLoop& loop, CouplingPort& port, const PhysicsSnapshot& snapshot) noexcept {
  if (snapshot.number == shown_) return;
  shown_ = snapshot.number;
  port.part.write(snapshot.part);
  if (snapshot.has_stored) loop.noteStored(snapshot.stored_J, 0);
}

void ClockedSide::rearmIfFaulted() {
  if (view_.safety.fault == SafetyFault::None) return;
  order(MeetingKind::Rearm);
  view_.safety.fault = SafetyFault::None;
}

void ClockedSide::look(const LoopView& view) {
  view_ = view;
  if (view.safety.faults == told_faults_) return;
  told_faults_ = view.safety.faults;
  tell_(toText(view.safety.fault));
}

}  // namespace vps
