// SPDX-License-Identifier: BSD-3-Clause
// One haptic tick: device -> proxy -> coupling -> safety -> device, and the energy that passes the hand.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "vps/coupling_law.h"
#include "vps_device/clutch.h"
#include "vps_device/device.h"
#include "vps_device/device_events.h"
#include "vps_device/export.h"
#include "vps_device/hand_force.h"
#include "vps_device/local_contact.h"
#include "vps_device/safety.h"

namespace vps::device {

/// How the device's space lies in the scene: p_W = X_WD (scale p_D). Forces on the hand are force_scale times
/// the scene's. Powers then differ by scale / force_scale; the ledger is kept at the hand.
struct VPS_DEVICE_API WorkspaceMap {
  Pose X_WD;
  double scale = 1;        ///< scene metres per device metre, > 0
  double force_scale = 1;  ///< device newtons per scene newton, > 0

  [[nodiscard]] Pose toScene(const Pose& X_DH) const noexcept;
  [[nodiscard]] Pose toDevice(const Pose& X_WH) const noexcept;
  [[nodiscard]] Twist toScene(const Twist& V_D) const noexcept;
  [[nodiscard]] Twist toDevice(const Twist& V_W) const noexcept;
  [[nodiscard]] Wrench toScene(const Wrench& F_D) const noexcept;
  [[nodiscard]] Wrench toDevice(const Wrench& F_W) const noexcept;
};

/// How the hand holds the part: the grasp frame G moves with the handle by an offset that is fixed when
/// grasping, so that grasping anywhere, at any attitude, gives no force. Handle turns turn G about its own
/// origin:
///   p_WG = p_WH + offset_W,   R_WG = R_WH R_HG,   hence equal twists, and wrenches pass unchanged.
struct VPS_DEVICE_API Grasp {
  Vec3 offset_W = Vec3::Zero();
  Mat3 R_HG = Mat3::Identity();

  static Grasp between(const Pose& X_WH, const Pose& X_WG) noexcept;
  [[nodiscard]] Pose toGrasp(const Pose& X_WH) const noexcept;
  [[nodiscard]] Pose toHandle(const Pose& X_WG) const noexcept;
};

/// Energy at the hand [J]. The device's work on the hand is the force that acts, so late as the device's
/// limits say and held for a period, times handle displacement.
///
/// The balance is net work - dissipation - fall in stored energy - actuator work. Where device, coupling and
/// scene make no energy it never rises: friction of contacts and the coupling's damper let it fall. So its
/// greatest rise above its own least value so far is the most energy that was made, net of what was taken up
/// meanwhile, in any stretch of time, whatever was dissipated before: nothing saved up early pays for it.
struct VPS_DEVICE_API PassivityObserver {
  double to_hand_J = 0;     ///< sum of the positive works
  double from_hand_J = 0;   ///< sum of the negative works, as a positive number
  double dissipated_J = 0;  ///< by the device's own least damping over the same displacements
  double balance_J = 0;     ///< when stored energy was last noted, in scene joules; 0 the first time
  double least_J = 0;       ///< the least balance so far
  double injected_J = 0;    ///< greatest rise of the balance above its least value before
  /// What the encoders may have kept from injected_J, at the most, in scene joules: with a reading off by e,
  /// the sum of F . change of e is, summed by parts, at most the greatest e times (the way that F has gone,
  /// up and down, + F now). Of DeviceLimits::resolution alone, and wide: as if each error were the worst.
  double quantisation_error_bound_J = 0;

  /// What it has risen by now.
  [[nodiscard]] double rise_J() const noexcept { return balance_J - least_J; }
};

struct LoopSettings {
  CouplingGains gains;
  WorkspaceMap map;
  SafetyLimits safety;
  double period_s = 1e-3;
  bool extrapolates_part =
      false;  ///< advance the part by its velocity since its time stamp, up to hold_limit_s
  double hold_limit_s = 2e-3;
  double injected_bound_J =
      1e-3;  ///< of rise; above it the passivity controller adds damping. assumed: 5 N over 0.2 mm
  bool has_passivity_controller = true;  ///< works once observeStoredEnergy() is called
  double clutch_s = 0.1;                 ///< hold and let go take so long. assumed: a startle takes longer
  /// A part in hand whose snapshot (by its time stamp) stays the same for longer is a fault. 0: never, as in
  /// lockstep, where physics cannot fall behind. Real time has 0.1 s: see real_time_loop.h.
  double physics_limit_s = 0;
  LocalContact* local = nullptr;       ///< tells where the part is between snapshots; null: where they say
  DeviceEventQueue* events = nullptr;  ///< told of safety's faults, by the loop's thread; may be null
};

/// What one tick did.
struct TickReport {
  double time_s = 0;
  Status status = Status::Ok;
  Pose X_WG;  ///< proxy
  Twist V_WG;
  Wrench F_hand_W;          ///< on the hand, after safety, in W about the handle's origin
  Wrench F_hand_D;          ///< the same as written to the device
  double clutch_ratio = 1;  ///< of the clutch after the tick: 0 open, 1 closed
};

/// Owned by the haptic thread (or the lockstep driver). tick() never throws, allocates, locks or waits.
class VPS_DEVICE_API HapticLoop {
 public:
  /// device and port outlive the loop.
  HapticLoop(Device& device, CouplingPort& port, const LoopSettings& settings);

  /// Takes hold of a part whose grasp frame is at X_WG now: no force arises by it. The physics side must
  /// publish is_coupled on the port before any force flows.
  void grasp(const Pose& X_WG) noexcept;
  /// Lets go: the proxy stays published, uncoupled.
  void release() noexcept;

  /// Opens the clutch over clutch_s: the hand comes free while the proxy stands and holds the part. What a
  /// device smaller than the scene needs to reach farther (a ratchet), and what comes before release() where
  /// force would jump.
  void disengage() noexcept { clutch_.open(); }
  /// Closes it over clutch_s: the hand has what it held again, from wherever it now is.
  void engage() noexcept { clutch_.close(); }
  [[nodiscard]] const Clutch& clutch() const noexcept { return clutch_; }
  /// From one part to another: takes hold of one whose grasp frame is at X_WG, as grasp(), with the clutch
  /// open, and closes it. Nothing jumps if the clutch was open before and nobody else holds that part; the
  /// springs to the part before give their energy to nobody.
  void handOver(const Pose& X_WG) noexcept;
  /// Clears a safety fault and, if a part is held, re-grasps it where the physics side last saw it.
  void rearm() noexcept;

  /// One tick. Status of the device, or Fault while safety holds the force at zero.
  const TickReport& tick() noexcept { return tick(settings_.period_s); }
  /// The same, dt_s after the last: a driver that missed periods says so. Counts as one to four periods, so
  /// that no pause ever lets the force leap.
  const TickReport& tick(double dt_s) noexcept;

  /// Other gains from the next tick on, as where physics changes its rate. Softer ones take energy out of the
  /// springs, stiffer ones put some in: let those wait until nothing is held. Gains that are not usable are a
  /// fault, as in the constructor.
  void setGains(const CouplingGains& gains) noexcept;

  /// Latches a fault that a driver has found; recovery is rearm().
  void refuse(SafetyFault fault) noexcept;

  /// Tells the ledger the energy stored in the scene now (kinetic, gravity, springs, contact) and the work
  /// put in by others than the hand so far, both in scene joules. Call once a physics step, from the loop's
  /// thread, with the handle where the last tick read it: there the balance is drawn.
  void observeStoredEnergy(double stored_J, double actuator_J) noexcept;

  [[nodiscard]] bool isHolding() const noexcept { return is_holding_; }
  [[nodiscard]] const TickReport& last() const noexcept { return report_; }
  [[nodiscard]] const PassivityObserver& ledger() const noexcept { return ledger_; }
  [[nodiscard]] const SafetyState& safety() const noexcept { return guard_.state(); }
  [[nodiscard]] const LoopSettings& settings() const noexcept { return settings_; }
  /// Ticks that ended with each Status, indexed by its value.
  [[nodiscard]] std::uint64_t count(Status status) const noexcept;
  [[nodiscard]] std::uint64_t ticks() const noexcept { return ticks_; }
  /// How long the part's snapshot has been the same, by ticks.
  [[nodiscard]] double snapshotAge_s() const noexcept { return snapshot_age_s_; }

  /// The grasp frame for a handle pose in D, and a hand's impedance about G in W as one about H in D: what
  /// joins a VirtualOperator to a SimulatedDualArm.
  [[nodiscard]] Pose toGrasp(const Pose& X_DH) const noexcept;
  [[nodiscard]] HandForce toDevice(const HandForce& hand_W) const noexcept;

 private:
  [[nodiscard]] Wrench coupling(const CouplingState& proxy, double dt_s) noexcept;
  [[nodiscard]] Wrench passivityDamping(const Twist& V_DH) const noexcept;
  [[nodiscard]] Twist stepSince(const DeviceSample& sample) const noexcept;
  void moveProxy(const Twist& step_D, const Pose& X_DH) noexcept;
  void account(const DeviceSample& sample, const Twist& step_D) noexcept;
  void accountUnseen(const Wrench& F_acting_D) noexcept;
  [[nodiscard]] Wrench actingWrench() const noexcept;
  void watchPhysics(double dt_s) noexcept;
  void tellFault() noexcept;

  static constexpr std::size_t kStatusCount = 8;
  static constexpr std::size_t kMostDelay = 14;  ///< ticks of the device's own that the ledger can follow

  Device* device_;
  CouplingPort* port_;
  LoopSettings settings_;
  DeviceLimits limits_;
  SafetyGuard guard_;
  double spare_Ns_per_m_ = 0, spare_Nms_per_rad_ = 0;  // b - K T/2 - B, at the device
  Grasp grasp_;
  Clutch clutch_;
  bool is_holding_ = false;
  TickReport report_;
  PassivityObserver ledger_;
  Pose X_DH_before_;
  bool has_before_ = false;
  std::array<Wrench, kMostDelay + 2> F_written_D_{};  ///< newest first
  double delay_ticks_ = 0;                            ///< the device's own
  Wrench F_accounted_D_;                              ///< by the last account()
  double force_way_N_ = 0, torque_way_Nm_ = 0;        ///< sums of its changes
  double net_scene_J_ = 0, balance_start_J_ = 0;      // scene joules
  bool has_stored_ = false;
  double snapshot_age_s_ = 0, snapshot_time_s_ = 0;
  std::uint64_t told_faults_ = 0;
  std::uint64_t ticks_ = 0;
  std::array<std::uint64_t, kStatusCount> counts_{};
};

}  // namespace vps::device
