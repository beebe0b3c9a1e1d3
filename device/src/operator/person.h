// SPDX-License-Identifier: BSD-3-Clause
// The person behind VirtualOperator: follows the path, inserts by strategies, and holds the handle.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "operator/sequence.h"
#include "operator/sight.h"
#include "vps_device/operator.h"
#include "vps_device/random.h"

namespace vps::device {

/// Offset of the path and the hole, as the person believes, from their true place.
struct Belief {
  Vec3 across_m = Vec3::Zero();
  Vec3 turn_rad = Vec3::Zero();
};

class VirtualOperator::Person {
 public:
  explicit Person(const OperatorHabits& habits) : habits_(habits), random_(habits.seed), sight_(habits) {}

  void begin(const OperatorTask& task, double now_s);
  HandForce step(const OperatorView& view, double dt_s) noexcept;
  void goOn() noexcept;
  [[nodiscard]] Vec3 regraspTurn_rad() const noexcept;

  [[nodiscard]] OperatorPhase phase() const noexcept { return phase_; }
  [[nodiscard]] OperatorStrategy strategy() const noexcept {
    return isInserting() || is_regrasping_ ? sequence().strategy() : OperatorStrategy::None;
  }
  [[nodiscard]] int retries() const noexcept { return sequence().retries(); }
  [[nodiscard]] const OperatorHabits& habits() const noexcept { return habits_; }

 private:
  struct Segment {
    Pose X_from, X_to;  // poses of G
    double start_s = 0, duration_s = 1;
  };

  // Plan.
  void startSegment(const Pose& X_from, const Pose& X_to, double now_s) noexcept;
  void reach(const OperatorView& view) noexcept;
  void arrive(const OperatorView& view) noexcept;
  void lookAlong(std::size_t goal) noexcept;
  void startInsertion(const OperatorView& view) noexcept;
  void addAim() noexcept;
  void goOnFromSearch(const OperatorView& view) noexcept;
  [[nodiscard]] bool isStoppedOnTheWay(const OperatorView& view) const noexcept;
  /// The part is seen at the end of the leg, so that the search there is over.
  [[nodiscard]] bool isPastSearch() const noexcept {
    return feel_.seen_for_s > 0 && feel_.seen_short_m < habits_.see_error_m;
  }
  /// The pose of G at the end of the leg along which the operator feels, and searches if necessary.
  [[nodiscard]] const Pose& goal() const noexcept { return path_[goal_]; }
  [[nodiscard]] bool isLastGoal() const noexcept { return goal_ + 1 == path_.size(); }
  void insert(const OperatorView& view, double dt_s) noexcept;
  void enter(OperatorPhase phase, double now_s) noexcept;
  void finish(OperatorPhase phase, const OperatorView& view) noexcept;

  [[nodiscard]] bool isScrew() const noexcept { return task_.screw.pitch_m != 0; }
  [[nodiscard]] Sequence& sequence() noexcept {
    if (isScrew()) return screwing_;
    return insertion_;
  }
  [[nodiscard]] const Sequence& sequence() const noexcept {
    if (isScrew()) return screwing_;
    return insertion_;
  }
  void turn(const OperatorView& view, double spin_rad_s, double dt_s) noexcept;

  // Senses.
  void sense(const OperatorView& view, double dt_s) noexcept;
  void correctOnTheWay(double dt_s) noexcept;
  void correctAtTheHole(double dt_s) noexcept;
  void giveWay(double dt_s) noexcept;
  [[nodiscard]] Vec3 across(const Vec3& v) const noexcept { return v - axis_W_ * axis_W_.dot(v); }
  [[nodiscard]] Vec3 tipFromGrasp(const Mat3& R_WG) const noexcept;
  [[nodiscard]] Vec3 seenTip() const noexcept;
  /// Friction at the leading end tilts the part in the hand by more than the range of a search.
  [[nodiscard]] bool isSlender() const noexcept {
    return tip_m_ > 0 && habits_.search_N * tip_m_ * tip_m_ > habits_.k_Nm_per_rad * habits_.search_limit_m;
  }
  [[nodiscard]] Pose seenGrasp() const noexcept {
    const Pose X = sight_.seen() * task_.X_PG;
    return {Mat3(rotationFromVector(misread_rad_) * X.R), X.p};
  }
  [[nodiscard]] double seeLimit_m() const noexcept { return habits_.see_limit_m + sag_m_.norm(); }
  [[nodiscard]] double seeLimit_rad() const noexcept { return habits_.see_limit_rad + habits_.aim_turn_rad; }

  // Hand.
  [[nodiscard]] Pose wanted(double now_s) const noexcept;
  [[nodiscard]] Pose wantedAtTheHole() const noexcept;
  [[nodiscard]] Vec3 turnAboutMouth(const Vec3& end_m) const noexcept;
  /// Depth of a slender part in the first hole that it found; 0 for other parts.
  [[nodiscard]] double depth_m() const noexcept {
    return isSlender() && !isScrew() && insertion_.hasTouched() ? feel_.along_m - insertion_.firstMouth_m()
                                                                : 0;
  }
  [[nodiscard]] Mat3 turnAtTheHole(double along_m) const noexcept;
  void serve(const Pose& X_wanted, const Pose& X_hand, double dt_s) noexcept;
  [[nodiscard]] Pose limited(const Pose& X_wanted, const Pose& X_hand) const noexcept;
  void follow(const Pose& X_wanted, double dt_s) noexcept;
  [[nodiscard]] HandForce impedance() const noexcept;
  [[nodiscard]] bool isInserting() const noexcept {
    return phase_ == OperatorPhase::Insert || phase_ == OperatorPhase::Press;
  }
  /// The part of a rotation that a belief may have: for a screw only the tilt, since the hand turns about the
  /// axis.
  [[nodiscard]] Vec3 tiltOf(const Vec3& turn) const noexcept { return isScrew() ? across(turn) : turn; }
  [[nodiscard]] Mat3 spun(double spin_rad) const noexcept { return rotationFromVector(spin_rad * axis_W_); }

  OperatorHabits habits_;
  Random random_;
  Sight sight_;
  OperatorTask task_;
  OperatorPhase phase_ = OperatorPhase::Idle;
  double begin_s_ = 0, phase_s_ = 0, done_s_ = 0;

  std::vector<Pose> path_;  // path of G: start, way points, target
  std::size_t next_ = 0;    // index in path_ of the segment's end
  std::size_t goal_ = 0;    // index in path_ of goal()
  Segment segment_;
  Vec3 axis_W_ = Vec3::UnitZ();                         // axis of insertion
  double tip_m_ = 0;                                    // distance from G along the axis to the leading end
  Vec3 aim_m_ = Vec3::Zero(), aim_rad_ = Vec3::Zero();  // aim error, drawn once per task
  bool has_aimed_ = false;                              // the aim error is part of belief_

  Vec3 misread_rad_ = Vec3::Zero();  // error about the axis, which sight does not correct

  Belief belief_;
  Vec3 sag_m_ = Vec3::Zero();  // displacement of a heavy part below the hand; zero for other parts
  double seen_for_s_ = 0;
  Feel feel_;
  // Felt offset of the leading end from the grasp, and from the line through the target.
  Vec3 lean_m_ = Vec3::Zero(), tip_felt_m_ = Vec3::Zero();
  // For a slender part: felt offset of its leading end when the end is at its hole, and the time of this
  // observation.
  Vec3 hole_m_ = Vec3::Zero();
  double hole_seen_for_s_ = 0;
  Insertion insertion_;
  Screwing screwing_;
  double spin_rad_ = 0;             // wanted rotation about the axis
  double handle_rad_ = 0;           // rotation of the handle about the axis, from the middle of its range
  double handle_goal_rad_ = 0;      // handle_rad_ at which the handle is grasped again
  Mat3 R_felt_ = Mat3::Identity();  // rotation of the hand one step ago
  bool is_regrasping_ = false;      // the hand re-grasps a screw
  double reach_m_ = 0;              // wanted position of the hand along the axis, beyond the target
  bool is_home_ = false;

  bool has_view_ = false;
  Pose X_eq_;  // equilibrium, after the muscles' lag
  Twist V_eq_;
  Pose X_rest_;  // equilibrium while there is no task
  Vec3 serve_m_ = Vec3::Zero(),
       serve_rad_ = Vec3::Zero();  // correction of the hand against friction of the device
};

}  // namespace vps::device
