// SPDX-License-Identifier: BSD-3-Clause
// A virtual operator: a model of a hand. It sees the part, feels the wrench, and pulls the handle by a
// spring-damper towards an equilibrium that follows minimum-jerk segments.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "vps_device/export.h"
#include "vps_device/hand_force.h"
#include "vps_device/random.h"

namespace vps::device::inline v0 {

/// Parameters of the hand. Impedance: order of magnitude of [Mussa-Ivaldi, Hogan and Bizzi 1985; Dolan,
/// Friedman and Nagurka 1993; Tsuji et al. 1995; Speich, Shao and Goldfarb 2005]; all values assumed within
/// it.
struct OperatorHabits {
  std::uint64_t seed = 1;
  double aim_error_m = 0.3e-3;  ///< standard deviation across the path, each axis
  double aim_error_rad = 0.005;
  double speed_m_s = 0.05;    ///< average along the path
  double turn_rad_s = 0.5;    ///< average rotation
  double press_N = 5;         ///< final force at the target
  double force_limit_N = 15;  ///< limit of the hand's spring force
  double torque_limit_Nm = 0.8;
  double k_N_per_m = 700;        ///< translation
  double k_lateral_share = 0.5;  ///< of k across the axis while inserting: compliant, so that chamfers guide
  double k_Nm_per_rad = 3;
  double damping_ratio = 0.7;
  double mass_kg = 1.5;  ///< of hand and forearm, as felt at the handle
  double inertia_kgm2 = 0.004;
  double insert_share = 0.5;    ///< of speed_m_s while inserting
  double lag_rad_s = 40;        ///< natural frequency of the muscles' lag, critically damped
  double see_rate_hz = 60;      ///< rate of visual samples
  double see_delay_s = 0.1;     ///< from light to correction, at most 1 s
  double see_gain_per_s = 2.5;  ///< integral correction of the seen error
  double see_limit_m = 3e-3;    ///< bound of that correction
  double see_limit_rad = 0.05;
  double stuck_s = 0.4;         ///< without progress while pushing: retry with an offset
  double progress_m = 0.05e-3;  ///< least progress in that time
  double back_off_m = 1e-3;
  double search_m = 0.06e-3;  ///< spiral step of a retry
  double search_rad = 0.003;
  double press_s = 0.3;
  double rest_m_s = 1e-3;   ///< slower counts as held
  double still_m_s = 1e-4;  ///< slower, at the part's origin, counts as still: then the hand releases
  double still_rad_s = 5e-3;
};

/// The hand's damping of a spring k against an inertia m: N s/m of N/m and kg, N m s/rad of N m/rad and kg
/// m^2.
VPS_DEVICE_API double handDamping(const OperatorHabits& habits, double k, double m) noexcept;
/// A hand with equal stiffness in every direction, about the identity.
VPS_DEVICE_API HandForce evenHand(const OperatorHabits& habits) noexcept;

/// One step of a procedure. The hand holds the part at the grasp frame G, fixed in the part P. G is best at
/// the part's centre of mass, where the hand carries the weight without torque.
struct OperatorTask {
  Pose X_WP_start;
  std::vector<Pose> way_points;  ///< X_WP; the last is where insertion begins (the start, if there are none)
  /// Indices of way points at which the device reaches its workspace limit: the hand stops there for
  /// indexing.
  std::vector<std::size_t> index_points;
  Pose X_WP_target;
  Pose X_PG;
  double tolerance_m = 0.1e-3;  ///< part's origin against the target
  double tolerance_rad = 0.01;
  double timeout_s = 20;
  Vec3 weight_W = Vec3::Zero();  ///< of the part [N], which the hand carries by feed-forward
};

/// What the hand senses at one instant.
struct OperatorView {
  double time_s = 0;
  /// The grasp frame as the hand holds it (the coupling's proxy); not delayed, as for one's own arm.
  Pose X_WG_hand;
  Twist V_WG_hand;
  Pose X_WP;  ///< the part; the operator itself samples and delays it
  Twist V_WP;
  Wrench F_hand_W;  ///< felt: wrench of the device on the hand
};

/// Regrasp: indexing. The hand stopped at a way point of OperatorTask::index_points and waits for goOn().
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

  /// Starts a task at time now_s. May allocate. Each call draws a new aim error.
  void begin(const OperatorTask& task, double now_s);

  /// The hand's impedance about G in W, dt_s after the last call. Never throws or allocates. For a view that
  /// is not finite it returns the last result without feed-forward.
  HandForce step(const OperatorView& view, double dt_s) noexcept;

  /// Continues from Regrasp to the next way point, with the hand elsewhere and the part unmoved. Never throws
  /// or allocates.
  void goOn() noexcept;

  [[nodiscard]] OperatorPhase phase() const noexcept { return phase_; }
  [[nodiscard]] int retries() const noexcept { return retries_; }
  [[nodiscard]] const OperatorHabits& habits() const noexcept { return habits_; }

 private:
  struct Segment {
    Pose X_from, X_to;  // of G
    double start_s = 0, duration_s = 1;
  };
  struct Picture {
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
  [[nodiscard]] Pose seenGrasp() const noexcept { return seen_.X_WP * task_.X_PG; }
  [[nodiscard]] double progressOf(const Pose& X_WG) const noexcept;
  [[nodiscard]] double shortfall_m() const noexcept;
  [[nodiscard]] double pushLimit_N() const noexcept;
  [[nodiscard]] bool isOnTarget(double share = 1) const noexcept;
  [[nodiscard]] bool isAtRest() const noexcept;
  [[nodiscard]] bool isInserting() const noexcept;

  static constexpr std::size_t kPictures = 64;  // in the delay line

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
  Vec3 aim_m_ = Vec3::Zero(), aim_rad_ = Vec3::Zero();        // aim error, drawn once per task
  Vec3 fix_m_ = Vec3::Zero(), fix_rad_ = Vec3::Zero();        // visual correction
  Vec3 search_m_ = Vec3::Zero(), search_rad_ = Vec3::Zero();  // offset of the present retry
  double push_N_ = 0;                                         // along the axis, beyond the planned pose
  double retreat_until_s_ = 0, progress_m_ = 0, progress_s_ = 0;
  bool has_stop_ = true;  // the target is assumed to be a stop until observed otherwise
  int retries_ = 0;

  // The hand.
  bool has_view_ = false;
  Pose X_eq_;  // equilibrium, after the muscles' lag
  Twist V_eq_;
  Pose X_rest_;  // equilibrium while there is no task

  // Vision.
  std::array<Picture, kPictures> pictures_{};
  std::size_t picture_count_ = 0;
  double next_look_s_ = 0;
  Picture seen_;  // the newest picture that is older than the delay
};

}  // namespace vps::device::inline v0
