// SPDX-License-Identifier: BSD-3-Clause
// Device, hand and haptic loop of a run, in one of two drivers: simulated time on the caller's thread, or
// real time on a thread of its own.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "haptics/hand.h"
#include "vps_device/loop.h"
#include "vps_device/run_log.h"
#include "vps_scenes/result.h"

namespace vps::scenes {

/// What a procedure asks of it, from the physics thread. In lockstep it runs while advance() does; in real
/// time from resume() to pause(), through all that is asked of it meanwhile.
class HapticDriver {
 public:
  virtual ~HapticDriver() = default;
  virtual void pause() = 0;
  /// Does nothing but clear a safety fault, as a person does between steps, where it runs already.
  virtual void resume() = 0;
  [[nodiscard]] virtual const device::LoopSettings& settings() const = 0;

  /// The part whose grasp frame is at X_WG now; the clutch begins to close. No force flows before the port
  /// says that it is coupled.
  virtual void handOver(const Pose& X_WG) = 0;
  /// Begin to; last().clutch_ratio says how far it is.
  virtual void openClutch() = 0;
  virtual void closeClutch() = 0;
  /// The hand begins a step; when this returns, phase() is that of the step.
  virtual void begin(const device::OperatorTask& task, std::size_t step, double now_s) = 0;
  virtual void letGo() = 0;
  /// The free hand, as Hand's; when one returns, the hand has begun.
  virtual void goBack(std::size_t next) = 0;
  virtual void recentre() = 0;
  virtual void goOn() = 0;

  /// Until the next physics step is due: lockstep does that step's ticks, real time waits. False, and nothing
  /// done, where the hand cannot go on.
  /// @param part  in hand, as it is now
  [[nodiscard]] virtual bool advance(const HeldPart& part) = 0;
  /// The proxy that advance() left, to step with.
  virtual const CouplingState& proxy() = 0;
  /// The part after that step, and, while it is held, the energy stored in the scene.
  virtual void publish(const CouplingState& part, std::optional<double> stored_J) = 0;
  /// Whether what is done beside the run is ready: as the caller says, or as it was in a run done again.
  virtual bool hasSettled(bool is_ready) { return is_ready; }
  /// What the caller did between the last two of these; 0 in lockstep.
  [[nodiscard]] virtual double busy_s() const { return 0; }
  /// From the next advance() on, where it goes by the clock: steps of step_s of simulated time, one each
  /// period_s of the clock's, and other gains. settings() stays what was asked.
  virtual void setLoadLevel(double /*step_s*/, double /*period_s*/, const CouplingGains& /*gains*/) {}

  [[nodiscard]] virtual device::OperatorPhase phase() = 0;
  /// As of the last tick.
  [[nodiscard]] virtual const device::TickReport& last() = 0;
  /// Haptic periods that had no tick so far; 0 in lockstep.
  [[nodiscard]] virtual std::uint64_t missed() = 0;
  /// Whether time goes on while the physics thread does other things.
  [[nodiscard]] virtual bool isByClock() const = 0;
  [[nodiscard]] virtual device::PassivityObserver ledger() = 0;
  [[nodiscard]] virtual TickTimes times() = 0;
  /// What only real time has.
  [[nodiscard]] virtual std::optional<RealTimeResult> realTime() = 0;
};

/// Told of each fault of safety, in words.
using TellFault = std::function<void(const std::string&)>;

/// @param device  the hand's own, or a tap on it; all outlive the side
std::unique_ptr<HapticDriver> makeLockstepDriver(Hand& hand, device::Device& device, CouplingPort& port,
                                                 const device::LoopSettings& settings, int ticks_per_step,
                                                 const TellFault& tell);
/// @param physics_s  period of physics
/// @param log        may be null; told by the physics thread what a replay needs
std::unique_ptr<HapticDriver> makeRealTimeDriver(Hand& hand, CouplingPort& port,
                                                 const device::LoopSettings& settings, double physics_s,
                                                 const TellFault& tell, device::RunLog* log);
/// A run of makeRealTimeDriver's again, in simulated time.
/// @param sync_events  as recorded
/// @param device    the recording, tapped
/// @param settings  as the loop's then, with physicsLimit_s()
std::unique_ptr<HapticDriver> makeReplayedDriver(Hand& hand, std::vector<device::SyncEvent> sync_events,
                                                 device::Device& device, CouplingPort& port,
                                                 const device::LoopSettings& settings, const TellFault& tell,
                                                 device::RunLog& log);
/// How old a snapshot may be, by the clock.
double physicsLimit_s(double physics_s);

}  // namespace vps::scenes
