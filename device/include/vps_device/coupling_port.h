// SPDX-License-Identifier: BSD-3-Clause
// Exchange of state between the haptic thread and the physics thread: one stamped state in each direction.
//
//   haptic thread:   HapticLoop::tick()  -- HapticState, after each tick -->  physics thread
//   physics thread:  one step            -- PhysicsState, after each step --> haptic thread
#pragma once

#include <cstdint>
#include <optional>

#include "vps/coupling_law.h"
#include "vps/triple_buffer.h"
#include "vps_device/export.h"
#include "vps_device/safety.h"

namespace vps::device {

/// Result of one tick of the haptic loop.
struct TickReport {
  double time_s = 0;
  Status status = Status::Ok;
  Pose X_WG;  ///< proxy
  Twist V_WG;
  Wrench F_hand_W;          ///< wrench on the hand, after safety, in W about the handle's origin
  Wrench F_hand_D;          ///< the wrench that was written to the device, in D about the handle's origin
  double clutch_ratio = 1;  ///< ratio of the clutch after the tick: 0 open, 1 closed
};

/// Energy that passes the hand [J]. The device's work on the hand is the acting force (delayed as the
/// device's limits state, and held for a period) times the handle's displacement.
///
/// The balance is net work - dissipation - decrease of stored energy - actuator work. If device, coupling and
/// scene generate no energy, the balance never rises; friction of contacts and the coupling's damper decrease
/// it. The greatest rise of the balance above its least value so far is therefore the most energy that was
/// generated, net of dissipation, in any interval. Energy dissipated early does not compensate energy
/// generated later.
struct PassivityObserver {
  double to_hand_J = 0;     ///< sum of the positive works
  double from_hand_J = 0;   ///< sum of the negative works, as a positive number
  double dissipated_J = 0;  ///< dissipation by the device's least damping over the handle's displacements
  double balance_J =
      0;  ///< balance at the last observation of stored energy, in scene joules; 0 at the first observation
  double least_J = 0;     ///< the least balance so far
  double injected_J = 0;  ///< greatest rise of the balance above its least value until then
  /// Upper bound of the error of injected_J that the encoders' resolution allows, in scene joules. With
  /// readings off by at most e, summation by parts bounds the sum of F . (change of e) by e times (the total
  /// variation of F, plus its present magnitude). The bound is a worst case: every error has the worst sign.
  double quantisation_error_bound_J = 0;

  /// How far the balance is above its least value now.
  [[nodiscard]] double rise_J() const noexcept { return balance_J - least_J; }
};

/// State that the haptic side publishes after each tick.
struct HapticState {
  CouplingState proxy;
  std::int32_t tick = 0;  ///< number of ticks so far, including this one
  TickReport report;
  SafetyState safety;
  PassivityObserver passivity;
};

/// True state of the held part P, for example for a virtual operator.
struct HeldPart {
  Pose X_WP;
  Twist V_WP;
  Vec3 weight_W = Vec3::Zero();  ///< [N]
};

/// State that the physics side publishes after each step.
struct PhysicsState {
  CouplingState part;
  std::int32_t step = 0;  ///< number of states published so far, including this one
  /// Energy stored in the scene (kinetic, gravity, springs, contact), in scene joules. The loop observes this
  /// energy once per `step`; empty if the energy is not known, for example while nothing is held.
  std::optional<double> stored_J;
  HeldPart held;
};

/// Interface to physics in another process, which replaces CouplingPort::physics. The haptic thread calls
/// this interface, so an implementation must not throw, allocate, lock or wait.
class VPS_DEVICE_API RemotePhysics {
 public:
  virtual ~RemotePhysics() = default;
  /// Replaces `state` by the newest state, if a new one has arrived since the last call.
  virtual void receive(PhysicsState& state) noexcept = 0;
  /// Sends the state after a tick.
  virtual void send(const HapticState& state) noexcept = 0;

 protected:
  RemotePhysics() = default;
  RemotePhysics(const RemotePhysics&) = default;
  RemotePhysics& operator=(const RemotePhysics&) = default;
};

/// The haptic side and the physics side read each other's latest state without waiting. Each buffer has one
/// writer and one reader.
struct CouplingPort {
  TripleBuffer<HapticState> haptic;    ///< written by the haptic thread
  TripleBuffer<PhysicsState> physics;  ///< written by the physics thread; not used with `remote`
  RemotePhysics* remote = nullptr;     ///< null: physics is in this process
};

}  // namespace vps::device
