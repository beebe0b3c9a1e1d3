// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/clocked_driver.h"

namespace vps::scenes::inline v0 {

void ClockedDriver::publish(const device::PhysicsState& state) {
  device::PhysicsState numbered = state;
  numbered.step = ++published_;
  store(numbered);
}

void ClockedDriver::carryOut(device::HapticLoop& loop, device::SyncEventKind what) noexcept {
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

void ClockedDriver::rearmIfFaulted() {
  if (view_.safety.fault == device::SafetyFault::None) return;
  command(device::SyncEventKind::Rearm);
  view_.safety.fault = device::SafetyFault::None;
}

void ClockedDriver::setView(const device::HapticState& view) {
  view_ = view;
  if (view.safety.faults == reported_faults_) return;
  reported_faults_ = view.safety.faults;
  report_fault_(toText(view.safety.fault));
}

}  // namespace vps::scenes::inline v0
