// SPDX-License-Identifier: BSD-3-Clause
// The haptic loop in real time: a thread of its own beats, each beat is HapticLoop::tick(), as in lockstep.
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

  /// Nanoseconds in the device since the last call.
  std::int64_t takeSpent_ns() noexcept;

 private:
  Device* device_;
  RealTimeClock* clock_;
  std::int64_t spent_ns_ = 0;
};

struct RealTimeSettings {
  int priority = 80;  ///< SCHED_FIFO; 0: none. assumed: above interrupt threads (50), below the kernel's
  bool locks_memory = true;
  double physics_limit_s = 0.1;    ///< LoopSettings::physics_limit_s where that says 0. assumed: ten steps of
                                   ///< 100 Hz physics, and sooner than a person notices a part that hangs
  double stale_s = 2e-3;           ///< ticks with an older snapshot are counted
  RealTimeClock* clock = nullptr;  ///< null: the system's
  /// Called before each tick, by the loop's thread: the last moment to tell the loop something. periods: as
  /// the clock counts them since the last tick. Must not allocate, lock, throw or wait.
  std::function<void(HapticLoop& loop, std::int64_t periods)> before;
  /// Called after each tick, by the loop's thread, with what has passed since the last: a simulated device's
  /// own motion. As the tick, it must not allocate, lock, throw or wait.
  std::function<void(HapticLoop& loop, double dt_s)> beside;
};

/// Owns the loop. The one that commands it (grasp to rearm, observeStoredEnergy) is one thread; requests are
/// done at the start of the next tick. Statistics are read by any thread, latest() by one.
class VPS_DEVICE_API RealTimeLoop {
 public:
  /// device, port and settings.events outlive the loop. settings.period_s is the rate.
  RealTimeLoop(Device& device, CouplingPort& port, const LoopSettings& settings,
               const RealTimeSettings& real_time = {});
  ~RealTimeLoop();

  /// What the system refused is in the report, and in settings.events. Throws as PeriodicThread::start().
  RealTimeReport start();
  /// The wrench is zero afterwards; what is held stays held, for the next start().
  void stop();
  [[nodiscard]] bool isRunning() const noexcept { return thread_.isRunning(); }
  /// True while something that was asked for waits for its tick.
  [[nodiscard]] bool hasOpenRequests() const noexcept { return asked_.load() != answered_.load(); }

  /// As HapticLoop's. False if there is no room for the request: the loop does not run, or is far behind.
  bool grasp(const Pose& X_WG) noexcept;
  bool handOver(const Pose& X_WG) noexcept;
  bool disengage() noexcept;
  bool engage() noexcept;
  bool release() noexcept;
  bool rearm() noexcept;
  bool setGains(const CouplingGains& gains) noexcept;
  void observeStoredEnergy(double stored_J, double actuator_J) noexcept {
    energies_.write({stored_J, actuator_J, true});
  }

  /// What the last tick did, and how safety stands.
  struct Latest {
    TickReport report;
    SafetyState safety;
    PassivityObserver ledger;
    bool is_holding = false;
  };
  const Latest& latest() noexcept { return latest_.read(); }
  [[nodiscard]] const TickStatistics& statistics() const noexcept { return statistics_; }

  /// The loop itself, while not running.
  [[nodiscard]] HapticLoop& loop() noexcept { return loop_; }
  /// One beat, by a driver of one's own, while not running. Never throws, allocates, locks.
  void beat(const Beat& beat) noexcept;

 private:
  struct Request {
    enum Kind : std::uint8_t { Grasp, HandOver, Disengage, Engage, Release, Rearm, Gains } kind = Release;
    Pose X_WG;
    CouplingGains gains{};
  };
  struct Energies {
    double stored_J = 0, actuator_J = 0;
    bool is_told = false;
  };
  bool ask(const Request& request) noexcept;
  void answer(const Request& request) noexcept;
  void answerRequests() noexcept;
  void tellMisses(const Beat& beat) noexcept;
  void tellRefusals() noexcept;

  static constexpr std::size_t kRequests = 64;

  RealTimeSettings settings_;
  RealTimeClock* clock_;
  DeviceEventQueue* events_;
  TimedDevice device_;
  HapticLoop loop_;
  PeriodicThread thread_;
  TickStatistics statistics_;
  TickTiming before_;
  TripleBuffer<Latest> latest_;
  TripleBuffer<Energies> energies_;
  std::array<Request, kRequests> requests_{};
  std::atomic<std::size_t> asked_{0}, answered_{0};
  std::atomic<bool> lacks_priority_{false}, lacks_locking_{false};  ///< to be told by the loop's thread
  std::int64_t quiet_ticks_ = 0;  ///< still to go before misses are told again
};

}  // namespace vps::device
