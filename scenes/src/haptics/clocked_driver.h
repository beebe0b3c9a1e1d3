// SPDX-License-Identifier: BSD-3-Clause
// What a run by the clock and its replay have in common: what physics asks of the loop, and what it knows of
// it.
#pragma once

#include "haptics/haptic_driver.h"
#include "vps_device/run_log.h"

namespace vps::scenes {

/// What physics publishes after a step.
struct PhysicsSnapshot {
  CouplingState part;
  double stored_J = 0;
  bool has_stored = false;
  std::int32_t number = 0;  ///< how many were published, this one too
};

/// The loop as one tick left it.
struct LoopView {
  std::int32_t tick = 0;
  CouplingState proxy;
  device::TickReport report;
  device::SafetyState safety;
  device::PassivityObserver ledger;
  device::OperatorPhase phase = device::OperatorPhase::Idle;

  static LoopView of(const device::HapticLoop& loop, device::OperatorPhase phase) noexcept;
};

/// Physics looks at the loop once a step, in advance(), and asks for one thing at a time. So all that the two
/// know of each other is a list of sync_events, and who has the list can do it again.
class ClockedDriver : public HapticDriver {
 public:
  [[nodiscard]] const device::LoopSettings& settings() const final { return settings_; }
  [[nodiscard]] bool isByClock() const final { return true; }

  void handOver(const Pose& X_WG) final {
    X_WG_ = X_WG;
    order(device::SyncEventKind::HandOver);
  }
  void openClutch() final { order(device::SyncEventKind::OpenClutch); }
  void closeClutch() final { order(device::SyncEventKind::CloseClutch); }
  void begin(const device::OperatorTask& task, std::size_t step, double now_s) final {
    hand_.prepare(task, step, now_s);
    order(device::SyncEventKind::Begin);
  }
  void letGo() final { order(device::SyncEventKind::LetGo); }
  void goBack(std::size_t next) final {
    next_step_ = next;
    order(device::SyncEventKind::GoBack);
  }
  void recentre() final { order(device::SyncEventKind::Recentre); }
  void goOn() final { order(device::SyncEventKind::GoOn); }

  void publish(const CouplingState& part, std::optional<double> stored_J) final;
  const CouplingState& proxy() final { return view_.proxy; }
  const device::TickReport& last() final { return view_.report; }
  device::PassivityObserver ledger() final { return view_.ledger; }

 protected:
  ClockedDriver(Hand& hand, const device::LoopSettings& settings, const TellFault& tell)
      : hand_(hand), settings_(settings), tell_(tell) {}

  /// Returns when it is done.
  virtual void order(device::SyncEventKind what) = 0;
  virtual void store(const PhysicsSnapshot& snapshot) = 0;

  /// Does what was asked for, by whoever runs the loop. Never allocates.
  void obey(device::HapticLoop& loop, device::SyncEventKind what) noexcept;
  /// Before a tick: the loop gets the snapshot, once.
  void show(device::HapticLoop& loop, CouplingPort& port, const PhysicsSnapshot& snapshot) noexcept;
  /// As a person does between steps.
  void rearmIfFaulted();
  void look(const LoopView& view);

  Hand& hand_;
  device::LoopSettings settings_;
  LoopView view_;

 private:
  TellFault tell_;
  Pose X_WG_;                  ///< of HandOver
  std::size_t next_step_ = 0;  ///< of GoBack
  std::int32_t published_ = 0, shown_ = 0;
  std::uint64_t told_faults_ = 0;
};

}  // namespace vps::scenes
