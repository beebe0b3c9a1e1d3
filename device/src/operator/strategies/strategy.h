// SPDX-License-Identifier: BSD-3-Clause
// What a strategy of insertion senses, and what it asks of the hand. Each strategy is a small state machine
// of its own.
#pragma once

#include "vps/pose.h"
#include "vps_device/operator.h"

namespace vps::device {

/// Positions are those of the part as the hand feels them, at G: its own position, less what gives way under
/// the force that it feels. a: axis of insertion.
struct Feel {
  double time_s = 0;
  double along_m = 0;            ///< beyond the target along a; negative before it
  Vec3 across_m = Vec3::Zero();  ///< from the line through the target
  /// Of the end that goes in first, from that line; of a slender part from where its hole was seen.
  Vec3 tip_m = Vec3::Zero();
  Mat3 R_hand = Mat3::Identity();  ///< of the hand, in W
  double spin_rad = 0;             ///< turn of the hand about a since the insertion began; beyond a turn too
  Vec3 lean_rad = Vec3::Zero();    ///< of the hand's own axis from a
  double twist_Nm = 0;             ///< on the hand, about a
  int grips = 0;                   ///< how often it re-grasped
  double resist_N = 0;             ///< against a
  Vec3 side_N = Vec3::Zero();      ///< on the hand, across a
  double speed_m_s = 0;            ///< of the hand along a
  double seen_short_m = 0;         ///< how much the part is seen to lack to its target; late and noisy
  double seen_for_s = 0;           ///< how long it has been seen since the last correction began
};

/// What the hand is to do, from where it believes the hole to be.
struct Move {
  Vec3 across_m = Vec3::Zero();  ///< of the part's tip
  Vec3 turn_rad = Vec3::Zero();  ///< about the tip
  double speed_m_s = 0;          ///< along a; negative: back
  double push_N = 0;             ///< greatest push along a
  double spin_rad_s = 0;         ///< about a
  bool looks = false;            ///< sight corrects the belief
  bool gives_way = false;        ///< the felt side force and torque correct the belief
};

inline constexpr double kInside_m = 0.5e-3;  ///< beyond the first touch: in the hole

enum class Outcome {
  GoingOn,
  Done,    ///< it did what it is for
  Failed,  ///< it did not
};

/// What a strategy knows of the task.
struct Situation {
  OperatorHabits habits;
  Vec3 axis_W = Vec3::UnitZ();
  Vec3 corner_W = Vec3::Zero();  ///< unit, across a: to the part's corner; zero: not known
  double push_limit_N = 0;       ///< of the present attempt
  double near_m = 0;             ///< seen this close to the target it may be there
  bool has_touched = false;      ///< the hole leads, and sight no longer corrects across
  double mouth_m = 0;            ///< `along` at the first touch
  double tip_m = 0;              ///< from G along the axis to the end that goes in first
  bool is_slender = false;       ///< a little lean moves its end far
  bool has_corners = false;      ///< it may have to be turned about the axis
  int attempt = 0;
  ScrewTask screw;
  double back_rad = 0;  ///< how far it turns against the thread at most
};

/// The turn that moves a part on: about a by the right-hand rule, or against it.
inline double turnsOn(const ScrewTask& screw) noexcept {
  return screw.pitch_m < 0 ? -1 : 1;
}

class Strategy {
 public:
  virtual ~Strategy() = default;
  virtual void start(const Situation& situation, const Feel& feel) noexcept = 0;
  virtual Outcome step(const Feel& feel, double dt_s) noexcept = 0;
  [[nodiscard]] const Move& move() const noexcept { return move_; }

 protected:
  /// While it is lowered onto the mouth, the part has dropped through it: that is where the hole is.
  [[nodiscard]] bool isPastMouth(const Feel& feel) const noexcept {
    return feel.along_m > situation_.mouth_m + kInside_m;
  }

  Situation situation_;
  double start_s_ = 0;
  Move move_;
};

/// Counts how long a condition has held.
class Held {
 public:
  double step(bool holds, double dt_s) noexcept { return time_s_ = holds ? time_s_ + dt_s : 0; }
  void reset() noexcept { time_s_ = 0; }

 private:
  double time_s_ = 0;
};

/// Tells when a part under push no longer moves on.
class Progress {
 public:
  void start(double along_m, double now_s) noexcept {
    best_m_ = along_m;
    best_s_ = now_s;
  }
  /// Time since the last progress of at least `least_m`.
  double step(double along_m, double now_s, double least_m) noexcept {
    if (along_m > best_m_ + least_m) start(along_m, now_s);
    return now_s - best_s_;
  }

 private:
  double best_m_ = 0, best_s_ = 0;
};

}  // namespace vps::device
