// SPDX-License-Identifier: BSD-3-Clause
// The haptic loop in real time: a periodic thread calls HapticLoop::tick(), the same code as in lockstep.
//
// State is exchanged through the CouplingPort. Commands are requests in a lock-free ring: they are carried
// out at the start of the next tick, in order, and acknowledged.
#pragma once

#include <array>
#include <functional>

#include "vps_device/export.h"
#include "vps_device/loop.h"
#include "vps_device/periodic_thread.h"
#include "vps_device/tick_statistics.h"

namespace vps::device {

/// Measures how long a device takes for read() and write().
class VPS_DEVICE_API TimedDevice final : public Device {
 public:
  TimedDevice(Device& device, RealTimeClock& clock) noexcept : device_(&device), clock_(&clock) {}
  DeviceSample read() noexcept override;
  void write(const Wrench& F_Ho_D) noexcept override;
  void rearm() noexcept override { device_->rearm(); }
  [[nodiscard]] DeviceLimits limits() const noexcept override { return device_->limits(); }
  [[nodiscard]] std::string_view name() const noexcept override { return device_->name(); }

  /// Nanoseconds spent in the device since the last call.
  std::int64_t takeSpent_ns() noexcept;

 private:
  Device* device_;
  RealTimeClock* clock_;
  std::int64_t spent_ns_ = 0;
};

/// The functions are called by the loop's thread and must not allocate, lock, throw or wait.
struct RealTimeSettings {
  /// SCHED_FIFO priority; 0: none. assumed: above interrupt threads (50), below the kernel's
  int priority = 80;
  bool locks_memory = true;
  /// Replaces LoopSettings::physics_limit_s if that limit is 0. assumed: ten steps of 100 Hz physics, and
  /// shorter than a person needs to notice that a part has stopped
  double physics_limit_s = 0.1;
  double stale_s = 2e-3;           ///< ticks with an older physics state are counted
  RealTimeClock* clock = nullptr;  ///< null: the system's clock
  /// Called before each tick, after the requests and HapticLoop::receivePart(), with the number of periods
  /// since the last tick.
  std::function<void(HapticLoop& loop, std::int64_t periods)> before_tick;
  /// Called after each tick with the time since the last tick, for example to move a simulated device.
  std::function<void(HapticLoop& loop, double dt_s)> after_tick;
  /// Carries out a request made by call(), with its code.
  std::function<void(HapticLoop& loop, std::int32_t code)> on_call;
};

/// Owns the loop. One thread makes the requests (grasp to call); any thread may read the statistics. The
/// report of the last tick is in CouplingPort::haptic.
class VPS_DEVICE_API RealTimeLoop {
 public:
  /// device, port and settings.events outlive the loop. settings.period_s gives the rate.
  RealTimeLoop(Device& device, CouplingPort& port, const LoopSettings& settings,
               const RealTimeSettings& real_time = {});
  ~RealTimeLoop();

  /// Starts the loop's thread. The report and settings.events list the requests (real-time priority, locked
  /// memory) that the operating system refused. Throws as
  /// PeriodicThread::start() does.
  RealTimeReport start();
  /// Stops the loop's thread and sets the wrench to zero. A held part stays held, for the next start().
  void stop();
  [[nodiscard]] bool isRunning() const noexcept { return thread_.isRunning(); }

  /// Each of these functions requests a call of the function of the same name in HapticLoop. False if the
  /// ring is full: the loop does not run, or is far behind.
  bool grasp(const Pose& X_WG) noexcept { return post({Request::Grasp, X_WG}); }
  bool handOver(const Pose& X_WG) noexcept { return post({Request::HandOver, X_WG}); }
  bool disengage() noexcept { return post({Request::Disengage}); }
  bool engage() noexcept { return post({Request::Engage}); }
  bool release() noexcept { return post({Request::Release}); }
  bool rearm() noexcept { return post({Request::Rearm}); }
  bool setGains(const CouplingGains& gains) noexcept { return post({Request::Gains, {}, gains}); }
  /// RealTimeSettings::on_call is called with this code.
  bool call(std::int32_t code) noexcept { return post({Request::Call, {}, {}, code}); }
  /// True while a request is not yet carried out. Once the result is false, all that the loop's thread wrote
  /// while it carried the requests out is visible to the caller.
  [[nodiscard]] bool hasOpenRequests() const noexcept {
    return posted_.load(std::memory_order_acquire) != handled_.load(std::memory_order_acquire);
  }
  /// Carries out open requests while the loop does not run.
  void handleRequests() noexcept;

  [[nodiscard]] const TickStatistics& statistics() const noexcept { return statistics_; }

  /// The loop. Call this function only while the loop is not running.
  [[nodiscard]] HapticLoop& loop() noexcept { return loop_; }
  /// Runs one period, for a driver that replaces the thread; only while the loop is not running. Never
  /// throws, allocates or locks.
  void beat(const Beat& beat) noexcept;

 private:
  struct Request {
    enum Kind : std::uint8_t {
      Grasp,
      HandOver,
      Disengage,
      Engage,
      Release,
      Rearm,
      Gains,
      Call
    } kind = Release;
    Pose X_WG = {};
    CouplingGains gains = {};
    std::int32_t code = 0;
  };
  bool post(const Request& request) noexcept;
  void handle(const Request& request) noexcept;
  void reportMisses(const Beat& beat) noexcept;
  void reportRefusals() noexcept;

  static constexpr std::size_t kRequests = 64;

  RealTimeSettings settings_;
  RealTimeClock* clock_;
  DeviceEventQueue* events_;
  TimedDevice device_;
  HapticLoop loop_;
  PeriodicThread thread_;
  TickStatistics statistics_;
  TickTiming timing_before_;
  std::array<Request, kRequests> requests_{};
  std::atomic<std::size_t> posted_{0}, handled_{0};
  std::atomic<bool> lacks_priority_{false},
      lacks_locking_{false};      ///< refusals that the loop's thread has to report
  std::int64_t quiet_ticks_ = 0;  ///< ticks until misses are reported again
};

}  // namespace vps::device
