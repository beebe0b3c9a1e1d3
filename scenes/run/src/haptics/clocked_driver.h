// SPDX-License-Identifier: BSD-3-Clause
// Common base of a real-time run and its replay: the commands of the physics thread, and its view of the
// loop.
#pragma once

#include "haptics/haptic_driver.h"
#include "haptics/sync_events.h"
#include "vps_device/run_log.h"

namespace vps::scenes {

/// The physics thread reads the loop's state once per step, in advance(), and gives one command at a time.
/// The whole interaction of the two threads is therefore a list of SyncEvents, which a replay can repeat.
class ClockedDriver : public HapticDriver {
 public:
  [[nodiscard]] const device::LoopSettings& settings() const final { return settings_; }
  [[nodiscard]] bool isByClock() const final { return true; }

  void handOver(const Pose& X_WG) final { command({device::SyncEventKind::HandOver, X_WG, 0, 0, {}}); }
  void openClutch() final { command(device::SyncEventKind::OpenClutch); }
  void closeClutch() final { command(device::SyncEventKind::CloseClutch); }
  void begin(const device::OperatorTask& task, std::size_t step, double now_s) final {
    command({device::SyncEventKind::Begin, {}, step, now_s, task});
  }
  void letGo() final { command(device::SyncEventKind::LetGo); }
  void goBack(std::size_t next) final { command({device::SyncEventKind::GoBack, {}, next, 0, {}}); }
  void recentre() final { command(device::SyncEventKind::Recentre); }
  void goOn() final { command(device::SyncEventKind::GoOn); }

  void publish(const device::PhysicsState& state) final {
    device::PhysicsState numbered = state;
    numbered.step = ++published_;
    store(numbered);
  }
  const CouplingState& proxy() final { return view_.proxy; }
  const device::TickReport& last() final { return view_.report; }
  device::PassivityObserver passivity() final { return view_.passivity; }

 protected:
  ClockedDriver(const device::LoopSettings& settings, const ReportFault& report)
      : settings_(settings), report_fault_(report) {}

  /// Gives a command to the loop, and returns when the command has been carried out.
  virtual void command(const HandCommand& command) = 0;
  void command(device::SyncEventKind what) { command({what, {}, 0, 0, {}}); }
  /// Passes a state with its step number on to the loop.
  virtual void store(const device::PhysicsState& state) = 0;

  /// Clears a safety fault, as a person does between steps.
  void rearmIfFaulted() {
    if (view_.safety.fault == device::SafetyFault::None) return;
    command(device::SyncEventKind::Rearm);
    view_.safety.fault = device::SafetyFault::None;
  }
  /// Stores the loop's state as the view of the physics thread; reports a new safety fault.
  void setView(const device::HapticState& view) {
    view_ = view;
    if (view.safety.faults == reported_faults_) return;
    reported_faults_ = view.safety.faults;
    report_fault_(toText(view.safety.fault));
  }

  device::LoopSettings settings_;
  device::HapticState view_;  ///< state of the loop at the last advance()

 private:
  ReportFault report_fault_;
  std::int32_t published_ = 0;
  std::uint64_t reported_faults_ = 0;
};

}  // namespace vps::scenes
