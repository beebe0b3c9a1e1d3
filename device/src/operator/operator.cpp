// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/operator.h"

#include <algorithm>
#include <cmath>

namespace vps::device::inline v0 {
namespace {

constexpr double kMinSegment_s = 0.3;   // assumed: no aimed movement is shorter
constexpr double kArrived_m = 2e-3;     // distance from a way point that counts as reached
constexpr double kArrivalWait_s = 0.5;  // longest wait for that
constexpr double kRetreat_s = 0.25;
constexpr double kRamp_s = 0.2;            // of the press, up and down
constexpr double kPressRate_N_per_s = 10;  // growth of the push against resistance
constexpr double kCreep_per_s = 4;         // closes a free shortfall; times the visual delay well below 1
constexpr double kRestWait_s = 2;
constexpr double kFreeShare = 0.6;       // of the tolerance
constexpr double kResidualShare = 0.15;  // of the press, kept until release so that the part stays seated
constexpr double kGoldenAngle_rad = 2.399963229728653;  // spreads retries evenly in direction
constexpr int kSpiral = 12;  // retries before the spiral starts again at its centre

Vec3 shortened(const Vec3& v, double limit) {
  const double length = v.norm();
  return length > limit ? Vec3(v * (limit / length)) : v;
}

Pose between(const Pose& X_from, const Pose& X_to, double share) {
  const Vec3 turn = rotationVector(X_to.R * X_from.R.transpose());
  return {Mat3(rotationFromVector(share * turn) * X_from.R), Vec3(X_from.p + share * (X_to.p - X_from.p))};
}

}  // namespace

const char* toText(OperatorPhase phase) noexcept {
  switch (phase) {
    case OperatorPhase::Idle:
      return "idle";
    case OperatorPhase::Reach:
      return "reach";
    case OperatorPhase::Insert:
      return "insert";
    case OperatorPhase::Press:
      return "press";
    case OperatorPhase::Done:
      return "done";
    case OperatorPhase::Failed:
      return "failed";
    case OperatorPhase::Regrasp:
      return "index_point";
  }
  return "unknown";
}

double minimumJerk(double s) noexcept {
  s = std::clamp(s, 0.0, 1.0);
  return s * s * s * (10 + s * (-15 + 6 * s));
}

double minimumJerkRate(double s) noexcept {
  s = std::clamp(s, 0.0, 1.0);
  return 30 * s * s * (1 - s) * (1 - s);
}

VirtualOperator::VirtualOperator(const OperatorHabits& habits) : habits_(habits), random_(habits.seed) {}

void VirtualOperator::begin(const OperatorTask& task, double now_s) {
  task_ = task;
  path_.assign(1, task.X_WP_start * task.X_PG);
  for (const Pose& X_WP : task.way_points) path_.push_back(X_WP * task.X_PG);
  path_.push_back(task.X_WP_target * task.X_PG);

  const Vec3 last_leg = path_.back().p - path_[path_.size() - 2].p;
  axis_W_ = last_leg.norm() > 1e-9 ? Vec3(last_leg.normalized()) : Vec3(-Vec3::UnitZ());
  aim_m_ = habits_.aim_error_m * random_.normal3();
  aim_m_ -= axis_W_ * axis_W_.dot(aim_m_);
  aim_rad_ = habits_.aim_error_rad * random_.normal3();
  fix_m_ = fix_rad_ = search_m_ = search_rad_ = Vec3::Zero();
  push_N_ = 0;
  has_stop_ = true;
  retries_ = 0;
  has_view_ = false;  // the next view gives the hand's start
  picture_count_ = 0;
  next_look_s_ = begin_s_ = now_s;
  next_ = 1;
  phase_ = OperatorPhase::Reach;
}

HandForce VirtualOperator::step(const OperatorView& view, double dt_s) noexcept {
  const bool is_good = view.X_WG_hand.isFinite() && view.X_WP.isFinite() && view.V_WP.isFinite() &&
                       view.F_hand_W.isFinite() && std::isfinite(view.time_s) && dt_s > 0;
  if (!is_good) {
    HandForce blind = impedance();
    blind.F = {};
    return blind;
  }
  if (!has_view_) {
    has_view_ = true;
    X_eq_ = X_rest_ = view.X_WG_hand;
    V_eq_ = {};
    seen_ = {view.time_s, view.X_WP, view.V_WP};
    if (phase_ == OperatorPhase::Reach) {
      startSegment(X_eq_, path_[next_], 1, view.time_s);
      if (next_ + 1 == path_.size()) enter(OperatorPhase::Insert, view.time_s);
    }
  }
  look(view);
  decide(view, dt_s);
  follow(limited(wanted(view.time_s), view.X_WG_hand), dt_s);
  return impedance();
}

void VirtualOperator::goOn() noexcept {
  if (phase_ != OperatorPhase::Regrasp) return;
  fix_m_ = fix_rad_ = Vec3::Zero();  // the segment starts at the hand's pose
  has_view_ = false;
  phase_ = OperatorPhase::Reach;
}

// --- Plan
// ---------------------------------------------------------------------------------------------------------

void VirtualOperator::startSegment(const Pose& X_from, const Pose& X_to, double speed_share,
                                   double now_s) noexcept {
  const double length_m = (X_to.p - X_from.p).norm();
  const double turn_rad = rotationVector(X_to.R * X_from.R.transpose()).norm();
  segment_ = {X_from, X_to, now_s,
              std::max({kMinSegment_s, length_m / (speed_share * habits_.speed_m_s),
                        turn_rad / (speed_share * habits_.turn_rad_s)})};
}

void VirtualOperator::startInsertion(double now_s) noexcept {
  // From the seen pose, projected on the line: the visual correction removes the lateral error.
  const Pose &X_from = path_[path_.size() - 2], &X_to = path_.back();
  const double length_m = (X_to.p - X_from.p).norm();
  const double share = length_m > 1e-9 ? std::clamp(1 - shortfall_m() / length_m, 0.0, 1.0) : 0.0;
  startSegment(between(X_from, X_to, share), X_to, habits_.insert_share, now_s);
  progress_m_ = -shortfall_m();
  progress_s_ = now_s;
}

void VirtualOperator::enter(OperatorPhase phase, double now_s) noexcept {
  phase_ = phase;
  phase_s_ = now_s;
  if (phase == OperatorPhase::Insert) {
    next_ = path_.size() - 1;
    push_N_ = 0;
    startInsertion(now_s);
  }
}

Pose VirtualOperator::wanted(double now_s) const noexcept {
  if (phase_ != OperatorPhase::Reach && !isInserting()) return X_rest_;
  const double share = minimumJerk((now_s - segment_.start_s) / segment_.duration_s);
  Pose X = between(segment_.X_from, segment_.X_to, share);
  // The aim error grows over the last free segment; it models the misjudged position of the hole.
  double aim = 1;
  if (phase_ == OperatorPhase::Reach) aim = next_ + 2 == path_.size() ? share : 0;
  X.p += aim * aim_m_ + fix_m_;
  Vec3 turn = aim * aim_rad_ + fix_rad_;
  if (isInserting()) {
    X.p += search_m_ + axis_W_ * (push_N_ / habits_.k_N_per_m);
    turn += search_rad_;
    if (now_s < retreat_until_s_) {
      const double along_m = axis_W_.dot(X.p - path_.back().p);
      X.p -= axis_W_ * std::max(0.0, along_m - (progress_m_ - habits_.back_off_m));
    }
  }
  X.R = rotationFromVector(turn) * X.R;
  return X;
}

// --- Vision
// --------------------------------------------------------------------------------------------------------

void VirtualOperator::look(const OperatorView& view) noexcept {
  if (view.time_s < next_look_s_) return;
  const double period_s = 1 / habits_.see_rate_hz;
  next_look_s_ = view.time_s + period_s;
  pictures_[picture_count_++ % kPictures] = {view.time_s, view.X_WP, view.V_WP};
  const std::size_t stored = std::min(picture_count_, kPictures);
  for (std::size_t age = 0; age < stored; ++age) {
    const Picture& picture = pictures_[(picture_count_ - 1 - age) % kPictures];
    if (picture.time_s > view.time_s - habits_.see_delay_s) continue;
    seen_ = picture;
    break;
  }
  correct(period_s);
}

// Share of the present segment that a pose has covered; by time if the segment only rotates.
double VirtualOperator::progressOf(const Pose& X_WG) const noexcept {
  const Vec3 leg = segment_.X_to.p - segment_.X_from.p;
  const double length2 = leg.squaredNorm();
  if (length2 < 1e-18) return minimumJerk((seen_.time_s - segment_.start_s) / segment_.duration_s);
  return std::clamp(leg.dot(X_WG.p - segment_.X_from.p) / length2, 0.0, 1.0);
}

// Integral action on the seen error across the path. Along the path the error is only the visual delay.
void VirtualOperator::correct(double dt_s) noexcept {
  if (phase_ != OperatorPhase::Reach && !isInserting()) return;
  const Pose X_seen = seenGrasp();
  const Pose X_path = between(segment_.X_from, segment_.X_to, progressOf(X_seen));
  const Vec3 leg = segment_.X_to.p - segment_.X_from.p;
  const Vec3 along = isInserting() || leg.norm() < 1e-9 ? axis_W_ : Vec3(leg.normalized());
  Vec3 error_m = X_path.p - X_seen.p;
  error_m -= along * along.dot(error_m);
  const double gain = habits_.see_gain_per_s * dt_s;
  fix_m_ = shortened(fix_m_ + gain * error_m, habits_.see_limit_m);
  fix_rad_ =
      shortened(fix_rad_ + gain * rotationVector(X_path.R * X_seen.R.transpose()), habits_.see_limit_rad);
}

double VirtualOperator::shortfall_m() const noexcept {
  return axis_W_.dot(path_.back().p - seenGrasp().p);
}

bool VirtualOperator::isOnTarget(double share) const noexcept {
  const Pose& X = task_.X_WP_target;
  return (seen_.X_WP.p - X.p).norm() <= share * task_.tolerance_m &&
         rotationVector(seen_.X_WP.R * X.R.transpose()).norm() <= share * task_.tolerance_rad;
}

bool VirtualOperator::isAtRest() const noexcept {
  return seen_.V_WP.v.norm() < habits_.still_m_s && seen_.V_WP.w.norm() < habits_.still_rad_s;
}

bool VirtualOperator::isInserting() const noexcept {
  return phase_ == OperatorPhase::Insert || phase_ == OperatorPhase::Press;
}

// --- Decisions
// ----------------------------------------------------------------------------------------------------

void VirtualOperator::decide(const OperatorView& view, double dt_s) noexcept {
  if (phase_ != OperatorPhase::Reach && !isInserting()) return;
  if (view.time_s - begin_s_ > task_.timeout_s) return finish(OperatorPhase::Failed, view);
  if (phase_ == OperatorPhase::Reach) return reach(view.time_s);
  if (phase_ == OperatorPhase::Insert) return insert(view, dt_s);
  press(view.time_s);
  const double released_s =
      phase_s_ + (has_stop_ ? 2 * kRamp_s + habits_.press_s : 0) + habits_.see_delay_s + kRamp_s;
  if (phase_ != OperatorPhase::Press || view.time_s < released_s) return;
  if (!isOnTarget()) return enter(OperatorPhase::Insert, view.time_s);
  if (isAtRest() || view.time_s > released_s + kRestWait_s) finish(OperatorPhase::Done, view);
}

void VirtualOperator::reach(double now_s) noexcept {
  const double end_s = segment_.start_s + segment_.duration_s;
  if (now_s < end_s) return;
  const bool has_arrived = (seenGrasp().p - segment_.X_to.p).norm() < kArrived_m;
  if (!has_arrived && now_s < end_s + kArrivalWait_s) return;
  const auto& index_points = task_.index_points;
  if (std::find(index_points.begin(), index_points.end(), next_ - 1) != index_points.end()) {
    X_rest_ = wanted(now_s);
    ++next_;
    return enter(OperatorPhase::Regrasp, now_s);
  }
  if (++next_ + 1 == path_.size()) return enter(OperatorPhase::Insert, now_s);
  startSegment(segment_.X_to, path_[next_], 1, now_s);
}

void VirtualOperator::insert(const OperatorView& view, double dt_s) noexcept {
  const double now_s = view.time_s;
  if (now_s < retreat_until_s_) return;
  if (retreat_until_s_ > 0) {
    retreat_until_s_ = 0;
    startInsertion(now_s);
  }
  // A part that nothing stops may still drift, so it must be well within the tolerance.
  if (isOnTarget(has_stop_ ? 1 : kFreeShare)) return enter(OperatorPhase::Press, now_s);

  const double shortfall = shortfall_m(), limit_N = pushLimit_N();
  if (now_s > segment_.start_s + segment_.duration_s) {
    // At the end of the plan: push against resistance, or creep towards the target if the part is free.
    const bool is_held = shortfall > 0.5 * task_.tolerance_m && seen_.V_WP.v.norm() < habits_.rest_m_s;
    const double creep_N_per_s =
        std::clamp(habits_.k_N_per_m * kCreep_per_s * shortfall, -kPressRate_N_per_s, kPressRate_N_per_s);
    push_N_ += dt_s * (is_held ? kPressRate_N_per_s : creep_N_per_s);
    push_N_ = std::clamp(push_N_, -limit_N, limit_N);
  }

  // Stuck: nearly the whole push of this attempt is resisted, without progress.
  const double resistance_N = -axis_W_.dot(view.F_hand_W.f - task_.weight_W);
  const bool has_progress = -shortfall > progress_m_ + habits_.progress_m;
  if (has_progress) progress_m_ = -shortfall;
  if (has_progress || resistance_N < 0.6 * limit_N) progress_s_ = now_s;
  if (now_s - progress_s_ > habits_.stuck_s) retry(now_s);
}

// Backs off, and retries at the next offset of a spiral, with another tilt and a stronger push.
void VirtualOperator::retry(double now_s) noexcept {
  ++retries_;
  progress_m_ = -shortfall_m();
  retreat_until_s_ = now_s + kRetreat_s;
  push_N_ = 0;
  const int turn = (retries_ - 1) % kSpiral + 1;
  const Vec3 x = axis_W_.unitOrthogonal(), y = axis_W_.cross(x);
  const double angle_rad = turn * kGoldenAngle_rad, radius_m = habits_.search_m * std::sqrt(turn);
  search_m_ = radius_m * (std::cos(angle_rad) * x + std::sin(angle_rad) * y);
  search_rad_ = habits_.search_rad * random_.normal3();
}

double VirtualOperator::pushLimit_N() const noexcept {
  return std::min(habits_.force_limit_N, habits_.press_N * (1 + 0.5 * (retries_ % 5)));
}

void VirtualOperator::press(double now_s) noexcept {
  const double t = now_s - phase_s_, down_s = kRamp_s + habits_.press_s;
  if (!has_stop_) return;
  if (t < down_s && -shortfall_m() > task_.tolerance_m) {
    // The part yields: there is no stop to press against, so from now on it is only positioned.
    has_stop_ = false;
    return enter(OperatorPhase::Insert, now_s);
  }
  const double ramp = t < down_s ? minimumJerk(t / kRamp_s) : 1 - minimumJerk((t - down_s) / kRamp_s);
  push_N_ = habits_.press_N * (kResidualShare + (1 - kResidualShare) * ramp);
}

void VirtualOperator::finish(OperatorPhase phase, const OperatorView& view) noexcept {
  X_rest_ = view.X_WG_hand;
  enter(phase, view.time_s);
}

// --- Hand
// ---------------------------------------------------------------------------------------------------------

Pose VirtualOperator::limited(const Pose& X_wanted, const Pose& X_hand) const noexcept {
  Vec3 pull_m = X_wanted.p - X_hand.p;
  if (phase_ == OperatorPhase::Insert) {
    const double along_m = axis_W_.dot(pull_m);
    pull_m -= axis_W_ * std::max(0.0, along_m - pushLimit_N() / habits_.k_N_per_m);
  } else if (phase_ == OperatorPhase::Press && has_stop_) {
    // The stop sets the position, the hand only the force.
    pull_m += axis_W_ * (push_N_ / habits_.k_N_per_m - axis_W_.dot(pull_m));
  }
  pull_m = shortened(pull_m, habits_.force_limit_N / habits_.k_N_per_m);
  const Vec3 twist_rad = shortened(rotationVector(X_wanted.R * X_hand.R.transpose()),
                                   habits_.torque_limit_Nm / habits_.k_Nm_per_rad);
  return {Mat3(rotationFromVector(twist_rad) * X_hand.R), Vec3(X_hand.p + pull_m)};
}

// Muscle lag: a critically damped second-order filter, solved implicitly, between the wanted pose and the
// equilibrium.
void VirtualOperator::follow(const Pose& X_wanted, double dt_s) noexcept {
  const double omega = habits_.lag_rad_s, implicit = 1 / ((1 + dt_s * omega) * (1 + dt_s * omega));
  const double spring = dt_s * omega * omega;
  V_eq_.v = implicit * (V_eq_.v + spring * (X_wanted.p - X_eq_.p));
  V_eq_.w = implicit * (V_eq_.w + spring * rotationVector(X_wanted.R * X_eq_.R.transpose()));
  X_eq_ = Pose(Quat(rotationFromVector(dt_s * V_eq_.w) * X_eq_.R), Vec3(X_eq_.p + dt_s * V_eq_.v));
}

double handDamping(const OperatorHabits& habits, double k, double m) noexcept {
  return 2 * habits.damping_ratio * std::sqrt(k * m);
}

HandForce evenHand(const OperatorHabits& habits) noexcept {
  HandForce hand;
  hand.k_N_per_m = habits.k_N_per_m * Mat3::Identity();
  hand.b_Ns_per_m = handDamping(habits, habits.k_N_per_m, habits.mass_kg) * Mat3::Identity();
  hand.k_Nm_per_rad = habits.k_Nm_per_rad * Mat3::Identity();
  hand.b_Nms_per_rad = handDamping(habits, habits.k_Nm_per_rad, habits.inertia_kgm2) * Mat3::Identity();
  hand.mass_kg = habits.mass_kg;
  hand.inertia_kgm2 = habits.inertia_kgm2;
  return hand;
}

HandForce VirtualOperator::impedance() const noexcept {
  HandForce hand = evenHand(habits_);
  hand.X_eq = X_eq_;
  hand.V_eq = V_eq_;
  const auto damping = [this](double k) { return handDamping(habits_, k, habits_.mass_kg); };
  const double k = habits_.k_N_per_m, k_across = isInserting() ? habits_.k_lateral_share * k : k;
  const Mat3 along = axis_W_ * axis_W_.transpose(), across = Mat3::Identity() - along;
  hand.k_N_per_m = k * along + k_across * across;
  hand.b_Ns_per_m = damping(k) * along + damping(k_across) * across;
  const bool carries = phase_ != OperatorPhase::Idle && phase_ != OperatorPhase::Done;
  if (carries) hand.F.f = -task_.weight_W;
  return hand;
}

}  // namespace vps::device::inline v0
