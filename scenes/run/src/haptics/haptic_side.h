// SPDX-License-Identifier: BSD-3-Clause
// The haptic half of a run by the clock: device, hand and loop, on a thread of their own. Physics is in the
// same process (real_time_driver.cpp) or in another one (network/device_node.cpp).
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "haptics/sync_events.h"
#include "vps_device/real_time_loop.h"
#include "vps_scenes/run/result.h"

namespace vps::scenes {

struct HapticTiming {
  double stale_s = 2e-3;         ///< ticks with an older physics state are counted
  double physics_limit_s = 0.1;  ///< device::LoopSettings
  /// Whether the process that computes physics shows no sign of life; called in each tick. Empty: it is this
  /// one. A physics step may take longer than such a process may be silent.
  std::function<bool()> is_silent = nullptr;
};

/// Used by one thread, apart from state().
class HapticSide {
 public:
  /// All arguments outlive it.
  /// @param log  gets what a replay needs, on the haptic thread
  HapticSide(Hand& hand, device::CouplingPort& port, const device::LoopSettings& settings,
             const HapticTiming& timing, device::RunLog& log);
  ~HapticSide() { stop(); }

  [[nodiscard]] bool isRunning() const { return loop_.isRunning(); }
  void start();
  /// Stops the thread and logs that. False: it did not run.
  bool stop();

  /// Returns when the command has been carried out.
  void carryOut(const HandCommand& command);
  void setGains(const CouplingGains& gains);

  /// What the hand does, as of the last tick. Any thread.
  [[nodiscard]] device::OperatorState state() const {
    return device::stateFromByte(state_.load(std::memory_order_acquire));
  }
  /// The tick of that state(), or a later one if this is read after it. Any thread.
  [[nodiscard]] std::int32_t tick() const { return tick_.load(std::memory_order_acquire); }
  [[nodiscard]] const std::atomic<std::uint8_t>& stateByte() const { return state_; }
  /// The loop's state while it does not run.
  [[nodiscard]] device::HapticState loopState() { return loop_.loop().state(); }

  /// Takes the loop's events out of their queue; they wait for passEvents(), as many as the queue holds.
  void countFaults();
  /// Passes on what was taken since the last call.
  void passEvents(const std::function<void(const device::DeviceEvent&)>& to);
  [[nodiscard]] std::uint64_t missed() const { return loop_.statistics().summary().missed; }
  [[nodiscard]] TickTimes times() const;
  /// What the haptic side knows of it.
  [[nodiscard]] RealTimeResult realTime();

 private:
  void logEvent(const device::HapticLoop& loop, device::SyncEventKind kind);
  void publishState(const device::HapticLoop& loop);
  void logTick(const device::HapticLoop& loop, std::int64_t periods);
  void watchPhysics(device::HapticLoop& loop);
  void moveHand(device::HapticLoop& loop, double dt_s);
  device::LoopSettings withEvents(device::LoopSettings settings);
  device::RealTimeSettings realTimeSettings(const HapticTiming& timing);

  Hand& hand_;
  device::RunLog& log_;
  std::function<bool()> is_silent_;
  device::DeviceEventQueue events_;
  std::vector<device::DeviceEvent> reported_;  ///< taken, and not passed on yet
  device::TappedDevice tapped_;
  std::atomic<std::uint8_t> state_{device::toByte({})};  ///< of the hand, by its thread
  static_assert(std::atomic<std::uint8_t>::is_always_lock_free, "the haptic thread must not wait for a lock");
  std::atomic<std::int32_t> tick_{0};  ///< written before state_
  HandCommand command_;                ///< the one being carried out
  RealTimeResult result_;
  device::RealTimeLoop loop_;
};

}  // namespace vps::scenes
