// SPDX-License-Identifier: BSD-3-Clause
// One haptic tick: device -> proxy -> coupling -> safety -> device, and the energy that passes the hand.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "vps_device/coupling_port.h"
#include "vps_device/device.h"
#include "vps_device/export.h"
#include "vps_device/local_contact.h"
#include "vps_device/safety.h"
#include "vps_device/simulated_device.h"
#include "vps_device/workspace_map.h"

namespace vps::device {

struct LoopSettings {
  CouplingGains gains;
  WorkspaceMap map;
  /// The map is calibrated: it gives the true place of the device. From grasping on, the grasp frame's origin
  /// is at the handle, so that the part is seen where the hand is. A part must be handed over only where the
  /// handle is.
  bool is_collocated = false;
  SafetyLimits safety;
  double period_s = 1e-3;
  /// Extrapolate the part by its velocity from its time stamp, for up to hold_limit_s.
  bool extrapolates_part = false;
  double hold_limit_s = 2e-3;
  /// Above this rise of the energy balance the passivity controller adds damping. assumed: 5 N over 0.2 mm
  double injected_bound_J = 1e-3;
  bool has_passivity_controller = true;  ///< active once stored energy is observed
  double clutch_s = 0.1;  ///< duration of opening and closing the clutch. assumed: longer than a startle
  /// Limit on the time for which the state of a held part (by its time stamp) may stay the same; a longer
  /// time is a fault. 0: never a fault, as in lockstep, where physics cannot fall behind. RealTimeLoop
  /// defaults to 0.1 s.
  double physics_limit_s = 0;
  LocalContact* local = nullptr;       ///< predicts the part between physics states; may be null
  DeviceEventQueue* events = nullptr;  ///< receives safety faults, from the loop's thread; may be null
};

/// The haptic loop, owned by the haptic thread or by a lockstep driver. tick() never throws, allocates, locks
/// or waits.
class VPS_DEVICE_API HapticLoop {
 public:
  /// device and port outlive the loop.
  HapticLoop(Device& device, CouplingPort& port, const LoopSettings& settings);

  /// Grasps a part whose grasp frame is at X_WG now; no force arises. The physics side must publish
  /// is_coupled on the port before any force flows.
  void grasp(const Pose& X_WG) noexcept;
  /// Releases the part: the proxy is still published, uncoupled.
  void release() noexcept;

  /// Opens the clutch over clutch_s: the hand comes free while the proxy stands still and holds the part. A
  /// device smaller than the scene needs an open clutch to reach farther (indexing). Opening the clutch also
  /// precedes release() where force would otherwise jump.
  void disengage() noexcept { clutch_.open(); }
  /// Closes the clutch over clutch_s: the hand holds the part again, from wherever the handle is now.
  void engage() noexcept { clutch_.close(); }
  [[nodiscard]] const Clutch& clutch() const noexcept { return clutch_; }
  /// Changes parts: grasps the part whose grasp frame is at X_WG with the clutch open, then closes the
  /// clutch. No force jumps if the clutch was open before and nothing else holds that part. The energy in the
  /// springs to the previous part is lost.
  void handOver(const Pose& X_WG) noexcept;
  /// Clears a safety fault. If a part is held, it is grasped again at its last received pose.
  void rearm() noexcept;

  /// One tick of one period: receivePart() and tickWithReceivedPart().
  const TickReport& tick() noexcept { return tick(settings_.period_s); }
  /// One tick, dt_s after the last tick: a driver that missed periods passes the longer time. dt_s counts as
  /// one to four periods, so that the force never jumps after a pause.
  const TickReport& tick(double dt_s) noexcept;

  /// Takes the latest PhysicsState from the port; the next tick uses it. If the state is of a new step,
  /// compares its stored energy with the work on the hand until the tick whose proxy that step answers: over
  /// a network that tick is a round trip ago, and the motion since then would count as energy. receivePart()
  /// is separate from the tick, so that a recording can note which state a tick used.
  void receivePart() noexcept;
  /// Does the rest of tick(), with the state that receivePart() took.
  /// @return  Status of the device, or Fault while safety holds the force at zero
  const TickReport& tickWithReceivedPart(double dt_s) noexcept;
  [[nodiscard]] const PhysicsState& received() const noexcept { return received_; }

  /// Sets other gains from the next tick on, for example when physics changes its rate. Softer gains take
  /// energy out of the springs, stiffer gains add energy: set stiffer gains only while nothing is held.
  /// Unusable gains are a fault, as in the constructor.
  void setGains(const CouplingGains& gains) noexcept;

  /// Latches a fault that a driver has found; rearm() clears it.
  void latchFault(SafetyFault fault) noexcept;

  /// Observes the energy stored in the scene now (kinetic, gravity, springs, contact) and the work done so
  /// far by actuators other than the hand, both in scene joules. Call once per physics step, from the loop's
  /// thread, with the handle where the last tick read it. A driver that publishes PhysicsState::stored_J does
  /// not need this call.
  void observeStoredEnergy(double stored_J, double actuator_J) noexcept;

  [[nodiscard]] bool isHolding() const noexcept { return is_holding_; }
  [[nodiscard]] const TickReport& last() const noexcept { return report_; }
  [[nodiscard]] const PassivityObserver& passivity() const noexcept { return passivity_; }
  [[nodiscard]] const SafetyState& safety() const noexcept { return guard_.state(); }
  [[nodiscard]] const LoopSettings& settings() const noexcept { return settings_; }
  /// The state that a tick would publish now; it includes changes since the last tick.
  [[nodiscard]] HapticState state() const noexcept;
  /// Number of ticks that ended with this status.
  [[nodiscard]] std::uint64_t count(Status status) const noexcept;
  [[nodiscard]] std::uint64_t ticks() const noexcept { return ticks_; }
  /// Time for which the part's state has stayed the same, counted in ticks.
  [[nodiscard]] double snapshotAge_s() const noexcept { return snapshot_age_s_; }

  /// Convert a handle pose in D to the grasp frame, and a hand's impedance about G in W to the impedance
  /// about H in D. These functions connect a VirtualOperator to a SimulatedDevice.
  [[nodiscard]] Pose toGrasp(const Pose& X_DH) const noexcept;
  [[nodiscard]] HandForce toDevice(const HandForce& hand_W) const noexcept;

 private:
  [[nodiscard]] Wrench coupling(const CouplingState& proxy, double dt_s) noexcept;
  [[nodiscard]] Wrench passivityDamping(const Twist& V_DH) const noexcept;
  [[nodiscard]] Twist stepSince(const DeviceSample& sample) const noexcept;
  void moveProxy(const Twist& step_D, const Pose& X_DH) noexcept;
  void accountEnergy(const DeviceSample& sample, const Twist& step_D) noexcept;
  void keepWork(double time_s) noexcept;
  [[nodiscard]] double workAt_J(double time_s) const noexcept;
  void balance(double work_J, double stored_J, double actuator_J) noexcept;
  void accountQuantisation(const Wrench& F_acting_D) noexcept;
  [[nodiscard]] Wrench actingWrench() const noexcept;
  void watchPhysics(double dt_s) noexcept;
  void reportFault() noexcept;

  static constexpr std::size_t kStatusCount = 8;
  static constexpr std::size_t kMaxDelay = 14;  ///< device's own delay that the accounting can follow [ticks]

  Device* device_;
  CouplingPort* port_;
  LoopSettings settings_;
  DeviceLimits limits_;
  SafetyGuard guard_;
  PhysicsState received_;
  /// Damping of the device that the coupling leaves: b - K T/2 - B, with the period T.
  double spare_Ns_per_m_ = 0, spare_Nms_per_rad_ = 0;
  Grasp grasp_;
  Clutch clutch_;
  bool is_holding_ = false;
  TickReport report_;
  PassivityObserver passivity_;
  Pose X_DH_before_;
  bool has_before_ = false;
  std::array<Wrench, kMaxDelay + 2> F_written_D_{};         ///< newest first
  double delay_ticks_ = 0;                                  ///< delay of the device itself
  Wrench F_accounted_D_;                                    ///< wrench used by the last accountEnergy()
  double force_variation_N_ = 0, torque_variation_Nm_ = 0;  ///< sums of the changes of F_accounted_D_
  double net_scene_J_ = 0, balance_start_J_ = 0;            // scene joules
  /// Energy that passed the hand until a tick, less the device's own dissipation.
  struct Work {
    double time_s = 0;  ///< time of the tick's sample
    double scene_J = 0;
  };
  /// Work until each of the last ticks, at index tick number modulo the size.
  std::array<Work, 512> works_{};
  bool has_stored_ = false;
  double snapshot_age_s_ = 0, snapshot_time_s_ = 0;
  std::uint64_t reported_faults_ = 0;
  std::uint64_t ticks_ = 0;
  std::array<std::uint64_t, kStatusCount> counts_{};
};

}  // namespace vps::device
