// SPDX-License-Identifier: BSD-3-Clause
#include "operator/person.h"

namespace vps::device {
namespace {

constexpr double kMinSegment_s = 0.3;   // assumed: no aimed movement is shorter
constexpr double kArrived_m = 2e-3;     // distance from a way point that counts as reached
constexpr double kArrivalWait_s = 0.5;  // longest wait until a way point counts as reached
constexpr double kRestWait_s = 2;
constexpr double kFeel_s = 0.01;    // time constant of touch. assumed: a finger feels up to 16 Hz
constexpr double kSoon_s = 0.2;     // time constant of the seen distance to the target along the axis
constexpr double kLeastGain = 0.2;  // least gain, as a share of the first gain: old pictures are forgotten
constexpr double kGiveWay_per_s = 4;
constexpr double kNear = 4;       // greatest distance that counts as near the target, in units of see_error_m
constexpr double kGuided = 0.25;  // share of tip_m_; deeper in its hole a slender part cannot tilt freely
constexpr double kPivots_m = 5e-3;  // depth from which a slender part in a hole turns about the hole's mouth
constexpr double kHome_per_s = 4;   // rate of a slender part's end towards the seen hole

Vec3 shortened(const Vec3& v, double limit) noexcept {
  const double length = v.norm();
  return length > limit ? Vec3(v * (limit / length)) : v;
}

}  // namespace

void VirtualOperator::Person::begin(const OperatorTask& task, double now_s) {
  task_ = task;
  path_.assign(1, task.X_WP_start * task.X_PG);
  for (const Pose& X_WP : task.way_points) path_.push_back(X_WP * task.X_PG);
  path_.push_back(task.X_WP_target * task.X_PG);

  lookAlong(path_.size() - 1);
  has_aimed_ = false;
  aim_m_ = across(habits_.aim_error_m * random_.normal3());
  aim_rad_ = habits_.aim_error_rad * random_.normal3();
  if (task.is_taking_off) aim_m_ = aim_rad_ = Vec3::Zero();
  misread_rad_ = habits_.aim_turn_rad > 0 ? habits_.aim_turn_rad * (2 * random_.uniform() - 1) * axis_W_
                                          : Vec3(Vec3::Zero());
  belief_ = {};
  sag_m_ = sagBelowHand_m(habits_, task.weight_W, task.give_m_per_N);
  belief_.across_m = -sag_m_;
  hole_m_ = Vec3::Zero();
  hole_seen_for_s_ = kSoon_s;  // the aim has the weight of a look of this duration
  seen_for_s_ = 0;
  serve_m_ = serve_rad_ = Vec3::Zero();
  has_view_ = is_home_ = false;  // the next view gives the hand's start
  is_regrasping_ = false;
  insertion_.forgetRetries();
  screwing_.forgetRetries();
  spin_rad_ = handle_rad_ = handle_goal_rad_ = 0;
  begin_s_ = now_s;
  next_ = 1;
  phase_ = OperatorPhase::Reach;
  // The person looks at the middle of the leading end.
  const Vec3 p_tip_W = goal().p + tip_m_ * axis_W_;
  sight_.begin(task.X_WP_target.inverse() * p_tip_W, now_s);
}

HandForce VirtualOperator::Person::step(const OperatorView& view, double dt_s) noexcept {
  const bool is_good = view.X_WG_hand.isFinite() && view.X_WP.isFinite() && view.V_WP.isFinite() &&
                       view.V_WG_hand.isFinite() && view.F_hand_W.isFinite() && std::isfinite(view.time_s) &&
                       dt_s > 0;
  if (!is_good) {
    HandForce blind = impedance();
    blind.F = {};
    return blind;
  }
  if (!has_view_) {
    has_view_ = true;
    X_eq_ = X_rest_ = view.X_WG_hand;
    V_eq_ = {};
    if (!isInserting()) {
      feel_ = {};
      R_felt_ = view.X_WG_hand.R;
    }
    if (phase_ == OperatorPhase::Reach) startSegment(X_eq_, path_[next_], view.time_s);
  }
  sense(view, dt_s);
  const bool is_busy = phase_ == OperatorPhase::Reach || isInserting();
  if (is_busy && view.time_s - begin_s_ > task_.timeout_s) {
    finish(OperatorPhase::Failed, view);
  } else if (phase_ == OperatorPhase::Reach) {
    reach(view);
    const bool is_last_leg = phase_ == OperatorPhase::Reach && next_ + 1 == path_.size();
    if (is_last_leg && !task_.is_taking_off) startInsertion(view);
  } else if (isInserting()) {
    insert(view, dt_s);
  }
  Pose X_wanted = wanted(view.time_s);
  serve(X_wanted, view.X_WG_hand, dt_s);
  X_wanted.p += serve_m_;
  X_wanted.R = rotationFromVector(serve_rad_) * X_wanted.R;
  follow(limited(X_wanted, view.X_WG_hand), dt_s);
  return impedance();
}

void VirtualOperator::Person::goOn() noexcept {
  if (phase_ != OperatorPhase::Regrasp) return;
  has_view_ = false;
  phase_ = is_regrasping_ ? OperatorPhase::Insert : OperatorPhase::Reach;
  if (!is_regrasping_) return;
  is_regrasping_ = false;
  handle_rad_ = handle_goal_rad_;
  spin_rad_ = feel_.spin_rad;
  serve_rad_ = Vec3::Zero();
  ++feel_.grips;
}

Vec3 VirtualOperator::Person::regraspTurn_rad() const noexcept {
  const bool is_screwing = phase_ == OperatorPhase::Regrasp && is_regrasping_;
  return is_screwing ? Vec3(handle_goal_rad_ * axis_W_) : Vec3(Vec3::Zero());
}

// --- Plan

void VirtualOperator::Person::startSegment(const Pose& X_from, const Pose& X_to, double now_s) noexcept {
  const double length_m = (X_to.p - X_from.p).norm();
  const double turn_rad = rotationVector(X_to.R * X_from.R.transpose()).norm();
  segment_ = {X_from, X_to, now_s,
              std::max({kMinSegment_s, length_m / habits_.speed_m_s, turn_rad / habits_.turn_rad_s})};
}

void VirtualOperator::Person::enter(OperatorPhase phase, double now_s) noexcept {
  phase_ = phase;
  phase_s_ = now_s;
}

void VirtualOperator::Person::finish(OperatorPhase phase, const OperatorView& view) noexcept {
  X_rest_ = view.X_WG_hand;
  serve_m_ = serve_rad_ = Vec3::Zero();
  enter(phase, view.time_s);
}

void VirtualOperator::Person::reach(const OperatorView& view) noexcept {
  const double now_s = view.time_s, end_s = segment_.start_s + segment_.duration_s;
  const bool is_last_leg = next_ + 1 == path_.size();
  if ((is_last_leg && !task_.is_taking_off) || now_s < end_s) return;
  const double off_m = sight_.hasSeen() ? (seenGrasp().p - segment_.X_to.p).norm() : kArrived_m;
  if (is_last_leg) {
    if (off_m < std::min(kArrived_m, task_.tolerance_m)) finish(OperatorPhase::Done, view);
    return;
  }
  if (off_m >= kArrived_m && now_s < end_s + kArrivalWait_s) return;
  if (isStoppedOnTheWay(view)) {
    lookAlong(next_);
    return startInsertion(view);
  }
  arrive(view);
}

// Continues after a way point was reached.
void VirtualOperator::Person::arrive(const OperatorView& view) noexcept {
  const double now_s = view.time_s;
  const auto& index_points = task_.index_points;
  if (std::find(index_points.begin(), index_points.end(), next_ - 1) != index_points.end()) {
    X_rest_ = wanted(now_s);
    ++next_;
    return enter(OperatorPhase::Regrasp, now_s);
  }
  ++next_;
  startSegment(segment_.X_to, path_[next_], now_s);
}

// On a leg before the last one: the part is seen before the leg's end, and contact is felt to hold it back.
bool VirtualOperator::Person::isStoppedOnTheWay(const OperatorView& view) const noexcept {
  const Vec3 leg = segment_.X_to.p - path_[next_ - 1].p;
  if (task_.is_taking_off || isScrew() || !sight_.hasSeen() || leg.norm() < kArrived_m) return false;
  const Vec3 along = leg.normalized();
  const double short_m = along.dot(segment_.X_to.p - seenGrasp().p);
  return short_m >= kArrived_m && -along.dot(view.F_hand_W.f - task_.weight_W) > habits_.touch_N;
}

// From now on the axis of insertion is along this leg. The task gives the leading end only for the last leg.
void VirtualOperator::Person::lookAlong(std::size_t goal) noexcept {
  goal_ = goal;
  feel_.seen_for_s = 0;
  const Vec3 leg = path_[goal].p - path_[goal - 1].p;
  axis_W_ = leg.norm() > 1e-9 ? Vec3(leg.normalized()) : Vec3(-Vec3::UnitZ());
  const bool knows_tip = isLastGoal() && !task_.tip_P.isZero();
  tip_m_ = knows_tip ? axis_W_.dot(task_.X_WP_target * task_.tip_P - path_.back().p) : 0;
}

void VirtualOperator::Person::startInsertion(const OperatorView& view) noexcept {
  belief_.across_m = across(belief_.across_m);
  // On earlier legs the aim error is not part of the wanted pose: see wanted().
  if (!has_aimed_ && next_ + 2 >= path_.size()) addAim();
  hole_m_ = isSlender() ? Vec3(belief_.across_m + across(sag_m_)) : Vec3(Vec3::Zero());
  seen_for_s_ = 0;
  const Pose& X_to = goal();
  reach_m_ = axis_W_.dot(view.X_WG_hand.p - X_to.p);
  Situation situation;
  situation.habits = habits_;
  situation.axis_W = axis_W_;
  if (isLastGoal() && !task_.tip_P.isZero()) {
    const Vec3 corner_W = across(task_.X_WP_target * task_.tip_P - X_to.p);
    if (corner_W.norm() > 1e-9) situation.corner_W = corner_W.normalized();
  }
  if (isSlender()) situation.corner_W = Vec3::Zero();  // a tilt would move the hand too far from the hole
  situation.is_slender = isSlender();
  situation.tip_m = tip_m_;
  situation.has_corners = task_.has_corners || !isLastGoal();
  situation.screw = task_.screw;
  situation.near_m = task_.tolerance_m + kNear * habits_.see_error_m;
  feel_.time_s = view.time_s;
  feel_.spin_rad = spin_rad_ = handle_rad_ = 0;
  sequence().begin(situation, feel_);
  enter(OperatorPhase::Insert, view.time_s);
}

void VirtualOperator::Person::addAim() noexcept {
  belief_.across_m += aim_m_;
  belief_.turn_rad += aim_rad_;
  has_aimed_ = true;
}

// Continues along the path after a search on the way.
void VirtualOperator::Person::goOnFromSearch(const OperatorView& view) noexcept {
  serve_m_ = serve_rad_ = Vec3::Zero();
  is_home_ = false;
  enter(OperatorPhase::Reach, view.time_s);
  lookAlong(path_.size() - 1);
  arrive(view);
}

void VirtualOperator::Person::insert(const OperatorView& view, double dt_s) noexcept {
  const OperatorStrategy before = sequence().strategy();
  const bool finds_by_offset = sequence().present().findsByOffset();
  const Move last = sequence().present().move();
  if (!is_home_ && sequence().step(feel_, dt_s) == Outcome::Done) {
    is_home_ = true;
    done_s_ = view.time_s;
  }
  if (finds_by_offset && sequence().strategy() == OperatorStrategy::AlignByTorque) {
    belief_.across_m += last.across_m;
    belief_.turn_rad += last.turn_rad;
  }
  if (isSlender() && before == OperatorStrategy::SpiralSearch && sequence().strategy() != before)
    belief_.across_m = tip_felt_m_ - across(sag_m_);  // the lead of the hand in the spiral ends
  // A screw on its thread is not pressed: it stays in phase Insert.
  const bool is_pressing =
      sequence().isAtLastStrategy() && sequence().strategy() != OperatorStrategy::ScrewOn;
  if (is_pressing != (phase_ == OperatorPhase::Press))
    enter(is_pressing ? OperatorPhase::Press : OperatorPhase::Insert, view.time_s);
  const Move& move = sequence().present().move();
  if (move.looks) correctAtTheHole(dt_s);
  if (!move.looks) seen_for_s_ = 0;
  if (move.gives_way) giveWay(dt_s);
  // The push limits how far the reach is ahead of the hand, so that a part that comes free does not jump
  // ahead.
  const double hand_m = axis_W_.dot(view.X_WG_hand.p - goal().p);
  reach_m_ += dt_s * move.speed_m_s;
  reach_m_ = std::min(reach_m_, hand_m + move.push_N / habits_.k_N_per_m);
  reach_m_ = std::max(reach_m_, hand_m - habits_.force_limit_N / habits_.k_N_per_m);
  if (isScrew()) turn(view, is_home_ ? 0 : move.spin_rad_s, dt_s);
  if (!isLastGoal() && (is_home_ || isPastSearch())) return goOnFromSearch(view);
  if (!is_home_) return;
  const bool is_still =
      view.V_WG_hand.v.norm() < habits_.still_m_s && view.V_WG_hand.w.norm() < habits_.still_rad_s;
  if (is_still || view.time_s > done_s_ + kRestWait_s) finish(OperatorPhase::Done, view);
}

// The hand's torque limits how far the wanted rotation is ahead of the hand. Where the handle turns no
// farther, it is grasped again at the other end of its range.
void VirtualOperator::Person::turn(const OperatorView& view, double spin_rad_s, double dt_s) noexcept {
  const double lead_rad = habits_.torque_limit_Nm / habits_.k_Nm_per_rad;
  spin_rad_ = std::clamp(spin_rad_ + dt_s * spin_rad_s, feel_.spin_rad - lead_rad, feel_.spin_rad + lead_rad);
  if (task_.screw.handle_rad <= 0 || spin_rad_s == 0) return;
  const double side = spin_rad_s > 0 ? 1 : -1;
  if (side * handle_rad_ < task_.screw.handle_rad) return;
  is_regrasping_ = true;
  handle_goal_rad_ = -side * task_.screw.handle_rad;
  X_rest_ = view.X_WG_hand;
  serve_m_ = Vec3::Zero();
  enter(OperatorPhase::Regrasp, view.time_s);
}

// --- Senses

void VirtualOperator::Person::sense(const OperatorView& view, double dt_s) noexcept {
  const bool is_new = sight_.look(view, tip_felt_m_);
  const Pose& X_target = path_.empty() ? X_rest_ : goal();
  const Wrench& F = view.F_hand_W;
  const double share = std::min(1.0, dt_s / kFeel_s);
  const Vec3 f_N = F.f - task_.weight_W;
  feel_.time_s = view.time_s;
  feel_.resist_N += share * (-axis_W_.dot(f_N) - feel_.resist_N);
  feel_.side_N += share * (across(f_N) - feel_.side_N);
  feel_.speed_m_s += share * (axis_W_.dot(view.V_WG_hand.v) - feel_.speed_m_s);
  const Vec3 p_m = view.X_WG_hand.p - X_target.p + task_.give_m_per_N * F.f;
  feel_.along_m = axis_W_.dot(p_m);
  feel_.across_m = across(p_m);
  lean_m_ += share * (tipFromGrasp(view.X_WP.R * task_.X_PG.R) - lean_m_);
  tip_felt_m_ = feel_.across_m + lean_m_;
  feel_.tip_m = tip_felt_m_ - hole_m_;
  feel_.R_hand = view.X_WG_hand.R;
  const double turned_rad = axis_W_.dot(rotationVector(view.X_WG_hand.R * R_felt_.transpose()));
  R_felt_ = view.X_WG_hand.R;
  feel_.twist_Nm += share * (axis_W_.dot(F.tau) - feel_.twist_Nm);
  if (isScrew() && isInserting()) {
    feel_.spin_rad += turned_rad;
    handle_rad_ += turned_rad;
    feel_.lean_rad =
        across(rotationVector(view.X_WG_hand.R * X_target.R.transpose() * spun(feel_.spin_rad).transpose()));
  }
  if (sight_.hasSeen()) {
    const double short_m = axis_W_.dot(X_target.p - seenGrasp().p);
    if (feel_.seen_for_s == 0) feel_.seen_short_m = short_m;
    feel_.seen_for_s += dt_s;
    feel_.seen_short_m += std::min(1.0, dt_s / kSoon_s) * (short_m - feel_.seen_short_m);
  } else {
    feel_.seen_short_m = -feel_.along_m;
  }
  if (is_new && phase_ == OperatorPhase::Reach) correctOnTheWay(1 / habits_.see_rate_hz);
}

// Offset of the leading end from the grasp across the axis, in the part's attitude R_WG.
Vec3 VirtualOperator::Person::tipFromGrasp(const Mat3& R_WG) const noexcept {
  return path_.empty() ? Vec3(Vec3::Zero()) : across(tip_m_ * (R_WG * goal().R.transpose() * axis_W_));
}

// Offset of the leading end from the line through the target, as seen.
Vec3 VirtualOperator::Person::seenTip() const noexcept {
  const Pose X_seen = seenGrasp();
  return across(X_seen.p - goal().p) + tipFromGrasp(X_seen.R);
}

// Integral control of the seen error across the path. Along the path the error is only the delay of sight.
void VirtualOperator::Person::correctOnTheWay(double dt_s) noexcept {
  const Pose X_seen = seenGrasp();
  const Vec3 leg = segment_.X_to.p - segment_.X_from.p;
  const double length2 = leg.squaredNorm(), late_s = feel_.time_s - habits_.see_delay_s;
  const double share = length2 < 1e-18
                           ? minimumJerk((late_s - segment_.start_s) / segment_.duration_s)
                           : std::clamp(leg.dot(X_seen.p - segment_.X_from.p) / length2, 0.0, 1.0);
  const Pose X_path = interpolate(segment_.X_from, segment_.X_to, share);
  const Vec3 along = length2 < 1e-18 ? axis_W_ : Vec3(leg.normalized());
  Vec3 error_m = X_path.p - X_seen.p;
  error_m -= along * along.dot(error_m);
  const double gain = habits_.see_gain_per_s * dt_s;
  belief_.across_m = shortened(belief_.across_m + gain * error_m, seeLimit_m());
  belief_.turn_rad =
      shortened(belief_.turn_rad + gain * rotationVector(X_path.R * X_seen.R.transpose()), seeLimit_rad());
}

// The gain falls as 1/t, so that all pictures are averaged. A small tilt displaces the end of a slender part
// by much, and a hand that followed the delayed picture would sway. For a slender part the operator averages,
// over all pictures, the position of the hole relative to the end as felt at the same time, and moves the end
// there by touch.
void VirtualOperator::Person::correctAtTheHole(double dt_s) noexcept {
  if (!sight_.hasSeen()) return;
  const Pose X_seen = seenGrasp(), &X_to = goal();
  const Vec3 tip_m = seenTip();
  const Mat3 R_path = spun(feel_.spin_rad) * turnAtTheHole(axis_W_.dot(X_seen.p - X_to.p));
  const Vec3 lean_rad = tiltOf(rotationVector(R_path * X_seen.R.transpose()));
  seen_for_s_ += dt_s;
  const double gain =
      dt_s * habits_.see_gain_per_s * std::max(kLeastGain, 1 / (1 + habits_.see_gain_per_s * seen_for_s_));
  const bool is_before_hole = sequence().strategy() != OperatorStrategy::PlaceBySight;
  if (!isSlender() || !is_before_hole) {
    belief_.across_m -= gain * tip_m;
    belief_.turn_rad += gain * lean_rad;
  } else {
    hole_seen_for_s_ += dt_s;
    hole_m_ += dt_s / hole_seen_for_s_ * (sight_.felt_m() - tip_m - hole_m_);
    const Vec3 home_m = -std::min(1.0, kHome_per_s * dt_s) * feel_.tip_m;
    belief_.across_m += home_m;
    belief_.turn_rad += depth_m() > kPivots_m ? turnAboutMouth(home_m) : Vec3(gain * lean_rad);
  }
  belief_.across_m = shortened(belief_.across_m, seeLimit_m());
  belief_.turn_rad = shortened(belief_.turn_rad, seeLimit_rad());
}

// The belief follows the hand, which contact pushes aside, until side force and torque vanish. The hand does
// not yield to the tilt of a slender part before the hole guides it: a pushed part would fall over on its
// end.
void VirtualOperator::Person::giveWay(double dt_s) noexcept {
  const double share = std::min(1.0, kGiveWay_per_s * dt_s);
  const Pose& X_to = goal();
  const Pose X_wanted = wantedAtTheHole();
  double guided = 1;
  if (isSlender()) {
    const Vec3 wanted_tip_m = across(X_wanted.p - X_to.p) + tipFromGrasp(X_wanted.R);
    belief_.across_m += share * (tip_felt_m_ - across(sag_m_) - wanted_tip_m);
    guided = std::clamp(depth_m() / (kGuided * tip_m_), 0.0, 1.0);
  } else {
    belief_.across_m += share * across(X_to.p + feel_.across_m - sag_m_ - X_wanted.p);
  }
  belief_.turn_rad += guided * share * tiltOf(rotationVector(feel_.R_hand * X_wanted.R.transpose()));
  belief_.across_m = shortened(belief_.across_m, seeLimit_m());
  belief_.turn_rad = shortened(belief_.turn_rad, seeLimit_rad());
  serve_m_ -= share * serve_m_;
  serve_rad_ -= share * serve_rad_;
}

// --- Hand

Pose VirtualOperator::Person::wanted(double now_s) const noexcept {
  if (isInserting()) return wantedAtTheHole();
  if (phase_ != OperatorPhase::Reach) return X_rest_;
  const double share = minimumJerk((now_s - segment_.start_s) / segment_.duration_s);
  Pose X = interpolate(segment_.X_from, segment_.X_to, share);
  // The aim error grows over the last free segment; it models an error of the believed position of the hole.
  const double aim = next_ + 2 == path_.size() && !has_aimed_ ? share : 0;
  X.p += aim * aim_m_ + belief_.across_m;
  X.R = rotationFromVector(aim * aim_rad_ + belief_.turn_rad) * X.R;
  return X;
}

// The attitude of the path at position `along_m` of the leg; for a leg that only turns, at the present time.
Mat3 VirtualOperator::Person::turnAtTheHole(double along_m) const noexcept {
  const Pose &X_from = path_[goal_ - 1], &X_to = goal();
  const double length_m = (X_to.p - X_from.p).norm();
  const double share = length_m > 1e-9 ? std::clamp(1 + along_m / length_m, 0.0, 1.0)
                                       : minimumJerk((feel_.time_s - segment_.start_s) / segment_.duration_s);
  return interpolate(X_from, X_to, share).R;
}

// Rotates about the leading end, so that a tilt does not move that end.
Pose VirtualOperator::Person::wantedAtTheHole() const noexcept {
  const Move& move = sequence().present().move();
  const Pose& X_to = goal();
  const Mat3 turn = rotationFromVector(belief_.turn_rad + move.turn_rad + turnAboutMouth(move.across_m));
  const Vec3 tip = tip_m_ * axis_W_;
  Vec3 p = X_to.p + belief_.across_m + move.across_m + tip - turn * tip;
  p += axis_W_ * (reach_m_ - axis_W_.dot(p - X_to.p));
  return {Mat3(turn * spun(spin_rad_) * turnAtTheHole(reach_m_)), p};
}

// A slender part that is in one hole and before the next one turns about the first hole to displace its end.
Vec3 VirtualOperator::Person::turnAboutMouth(const Vec3& end_m) const noexcept {
  return depth_m() > kPivots_m ? Vec3(axis_W_.cross(end_m) / depth_m()) : Vec3(Vec3::Zero());
}

// Integral control of the hand's position, against friction of the device.
void VirtualOperator::Person::serve(const Pose& X_wanted, const Pose& X_hand, double dt_s) noexcept {
  constexpr double kGain_per_s = 5, kLimit_m = 1.5e-3, kLimit_rad = 0.02;
  if (!isInserting() || is_home_) return;
  if (sequence().present().move().gives_way) return;
  serve_m_ = shortened(serve_m_ + kGain_per_s * dt_s * across(X_wanted.p - X_hand.p), kLimit_m);
  serve_rad_ = shortened(serve_rad_ + kGain_per_s * dt_s * rotationVector(X_wanted.R * X_hand.R.transpose()),
                         kLimit_rad);
}

Pose VirtualOperator::Person::limited(const Pose& X_wanted, const Pose& X_hand) const noexcept {
  const Vec3 pull_m = shortened(X_wanted.p - X_hand.p, habits_.force_limit_N / habits_.k_N_per_m);
  const Vec3 twist_rad = shortened(rotationVector(X_wanted.R * X_hand.R.transpose()),
                                   habits_.torque_limit_Nm / habits_.k_Nm_per_rad);
  return {Mat3(rotationFromVector(twist_rad) * X_hand.R), Vec3(X_hand.p + pull_m)};
}

// Lag of the muscles: a critically damped second-order filter, solved implicitly, from the wanted pose to the
// equilibrium.
void VirtualOperator::Person::follow(const Pose& X_wanted, double dt_s) noexcept {
  const double omega = habits_.lag_rad_s, implicit = 1 / ((1 + dt_s * omega) * (1 + dt_s * omega));
  const double spring = dt_s * omega * omega;
  V_eq_.v = implicit * (V_eq_.v + spring * (X_wanted.p - X_eq_.p));
  V_eq_.w = implicit * (V_eq_.w + spring * rotationVector(X_wanted.R * X_eq_.R.transpose()));
  X_eq_ = Pose(Quat(rotationFromVector(dt_s * V_eq_.w) * X_eq_.R), Vec3(X_eq_.p + dt_s * V_eq_.v));
}

HandForce VirtualOperator::Person::impedance() const noexcept {
  HandForce hand = evenHand(habits_);
  hand.X_eq = X_eq_;
  hand.V_eq = V_eq_;
  const auto damping = [this](double k) { return handDamping(habits_, k, habits_.mass_kg); };
  const double k = habits_.k_N_per_m, k_across = isInserting() ? habits_.k_lateral_share * k : k;
  const Mat3 along = axis_W_ * axis_W_.transpose(), across = Mat3::Identity() - along;
  hand.k_N_per_m = k * along + k_across * across;
  hand.b_Ns_per_m = damping(k) * along + damping(k_across) * across;
  // The hand carries a heavy part until it has released it; a light part rests on its stop meanwhile.
  const bool has_done = phase_ == OperatorPhase::Done && sag_m_.isZero();
  if (phase_ != OperatorPhase::Idle && !has_done) hand.F.f = -task_.weight_W;
  return hand;
}

}  // namespace vps::device
