// SPDX-License-Identifier: BSD-3-Clause
// A virtual operator: a hand with habits, not a script. It sees the part, feels the wrench, and pulls the
// handle by a spring-damper towards an equilibrium that follows minimum-jerk segments.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "vps_device/export.h"
#include "vps_device/hand_force.h"
#include "vps_device/random.h"

namespace vps::device {

/// The hand and its habits. Impedance: order of magnitude of [Mussa-Ivaldi, Hogan and Bizzi 1985; Dolan,
/// Friedman and Nagurka 1993; Tsuji et al. 1995; Speich, Shao and Goldfarb 2005]; all values assumed within
/// it.
struct OperatorHabits {
  std::uint64_t seed = 1;
  double aim_error_m = 0.3e-3;  ///< standard deviation across the path, each axis
  double aim_error_rad = 0.005;
  double speed_m_s = 0.05;    ///< average along the path
  double turn_rad_s = 0.5;    ///< average rotation
  double press_N = 5;         ///< presses home with this
  double force_limit_N = 15;  ///< never pulls or pushes its spring beyond this
  double torque_limit_Nm = 0.8;
  double k_N_per_m = 700;        ///< translation
  double k_lateral_share = 0.5;  ///< of k across the axis while inserting: relaxed, so that chamfers guide
  double k_Nm_per_rad = 3;
  double damping_ratio = 0.7;
  double mass_kg = 1.5;  ///< of hand and forearm, as felt at the handle
  double inertia_kgm2 = 0.004;
  double insert_share = 0.5;    ///< of speed_m_s while inserting
  double lag_rad_s = 40;        ///< natural frequency of the muscles' lag, critically damped
  double see_rate_hz = 60;      ///< the picture's rate
  double see_delay_s = 0.1;     ///< from light to correction, at most 1 s
  double see_gain_per_s = 2.5;  ///< integral correction of the seen error
  double see_limit_m = 3e-3;    ///< bound of that correction
  double see_limit_rad = 0.05;
  double stuck_s = 0.4;         ///< without progress while pushing: try another way
  double progress_m = 0.05e-3;  ///< what counts as progress in that time
  double back_off_m = 1e-3;
  double search_m = 0.06e-3;  ///< spiral step of a retry
  double search_rad = 0.003;
  double press_s = 0.3;
  double rest_m_s = 1e-3;   ///< slower counts as held
  double still_m_s = 1e-4;  ///< slower, at the part's origin, counts as still: then the hand opens
  double still_rad_s = 5e-3;
};

/// The hand's damping of a spring k against an inertia m: N s/m of N/m and kg, N m s/rad of N m/rad and kg
/// m^2.
VPS_DEVICE_API double handDamping(const OperatorHabits& habits, double k, double m) noexcept;
/// Such a hand, as stiff in every direction, about the identity.
VPS_DEVICE_API HandForce evenHand(const OperatorHabits& habits) noexcept;

/// One step of a procedure, for the hand. The hand holds the part at the grasp frame G, fixed in the part P;
/// best at the part's centre of mass, whose weight it then carries without torque.
struct OperatorTask {
  Pose X_WP_start;
  std::vector<Pose> way_points;  ///< X_WP; the last is where insertion begins (the start, if there are none)
  /// Way points (their indices) at which the device is at its border: the hand stops there and takes anew.
  std::vector<std::size_t> index_points;
  Pose X_WP_target;
  Pose X_PG;
  double tolerance_m = 0.1e-3;  ///< part's origin against the target
  double tolerance_rad = 0.01;
  double timeout_s = 20;
  Vec3 weight_W =
      Vec3::Zero();  ///< mass times gravity of the part, which the hand carries by feed-forward [N]
};

/// What the hand senses now.
struct OperatorView {
  double time_s = 0;
  Pose
      X_WG_hand;  ///< where the hand holds the grasp frame (the coupling's proxy), not delayed: one's own arm
  Twist V_WG_hand;
  Pose X_WP;  ///< the part; the operator samples and delays it itself
  Twist V_WP;
  Wrench F_hand_W;  ///< felt: wrench of the device on the hand
};

/// Regrasp: at a way point of OperatorTask::index_points, holding still until goOn().
enum class OperatorPhase { Idle, Reach, Insert, Press, Done, Failed, Regrasp };
VPS_DEVICE_API const char* toText(OperatorPhase phase) noexcept;

/// Minimum jerk from 0 to 1 over s in [0, 1]: 10 s^3 - 15 s^4 + 6 s^5, clamped outside. Source: [Flash and
/// Hogan 1985].
VPS_DEVICE_API double minimumJerk(double s) noexcept;
/// Its derivative by s.
VPS_DEVICE_API double minimumJerkRate(double s) noexcept;

/// Same seed, task and views: same bits.
class VPS_DEVICE_API VirtualOperator {
 public:
  explicit VirtualOperator(const OperatorHabits& habits = {});

  /// Takes a task at time now_s. May allocate. Each call draws a new aim error.
  void begin(const OperatorTask& task, double now_s);

  /// One instant of the hand, at G in W, dt_s after the last. Never throws or allocates. A view that is not
  /// finite gives the last answer without feed-forward.
  HandForce step(const OperatorView& view, double dt_s) noexcept;

  /// From Regrasp, with the hand elsewhere and the part where it was: to the next way point. Never throws or
  /// allocates.
  void goOn() noexcept;

  [[nodiscard]] OperatorPhase phase() const noexcept { return phase_; }
  [[nodiscard]] int retries() const noexcept { return retries_; }
  [[nodiscard]] const OperatorHabits& habits() const noexcept { return habits_; }

 private:
  struct Segment {
    Pose X_from, X_to;  // of G
    double start_s = 0, duration_s = 1;
  };
  struct Seen {
    double time_s = 0;
    Pose X_WP;
    Twist V_WP;
  };

  void startSegment(const Pose& X_from, const Pose& X_to, double speed_share, double now_s) noexcept;
  void startInsertion(double now_s) noexcept;
  void enter(OperatorPhase phase, double now_s) noexcept;
  void look(const OperatorView& view) noexcept;
  void correct(double dt_s) noexcept;
  void decide(const OperatorView& view, double dt_s) noexcept;
  void reach(double now_s) noexcept;
  void insert(const OperatorView& view, double dt_s) noexcept;
  void press(double now_s) noexcept;
  void retry(double now_s) noexcept;
  void finish(OperatorPhase phase, const OperatorView& view) noexcept;
  void follow(const Pose& X_wanted, double dt_s) noexcept;
  [[nodiscard]] Pose wanted(double now_s) const noexcept;
  [[nodiscard]] Pose limited(const Pose& X_wanted, const Pose& X_hand) const noexcept;
  [[nodiscard]] HandForce impedance() const noexcept;
  [[nodiscard]] Pose seenGrasp() const noexcept { return seen_now_.X_WP * task_.X_PG; }
  [[nodiscard]] double progressOf(const Pose& X_WG) const noexcept;
  [[nodiscard]] double shortfall_m() const noexcept;
  [[nodiscard]] double pushLimit_N() const noexcept;
  [[nodiscard]] bool isOnTarget(double share = 1) const noexcept;
  [[nodiscard]] bool isAtRest() const noexcept;
  [[nodiscard]] bool isInserting() const noexcept;

  static constexpr std::size_t kSeenCount = 64;  // pictures in the delay line

  OperatorHabits habits_;
  Random random_;
  OperatorTask task_;
  OperatorPhase phase_ = OperatorPhase::Idle;
  double begin_s_ = 0, phase_s_ = 0;

  // The plan.
  std::vector<Pose> path_;  // of G: start, way points, target
  std::size_t next_ = 0;    // index in path_ of the segment's end
  Segment segment_;
  Vec3 axis_W_ = Vec3::UnitZ();                               // direction of insertion
  Vec3 aim_m_ = Vec3::Zero(), aim_rad_ = Vec3::Zero();        // error of aim, drawn once a task
  Vec3 fix_m_ = Vec3::Zero(), fix_rad_ = Vec3::Zero();        // correction by sight
  Vec3 search_m_ = Vec3::Zero(), search_rad_ = Vec3::Zero();  // offset of the present retry
  double push_N_ = 0;                                         // along the axis, beyond the planned pose
  double retreat_until_s_ = 0, progress_m_ = 0, progress_s_ = 0;
  bool has_stop_ = true;  // something to press against, until seen otherwise
  int retries_ = 0;

  // The hand.
  bool has_view_ = false;
  Pose X_eq_;  // equilibrium, after the muscles' lag
  Twist V_eq_;
  Pose X_hold_;  // where it rests when there is nothing to do

  // The eyes.
  std::array<Seen, kSeenCount> pictures_{};
  std::size_t picture_count_ = 0;
  double next_look_s_ = 0;
  Seen seen_now_;  // the picture that has reached the mind by now
};

}  // namespace vps::device
