// SPDX-License-Identifier: BSD-3-Clause
// A virtual operator: a model of a hand. It sees the part, feels the wrench, and pulls the handle by a
// spring-damper towards an equilibrium that follows minimum-jerk segments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "vps_device/export.h"
#include "vps_device/simulated_device.h"

namespace vps::device {

/// Parameters of the hand. Impedance: order of magnitude of [Mussa-Ivaldi, Hogan and Bizzi 1985; Dolan,
/// Friedman and Nagurka 1993; Tsuji et al. 1995; Speich, Shao and Goldfarb 2005]; all values are assumed
/// within that order.
struct OperatorHabits {
  std::uint64_t seed = 1;
  double aim_error_m = 0.3e-3;  ///< standard deviation across the path, in each axis
  double aim_error_rad = 0.005;
  /// Greatest error about the axis of insertion. Sight does not correct it, since the part covers the hole.
  /// The error is drawn from a uniform distribution, once per task.
  double aim_turn_rad = 0;
  double speed_m_s = 0.05;    ///< average speed along the path
  double turn_rad_s = 0.5;    ///< average rotational speed
  double press_N = 5;         ///< final force at the target
  double force_limit_N = 15;  ///< limit of the hand's spring force
  double torque_limit_Nm = 0.8;
  double k_N_per_m = 700;  ///< translation
  /// Share of the stiffness across the axis while inserting: soft, so that chamfers guide the part.
  double k_lateral_share = 0.5;
  double k_Nm_per_rad = 3;
  double damping_ratio = 0.7;
  double mass_kg = 1.5;  ///< effective mass of hand and forearm at the handle
  double inertia_kgm2 = 0.004;
  double insert_share = 0.5;  ///< share of speed_m_s while inserting
  double lag_rad_s = 40;      ///< natural frequency of the muscles' lag, critically damped
  double see_rate_hz = 60;    ///< rate of visual samples
  /// Standard deviations and delay of sight. Position: a minute of arc, which normal eyes resolve, at 0.35 m.
  /// Rotation: the smallest visible rotation of a line [Regan and Price 1986: 0.2 to 0.5 degrees]. Delay:
  /// until a seen error is corrected [Saunders and Knill 2003: 0.12 to 0.16 s]. assumed: the values hold for
  /// a held part as well
  double see_error_m = 0.1e-3;
  double see_error_rad = 0.0035;
  double see_delay_s = 0.15;  ///< at most 1 s
  double fixation_s = 0.3;    ///< each fixation of the eye has a new error [Rayner 1998: 0.26 to 0.33 s]
  double see_gain_per_s = 2;  ///< initial gain of the correction of a seen error; later pictures are averaged
  double see_limit_m = 3e-3;  ///< bound of the correction of a seen error
  double see_limit_rad = 0.05;
  double stuck_s = 0.4;         ///< a pushed part without progress for this long is stuck
  double progress_m = 0.05e-3;  ///< a shorter advance is no progress
  double back_off_m = 1e-3;     ///< distance of withdrawal before another attempt
  double touch_N = 1;         ///< resistance that counts as touching. assumed: ten times what a finger feels
  double search_N = 1.5;      ///< push while searching. assumed: light, so that the part slides
  double tilt_rad = 0.1;      ///< tilt with which a corner is inserted first. assumed
  double search_m = 0.08e-3;  ///< pitch of the spiral. assumed: less than see_error_m
  double search_limit_m = 0.5e-3;  ///< greatest radius of the spiral: five times see_error_m
  double turn_limit_rad = 0.11;    ///< range of the search about the axis, to each side. assumed: 6 degrees
  double press_s = 0.3;
  double rest_m_s = 1e-3;   ///< a slower hand is at rest
  double still_m_s = 1e-4;  ///< a hand that is slower stands still, and releases the part
  double still_rad_s = 5e-3;
};

/// Damping of the hand for a spring k and an inertia m: [N s/m] for [N/m] and [kg], [N m s/rad] for [N m/rad]
/// and [kg m^2].
VPS_DEVICE_API double handDamping(const OperatorHabits& habits, double k, double m) noexcept;
/// A hand with equal stiffness in every direction, about the identity.
VPS_DEVICE_API HandForce evenHand(const OperatorHabits& habits) noexcept;

/// A part that is screwed on: it is turned about the axis of insertion, through G, and pushed lightly.
struct ScrewTask {
  /// Tilt that shows a crossed thread. An M16 nut that is crossed by half a pitch tilts by 3.6 degrees; a
  /// loose nut tilts by less than a degree within its play. assumed: a value between both tilts
  static constexpr double kCrossedLean_rad = 0.035;
  /// Tolerance of the advance per turn, as a share of the pitch. assumed: a part that skips threads or does
  /// not catch is off by more
  static constexpr double kOffPitch = 0.5;

  /// Advance of the part in one turn; positive for a right-hand thread; 0: the part is not screwed.
  double pitch_m = 0;
  double torque_Nm = 0;   ///< the part is tight at this torque; 0: turn it until it is seen at its target
  double handle_rad = 0;  ///< rotation of the handle to each side before it is re-grasped; 0: no limit
};

/// One step of a procedure. The hand holds the part at the grasp frame G, fixed in the part P. G is best at
/// the part's centre of mass, where the hand carries the weight without torque.
struct OperatorTask {
  Pose X_WP_start;
  /// poses X_WP; insertion begins at the last way point, or at the start if there are no way points
  std::vector<Pose> way_points;
  /// Indices of way points at which the device reaches its workspace limit: the hand stops there for
  /// indexing.
  std::vector<std::size_t> index_points;
  Pose X_WP_target;
  Pose X_PG;
  double tolerance_m = 0.1e-3;  ///< tolerance of the part's origin at the target
  double tolerance_rad = 0.01;
  double timeout_s = 20;
  Vec3 weight_W = Vec3::Zero();  ///< weight of the part [N], which the hand carries by feed-forward
  /// Visible shape of the part: the point of its leading end (the end that goes in first) that is farthest
  /// from the axis of insertion through G, in P. Zero: the point is not known, and the hand does not tilt the
  /// part.
  Vec3 tip_P = Vec3::Zero();
  /// Compliance between handle and part [m/N], which a person feels.
  double give_m_per_N = 0;
  /// The leading end is not round, so that it may have to be turned about the axis to find its hole.
  bool has_corners = false;
  /// The part starts in its place and is taken off. The hand follows every leg in the same way, without a
  /// search, a press or an aim error, since there is no hole at its end.
  bool is_taking_off = false;
  ScrewTask screw;
};

/// Displacement of a part below the hand that carries it, by the spring between them; the hand is held higher
/// by this displacement. Zero for a light part, whose displacement sight corrects.
VPS_DEVICE_API Vec3 sagBelowHand_m(const OperatorHabits& habits, const Vec3& weight_W,
                                   double give_m_per_N) noexcept;

/// State that the hand senses at one instant.
struct OperatorView {
  double time_s = 0;
  /// The grasp frame as the hand holds it (the coupling's proxy), without delay: the sense of the own arm.
  Pose X_WG_hand;
  Twist V_WG_hand;
  Pose X_WP;  ///< true pose of the part, which the operator samples and delays
  Twist V_WP;
  Wrench F_hand_W;  ///< wrench of the device on the hand
};

/// Regrasp (indexing): the hand has stopped at a way point of OperatorTask::index_points, or where the handle
/// turns no farther, and waits for goOn().
enum class OperatorPhase { Idle, Reach, Insert, Press, Done, Failed, Regrasp };
VPS_DEVICE_API const char* toText(OperatorPhase phase) noexcept;

/// The strategies of the hand while it inserts or presses, each with its name in results. A recording keeps
/// the number of the row, so that a new strategy takes the last row; a recording has room for 15 strategies.
#define VPS_OPERATOR_STRATEGIES(ROW)                                                                    \
  ROW(Approach, "approach")             /* moves ahead, guided by sight, until contact */               \
  ROW(Touch, "touch")                   /* pushes lightly and lets the part slide */                    \
  ROW(TiltIn, "tilt_in")                /* puts a corner in first, slides it, turns the part upright */ \
  ROW(SpiralSearch, "spiral_search")    /* slides on the surface in a spiral until the part drops */    \
  ROW(AlignByTorque, "align_by_torque") /* pushes, and yields to side force and torque */               \
  ROW(BackOff, "back_off")              /* withdraws, and looks again */                                \
  ROW(PressHome, "press_home")          /* presses against the stop that is felt */                     \
  ROW(PlaceBySight, "place_by_sight")   /* nothing stops the part: holds it where its target is seen */ \
  ROW(TurnSearch, "turn_search")        /* turns about the axis, to and fro, until the part drops */    \
  ROW(TurnBack, "turn_back")            /* turns against the thread until the part drops into it */     \
  ROW(ScrewOn, "screw_on")              /* turns the part onto the thread */

#define VPS_ENUMERATOR(Name, name) Name,
enum class OperatorStrategy { None, VPS_OPERATOR_STRATEGIES(VPS_ENUMERATOR) };
#undef VPS_ENUMERATOR
/// The name in results; "none" for None.
VPS_DEVICE_API const char* toText(OperatorStrategy strategy) noexcept;

/// Phase and strategy of the hand, which a recording keeps in one byte.
struct OperatorState {
  OperatorPhase phase = OperatorPhase::Idle;
  OperatorStrategy strategy = OperatorStrategy::None;
  friend bool operator==(const OperatorState&, const OperatorState&) = default;
};
constexpr std::uint8_t toByte(OperatorState state) noexcept {
  return static_cast<std::uint8_t>(static_cast<unsigned>(state.phase) | static_cast<unsigned>(state.strategy)
                                                                            << 4U);
}
constexpr OperatorState stateFromByte(std::uint8_t byte) noexcept {
  return {static_cast<OperatorPhase>(byte & 0xfU), static_cast<OperatorStrategy>(byte >> 4U)};
}

/// Minimum jerk from 0 to 1 over s in [0, 1]: 10 s^3 - 15 s^4 + 6 s^5, clamped outside. Source: [Flash and
/// Hogan 1985].
VPS_DEVICE_API double minimumJerk(double s) noexcept;
/// The derivative of minimumJerk() by s.
VPS_DEVICE_API double minimumJerkRate(double s) noexcept;

/// The same seed, task and views give the same results, bit for bit.
class VPS_DEVICE_API VirtualOperator {
 public:
  explicit VirtualOperator(const OperatorHabits& habits = {});
  VirtualOperator(VirtualOperator&&) noexcept;
  VirtualOperator& operator=(VirtualOperator&&) noexcept;
  ~VirtualOperator();

  /// Starts a task at time now_s. May allocate. Each call draws a new aim error.
  void begin(const OperatorTask& task, double now_s);

  /// The hand's impedance about G in W, dt_s after the last call. Never throws or allocates. For a view that
  /// is not finite it returns the last result without feed-forward.
  HandForce step(const OperatorView& view, double dt_s) noexcept;

  /// In Regrasp of a screw: the rotation vector of the handle, in W and from the middle of its range, at
  /// which it is to be grasped again. Zero otherwise.
  [[nodiscard]] Vec3 regraspTurn_rad() const noexcept;
  /// Continues from Regrasp to the next way point or turn; the hand has moved and the part has not.
  /// Never throws or allocates.
  void goOn() noexcept;

  [[nodiscard]] OperatorPhase phase() const noexcept;
  [[nodiscard]] OperatorStrategy strategy() const noexcept;
  /// How often the operator backed off to try again, in all searches of the task.
  [[nodiscard]] int retries() const noexcept;
  [[nodiscard]] const OperatorHabits& habits() const noexcept;

 private:
  class Person;
  std::unique_ptr<Person> person_;
};

}  // namespace vps::device
