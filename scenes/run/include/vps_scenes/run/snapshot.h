// SPDX-License-Identifier: BSD-3-Clause
// The state of a run at one instant, for viewers and recorders, which never read live state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "vps/pose.h"
#include "vps/wrench.h"

namespace vps::scenes {

enum class BodyRole {
  Waiting,   ///< the part's step has not begun; drawn only in the overview of the finished assembly
  InHand,    ///< coupled to the device
  Released,  ///< uncoupled, still dynamic
  Mounted,   ///< cooked into the fixed field
};

struct BodySnapshot {
  std::size_t part = 0;  ///< index into Scene::parts
  Pose X_WP;
  BodyRole role = BodyRole::Waiting;
};

/// A contact for display.
struct ContactMark {
  Vec3 p_W = Vec3::Zero();
  Vec3 n_W = Vec3::Zero();
  double depth_m = 0;
  double force_N = 0;          ///< normal force, averaged over the physics step
  Vec3 slip_W = Vec3::Zero();  ///< velocity along the faces [m/s] of the part that n_W points to, relative to
                               ///< the other part
};

/// Sum of the forces of all contacts [N].
[[nodiscard]] inline double totalForce_N(const std::vector<ContactMark>& contacts) {
  double sum_N = 0;
  for (const ContactMark& contact : contacts) sum_N += contact.force_N;
  return sum_N;
}

/// Statistics of a run so far, for viewers.
struct RunFigures {
  std::uint64_t ticks = 0, missed = 0;  ///< ticks of the haptic loop, and periods without a tick
  std::uint64_t physics_steps = 0,
                physics_missed = 0;         ///< physics_missed: steps that took longer than their period
  double tick_p99_us = 0, step_p99_us = 0;  ///< 99th percentiles of the durations
  double to_hand_J = 0, from_hand_J = 0, injected_J = 0;  ///< energies as in EnergyLedger
};

struct Snapshot {
  double time_s = 0;
  int step = -1;  ///< index into Scene::steps, -1 outside of a step
  std::vector<BodySnapshot> bodies;
  bool has_target = false;  ///< the target is shown translucent (section 5 of Tripicchio et al.)
  std::size_t target_part = 0;
  Pose X_WP_target;
  bool has_hand = false;
  Pose X_W_Proxy;   ///< pose of the device's handle
  Wrench F_hand_W;  ///< force and torque on the hand
  std::vector<ContactMark> contacts;
  /// Set only in a run in real time that passes the snapshot to a SnapshotTap; else 0. sample_s is when the
  /// handle was read, by the device's clock. clock_s is when the physics step that followed ended, by
  /// monotonicSeconds(); picture, sound and force of a contact are compared by this time.
  double sample_s = 0, clock_s = 0;
  /// The figures are set only in a run that passes the snapshot to a SnapshotTap, are at most 50 ms of
  /// simulated time old, and are not sent over networks.
  std::optional<RunFigures> figures;
};

}  // namespace vps::scenes
