// SPDX-License-Identifier: BSD-3-Clause
// Device, hand and haptic loop of a run, in one of two drivers: simulated time on the caller's thread, or
// real time on a thread of its own.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "hand.h"
#include "vps_device/loop.h"
#include "vps_scenes/result.h"

namespace vps {

/// What a procedure asks of it, from the physics thread. Between pause() and resume() the loop stands still,
/// and hand() and loop() may be used; in lockstep always.
class HapticSide {
 public:
  virtual ~HapticSide() = default;
  virtual void pause() = 0;
  virtual void resume() = 0;
  virtual Hand& hand() = 0;
  virtual HapticLoop& loop() = 0;

  /// Until the next physics step is due: lockstep does that step's ticks, real time waits. Afterwards the
  /// port has the proxy to step with. False, and nothing done, where the hand cannot go on.
  /// @param part  in hand, as it is now
  [[nodiscard]] virtual bool advance(const HeldPart& part) = 0;
  virtual void noteStored(double stored_J, double actuator_J) = 0;

  [[nodiscard]] virtual OperatorPhase phase() = 0;
  /// As of the last tick.
  [[nodiscard]] virtual const TickReport& last() = 0;
  [[nodiscard]] virtual HandLedger ledger() = 0;
  [[nodiscard]] virtual TickTimes times() = 0;
  /// What only real time has.
  [[nodiscard]] virtual std::optional<RealTimeResult> realTime() = 0;
};

/// Told of each fault of safety, in words.
using TellFault = std::function<void(const std::string&)>;

/// @param device  the hand's own, or a tap on it; all outlive the side
std::unique_ptr<HapticSide> lockstepSide(Hand& hand, Device& device, CouplingPort& port,
                                         const LoopSettings& settings, int ticks_per_step,
                                         const TellFault& tell);
/// @param physics_s  period of physics
std::unique_ptr<HapticSide> realTimeSide(Hand& hand, CouplingPort& port, const LoopSettings& settings,
                                         double physics_s, const TellFault& tell);

}  // namespace vps
