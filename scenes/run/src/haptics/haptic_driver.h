// SPDX-License-Identifier: BSD-3-Clause
// Device, hand and haptic loop of a run. Three implementations: lockstep (simulated time, the caller's
// thread), real time (a thread of its own) and the replay of a real-time run.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptics/hand.h"
#include "vps_device/device.h"
#include "vps_device/loop.h"
#include "vps_device/run_log.h"
#include "vps_scenes/run/result.h"

namespace vps::scenes {

/// Commands and state exchange between a procedure and its haptic loop, called from the physics thread. In
/// lockstep the haptic loop runs inside advance(); in real time it runs from resume() to pause(), also while
/// commands are given.
class HapticDriver {
 public:
  virtual ~HapticDriver() = default;
  virtual void pause() = 0;
  /// Starts the loop of a run in real time. If the loop runs already, resume() only clears a safety fault, as
  /// a person would between steps.
  virtual void resume() = 0;
  [[nodiscard]] virtual const device::LoopSettings& settings() const = 0;

  /// Hands over the part whose grasp frame is at X_WG now; the clutch begins to close. No force acts before a
  /// coupled part is published.
  virtual void handOver(const Pose& X_WG) = 0;
  /// The clutch starts to open or to close; last().clutch_ratio shows the progress.
  virtual void openClutch() = 0;
  virtual void closeClutch() = 0;
  /// The hand begins a step; when this returns, phase() is already the phase of that step.
  virtual void begin(const device::OperatorTask& task, std::size_t step, double now_s) = 0;
  virtual void letGo() = 0;
  /// These functions move the free hand as the functions of Hand with the same names; the motion has begun
  /// when they return.
  virtual void goBack(std::size_t next) = 0;
  virtual void recentre() = 0;
  virtual void goOn() = 0;

  /// Proceeds until the next physics step is due: a driver in lockstep runs that step's ticks, a driver in
  /// real time waits. If the hand cannot continue, returns false without any effect.
  [[nodiscard]] virtual bool advance() = 0;
  /// The proxy after advance(), for the physics step.
  virtual const CouplingState& proxy() = 0;
  /// Publishes the state after the physics step. This function sets state.step. state.stored_J is set while a
  /// part is held.
  virtual void publish(const device::PhysicsState& state) = 0;
  /// Whether background work is ready: `is_ready`, or in a replay the recorded answer.
  virtual bool hasSettled(bool is_ready) { return is_ready; }
  /// Called after advance(): whether axis snap acts in the coming physics step: `is_wanted`, or in a replay
  /// the recorded answer.
  virtual bool snaps(bool is_wanted) { return is_wanted; }
  /// Called after advance(): whether the part is released on request: `is_wanted`, or in a replay the
  /// recorded answer.
  virtual bool givesUp(bool is_wanted) { return is_wanted; }
  /// Sets the gains from the next part on, also in settings(). setGains() is not allowed in a recorded run.
  virtual void setGains(const CouplingGains& /*gains*/) {}
  /// Time the caller spent between the last two calls of advance(); 0 in lockstep.
  [[nodiscard]] virtual double busy_s() const { return 0; }
  /// In real time, from the next advance() on, a physics step of step_s of simulated time is due in each
  /// period_s of real time, and the coupling has the given gains. settings() does not change.
  virtual void setLoadLevel(double /*step_s*/, double /*period_s*/, const CouplingGains& /*gains*/) {}

  /// State of the hand.
  [[nodiscard]] virtual device::OperatorState state() = 0;
  [[nodiscard]] device::OperatorPhase phase() { return state().phase; }
  /// Report of the last tick.
  [[nodiscard]] virtual const device::TickReport& last() = 0;
  /// Haptic periods without a tick so far; 0 in lockstep.
  [[nodiscard]] virtual std::uint64_t missed() = 0;
  /// Whether time advances while the physics thread does other work (real time).
  [[nodiscard]] virtual bool isByClock() const = 0;
  [[nodiscard]] virtual device::PassivityObserver passivity() = 0;
  [[nodiscard]] virtual TickTimes times() = 0;
  /// Passes on the events that the loop reported since the last call; called by the physics thread.
  virtual void passEvents(const std::function<void(const device::DeviceEvent&)>& /*to*/) {}
  /// Timing results of a run in real time; empty in other runs.
  [[nodiscard]] virtual std::optional<RealTimeResult> realTime() = 0;
};

/// @param device  the hand's device, or a tap on it; all arguments must outlive the driver
std::unique_ptr<HapticDriver> makeLockstepDriver(Hand& hand, device::Device& device,
                                                 device::CouplingPort& port,
                                                 const device::LoopSettings& settings, int ticks_per_step,
                                                 const ReportFault& report);
/// @param physics_s  period of physics
/// @param log        may be null; receives from the physics thread the entries that a replay needs
std::unique_ptr<HapticDriver> makeRealTimeDriver(Hand& hand, device::CouplingPort& port,
                                                 const device::LoopSettings& settings, double physics_s,
                                                 const ReportFault& report, device::RunLog* log);
/// Repeats a run of makeRealTimeDriver() in simulated time.
/// @param events    the recorded events
/// @param device    the recording, as the inner device of a TappedDevice
/// @param settings  settings of the recorded loop; physics_limit_s as recorded, otherwise physicsLimit_s()
std::unique_ptr<HapticDriver> makeReplayedDriver(Hand& hand, std::vector<RecordedEvent> events,
                                                 device::Device& device, device::CouplingPort& port,
                                                 const device::LoopSettings& settings,
                                                 const ReportFault& report, device::RunLog& log);
/// Greatest age of a physics state in real time.
double physicsLimit_s(double physics_s);

}  // namespace vps::scenes
