// SPDX-License-Identifier: BSD-3-Clause
// A strategy of the virtual operator: what it senses, and what it tells the hand to do. Each strategy is a
// small state machine in a source of its own. To add one: device/VIRTUAL_OPERATOR.md, "A strategy of your
// own".
#pragma once

#include <cmath>
#include <memory>

#include "vps/pose.h"
#include "vps_device/operator.h"

namespace vps::device {

/// What the hand feels. All positions are of the part at the grasp frame G, computed from the hand's own
/// position and the coupling's deflection under the felt force. a is the axis of insertion.
struct Feel {
  double time_s = 0;
  double along_m = 0;            ///< position along a, positive beyond the target
  Vec3 across_m = Vec3::Zero();  ///< distance from the line through the target along a
  /// Offset of the leading end from the line through the target along a; for a slender part, from where its
  /// hole was seen.
  Vec3 tip_m = Vec3::Zero();
  Mat3 R_hand = Mat3::Identity();  ///< rotation of the hand, in W
  double spin_rad = 0;             ///< rotation of the hand about a since the insertion began, not wrapped
  Vec3 lean_rad = Vec3::Zero();    ///< tilt of the hand from a
  double twist_Nm = 0;             ///< torque on the hand, about a
  int grips = 0;                   ///< number of re-grasps
  double resist_N = 0;             ///< force on the hand against a
  Vec3 side_N = Vec3::Zero();      ///< force on the hand, across a
  double speed_m_s = 0;            ///< speed of the hand along a
  double seen_short_m = 0;         ///< distance of the part before its target, as seen: delayed and noisy
  double seen_for_s = 0;           ///< time for which the part has been seen since the last leg began
};

/// Command of a strategy to the hand, relative to where the operator believes the hole to be.
struct Move {
  Vec3 across_m = Vec3::Zero();  ///< displacement of the part's leading end
  Vec3 turn_rad = Vec3::Zero();  ///< rotation about the leading end
  double speed_m_s = 0;          ///< speed along a; negative: backwards
  double push_N = 0;             ///< greatest push along a
  double spin_rad_s = 0;         ///< rotational speed about a
  bool looks = false;            ///< sight corrects the believed position of the hole
  bool gives_way = false;        ///< felt side force and torque correct the believed position of the hole
};

enum class Outcome {
  GoingOn,
  Done,       ///< the strategy reached its purpose
  Failed,     ///< the strategy did not reach its purpose
  Unopposed,  ///< the part is seen beyond its target, and nothing stopped it
};

/// Data of the task that a strategy may use.
struct Situation {
  OperatorHabits habits;
  Vec3 axis_W = Vec3::UnitZ();
  Vec3 corner_W = Vec3::Zero();  ///< unit vector across a to the part's corner; zero: not known
  double push_limit_N = 0;       ///< push limit of the present attempt
  double near_m = 0;             ///< a part seen this close to the target may be at the target
  bool has_touched = false;      ///< the part has touched: the hole guides it, sight no longer does
  double mouth_m = 0;            ///< `along_m` at the first touch
  double tip_m = 0;              ///< distance from G along the axis to the leading end
  bool is_slender = false;       ///< a small tilt displaces the leading end by more than a search covers
  bool has_corners = false;      ///< the part may have to be turned about the axis
  bool backs_off_whole = true;   ///< back off to before the mouth, instead of a little within the hole
  int attempt = 0;
  ScrewTask screw;
  double back_rad = 0;  ///< greatest rotation against the thread
};

// Values that several strategies share.
inline constexpr double kInside_m = 0.5e-3;    ///< a part this far beyond the first touch is in the hole
inline constexpr double kDropped_m = 0.15e-3;  ///< a part that drops by this much has found the hole
inline constexpr double kCreep_m_s = 10e-3;    ///< speed at which a part is lowered onto a surface
inline constexpr double kLower_s = 2;          ///< longest time for lowering a part
inline constexpr double kSettle_s = 0.3;       ///< a pressed part is at rest after this time
inline constexpr double kLook_s = 0.6;         ///< averaging time of sight: two fixations

/// Sign of the rotation about a that screws the part on.
inline double turnsOn(const ScrewTask& screw) noexcept {
  return screw.pitch_m < 0 ? -1 : 1;
}

/// Unit vector across the axis, at `angle_rad`.
inline Vec3 acrossAxis(const Vec3& axis_W, double angle_rad) noexcept {
  const Vec3 x = axis_W.unitOrthogonal(), y = axis_W.cross(x);
  return std::cos(angle_rad) * x + std::sin(angle_rad) * y;
}

class Strategy {
 public:
  virtual ~Strategy() = default;
  void start(const Situation& situation, const Feel& feel) noexcept {
    situation_ = situation;
    start_s_ = feel.time_s;
    move_ = {};
    begin(feel);
  }
  virtual Outcome step(const Feel& feel, double dt_s) noexcept = 0;
  [[nodiscard]] const Move& move() const noexcept { return move_; }

  /// True for a strategy that looks for the hole on the surface around it. The operator tries all searches
  /// that suit the part in turn, in the order of their rows in VPS_OPERATOR_STRATEGIES.
  [[nodiscard]] virtual bool isSearch() const noexcept { return false; }
  /// Whether this search may help with a part in this situation.
  [[nodiscard]] virtual bool suits(const Situation&) const noexcept { return true; }
  /// True if the hole is where the last Move displaced and turned the part to, once the search is done.
  [[nodiscard]] virtual bool findsByOffset() const noexcept { return false; }

 protected:
  /// Sets the strategy's own state and the first move. situation_, start_s_ and a default move_ are set.
  virtual void begin(const Feel& feel) noexcept = 0;

  void pressLightly() noexcept {
    move_.speed_m_s = kCreep_m_s;
    move_.push_N = situation_.habits.search_N;
  }
  /// True if the part has dropped through the mouth of its hole while it is lowered.
  [[nodiscard]] bool isPastMouth(const Feel& feel) const noexcept {
    return feel.along_m > situation_.mouth_m + kInside_m;
  }

  Situation situation_;
  double start_s_ = 0;
  Move move_;
};

// makeApproach(), makeTouch() and so on: one maker for each row, defined in the source of its strategy.
#define VPS_DECLARE_MAKER(Name, name) std::unique_ptr<Strategy> make##Name();
VPS_OPERATOR_STRATEGIES(VPS_DECLARE_MAKER)
#undef VPS_DECLARE_MAKER

/// Measures for how long a condition has held.
class Held {
 public:
  double step(bool holds, double dt_s) noexcept { return time_s_ = holds ? time_s_ + dt_s : 0; }

 private:
  double time_s_ = 0;
};

/// Measures for how long a pushed part has made no progress.
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
