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
  Waiting,   ///< its step is still to come: drawn only in the overview of the finished assembly
  InHand,    ///< coupled to the device
  Released,  ///< uncoupled, still dynamic
  Mounted,   ///< cooked into the fixed field
};

struct BodySnapshot {
  std::size_t part = 0;  ///< index into Scene::parts
  Pose X_WP;
  BodyRole role = BodyRole::Waiting;
};

/// A contact, to be drawn.
struct ContactMark {
  Vec3 p_W = Vec3::Zero();
  Vec3 n_W = Vec3::Zero();
  double depth_m = 0;
  double force_N = 0;          ///< along the normal, averaged over the physics step
  Vec3 slip_W = Vec3::Zero();  ///< [m/s] along the faces, of the part that n_W points to on the other
};

/// Of all contacts [N].
[[nodiscard]] inline double totalForce_N(const std::vector<ContactMark>& contacts) {
  double sum_N = 0;
  for (const ContactMark& contact : contacts) sum_N += contact.force_N;
  return sum_N;
}

/// How a run does so far, for those who watch it.
struct RunFigures {
  std::uint64_t ticks = 0, missed = 0;  ///< of the haptic loop; missed: periods without a tick
  std::uint64_t physics_steps = 0, physics_missed = 0;    ///< missed: took longer than their period
  double tick_p99_us = 0, step_p99_us = 0;                ///< longest but for one in a hundred
  double to_hand_J = 0, from_hand_J = 0, injected_J = 0;  ///< see EnergyLedger
};

struct Snapshot {
  double time_s = 0;
  int step = -1;  ///< index into Scene::steps, -1 outside of a step
  std::vector<BodySnapshot> bodies;
  bool has_target = false;  ///< the translucent hint of the paper's section 5
  std::size_t target_part = 0;
  Pose X_WP_target;
  bool has_hand = false;
  Pose X_W_Proxy;   ///< the device's handle
  Wrench F_hand_W;  ///< force and torque on the hand
  std::vector<ContactMark> contacts;
  /// Of a run by the clock that gives it to a SnapshotTap; else 0. The handle was read at sample_s, by the
  /// device's clock, and the physics step that followed it was done at clock_s, by monotonicSeconds(): the
  /// one time of its contacts, by which picture, sound and force are compared.
  double sample_s = 0, clock_s = 0;
  /// Of a run that gives it to a SnapshotTap, at most 50 ms of simulated time old; not sent over networks.
  std::optional<RunFigures> figures;
};

}  // namespace vps::scenes
