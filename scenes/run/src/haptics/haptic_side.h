// SPDX-License-Identifier: BSD-3-Clause
// The haptic half of a run in real time: device, hand and loop, on a thread of their own. Physics runs in the
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
  double stale_s = 2e-3;         ///< ticks with an older physics state are counted as stale
  double physics_limit_s = 0.1;  ///< see device::LoopSettings
  /// Whether the other process that computes physics is silent; called in each tick. Empty: physics runs in
  /// this process. The limit for silence may be shorter than a physics step.
  std::function<bool()> is_silent = nullptr;
};

/// Used by one thread, except for the functions that allow any thread.
class HapticSide {
 public:
  /// All arguments must outlive this object.
  /// @param log  receives the entries that a replay needs, on the haptic thread
  HapticSide(Hand& hand, device::CouplingPort& port, const device::LoopSettings& settings,
             const HapticTiming& timing, device::RunLog& log);
  ~HapticSide() { stop(); }

  [[nodiscard]] bool isRunning() const { return loop_.isRunning(); }
  void start();
  /// Stops the haptic thread and logs the stop. The result is false if the thread did not run.
  bool stop();

  /// Gives a command to the haptic thread, and returns when the command has been carried out.
  void carryOut(const HandCommand& command);
  void setGains(const CouplingGains& gains);

  /// State of the hand at the last tick. Any thread may call.
  [[nodiscard]] device::OperatorState state() const {
    return device::stateFromByte(state_.load(std::memory_order_acquire));
  }
  /// Number of the tick of state(), or of a later tick if tick() is called after state(). Any thread may
  /// call.
  [[nodiscard]] std::int32_t tick() const { return tick_.load(std::memory_order_acquire); }
  [[nodiscard]] const std::atomic<std::uint8_t>& stateByte() const { return state_; }
  /// State of the loop; may be called only while the loop does not run.
  [[nodiscard]] device::HapticState loopState() { return loop_.loop().state(); }

  /// Takes the loop's events out of their queue and counts faults. Keeps events for passEvents(), at most as
  /// many as the queue holds.
  void countFaults();
  /// Passes on the events that countFaults() took since the last call.
  void passEvents(const std::function<void(const device::DeviceEvent&)>& to);
  [[nodiscard]] std::uint64_t missed() const { return loop_.statistics().summary().missed; }
  [[nodiscard]] TickTimes times() const;
  /// Timing results of the haptic thread; the results of physics keep their default values.
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
  std::vector<device::DeviceEvent> reported_;  ///< events taken from the queue and not yet passed on
  device::TappedDevice tapped_;
  std::atomic<std::uint8_t> state_{device::toByte({})};  ///< state of the hand, written by the haptic thread
  static_assert(std::atomic<std::uint8_t>::is_always_lock_free, "the haptic thread must not wait for a lock");
  std::atomic<std::int32_t> tick_{0};  ///< written before state_
  HandCommand command_;                ///< the command that is being carried out
  RealTimeResult result_;
  device::RealTimeLoop loop_;
};

}  // namespace vps::scenes
