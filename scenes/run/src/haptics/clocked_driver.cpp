// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/clocked_driver.h"

namespace vps::scenes {

void ClockedDriver::publish(const device::PhysicsState& state) {
  device::PhysicsState numbered = state;
  numbered.step = ++published_;
  store(numbered);
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

}  // namespace vps::scenes
