// SPDX-License-Identifier: BSD-3-Clause
// The dual-arm device of the paper's section 3: kinematics and statics as pure functions.
//
//      left arm                 handle                 right arm        D: origin at the workspace's centre,
//   base o==========>(P_L)--|====E=====|--(P_R)<==========o base           y from left to right, z up
//          d3, t1, t2  gimbal  H, motor    gimbal   t2, t1, d3
//
// Source: [Tripicchio et al., section 3], with the corrections of signs and of the motor's reaction that are
// derived beside the code and checked by power in the tests.
#pragma once

#include <Eigen/Core>

#include "vps/pose.h"
#include "vps/status.h"
#include "vps/wrench.h"

namespace vps {

/// All numbers of the device. `sourced`: in the paper. `assumed`: not in the paper; the reason stands beside
/// it.
struct DualArmParameters {
  // Workspace of the handle's origin, centred at D's origin.
  Vec3 workspace_m = Vec3(0.4, 0.6, 0.4);  ///< sourced: Table 1; assumed: the 600 mm lie along the prismatic
                                           ///< joints, since the frustum's base is square
  // Geometry.
  double handle_m = 0.2;  ///< L, between gimbal centres. assumed: one arm's worst 5 N times L is the worst
                          ///< torque of Table 1, 1 N m
  double base_m = 0.85;   ///< from D's origin to each base. assumed: nearest gimbal centre stays 0.45 m away
  double reach_min_m = 0.40;  ///< d3. assumed: workspace and any direction of the handle, with 50 mm to spare
  double reach_max_m = 1.35;  ///< d3. assumed: as above
  double plate_max_rad = 0.80;  ///< |t1|, |t2|. assumed: needed for the workspace, with 0.1 rad to spare
  double q2_max_rad =
      1.2695;               ///< assumed: leaves 4 pi sin(q2_max) = 12 sr of handle directions, as in Table 1
  double q3_max_rad = 2.6;  ///< assumed: cable of the handle's motor
  double link_radius_m = 0.015;   ///< of a prismatic link, for `armClearance_m`. assumed: a tube
  Vec3 p_EH = Vec3(0, -0.01, 0);  ///< from the midpoint (1) to the centre of mass H, in E. assumed: the motor
                                  ///< sits at the left end
  // Mass and friction.
  double handle_kg = 0.2;  ///< sourced: section 3
  Vec3 handle_kgm2 =
      Vec3(8e-4, 4e-5, 8e-4);  ///< about H, along E's axes. assumed: a rod of 0.2 m and 20 mm radius
  double plate_kgm2 = 0.08;  ///< of plate, link and balance weight, each axis. assumed: 0.15 kg at mid reach
  double link_kg = 0.25;     ///< prismatic link with its tendon drive. assumed: aluminium tube of 1 m
  double rotor_kgm2 = 2e-5;  ///< handle motor with its gear. assumed: a 20 mm motor
  double plate_damping_Nms = 2.0;      ///< per axis, N m s/rad. assumed: motors with shorted-winding damping,
                                       ///< chosen so that K = 2 kN/m is passive at 1 kHz
  double link_damping_Ns_per_m = 2.5;  ///< assumed: as above
  double rotor_damping_Nms = 0.012;    ///< assumed: as above, for 4 N m/rad
  double plate_coulomb_Nm = 0.10;      ///< assumed: capstans, no gears: about 0.1 N at the handle
  double link_coulomb_N = 0.10;        ///< assumed: as above
  double rotor_coulomb_Nm = 0.002;     ///< assumed: a small gear
  // Encoders: one step.
  double plate_step_rad =
      7.85e-5;                 ///< assumed: 80,000 counts a turn behind the capstan; gives Table 1's 100 um
  double link_step_m = 50e-6;  ///< assumed: finer than what the plates give
  double rotor_step_rad = 5.1e-4;  ///< assumed: 2048 counts a turn of the motor behind a capstan of 6
  double resolution_m = 100e-6;    ///< at the handle, worst case. sourced: Table 1
  double resolution_rad =
      0.001;  ///< within 45 deg of straight. assumed: Table 1's 0.005 is the worst, at q2_max
  // Motors: continuous and peak.
  double plate_torque_Nm = 7.7,
         plate_peak_Nm = 18.5;  ///< assumed: 14 N upward of the pair anywhere in the workspace,
                                ///< less the handle's 2 N leaves figure 5's 12 N; 2.4 times peak
  double link_force_N = 7.0, link_peak_N = 17.0;      ///< assumed: as above
  double rotor_torque_Nm = 1.0, rotor_peak_Nm = 2.5;  ///< assumed: Table 1's worst torque holds about Y too
  double force_N = 12.5, force_peak_N = 30.0;         ///< on the handle. sourced: Table 1
  double torque_Nm = 1.0, torque_peak_Nm = 2.5;       ///< on the handle. sourced: Table 1, worst case
};

/// Joints of one arm: t1, t2 [rad] of the plate and the prismatic d3 [m].
struct ArmJoints {
  double t1_rad = 0;
  double t2_rad = 0;
  double d3_m = 0;
};

/// All that the device measures; q1 and q2 of the gimbal follow from it.
struct DualArmJoints {
  ArmJoints left, right;
  double q3_rad = 0;  ///< handle motor
};

enum class Side { Left, Right };

/// Seven values in joint order: left t1, t2, d3, right t1, t2, d3, q3. Rates [rad/s, m/s] or efforts [N m,
/// N].
using JointVector = Eigen::Matrix<double, 7, 1>;
using JointMatrix = Eigen::Matrix<double, 7, 6>;  ///< joint rates from a twist (w, v)

// --- One arm, in its base frame A: x towards the other arm, z up
// --------------------------------------------------

/// p = d3 (c2 c1, c2 s1, s2).
Vec3 armPosition(const ArmJoints& joints) noexcept;

/// Joints that reach p_A, t2 within +-90 deg. Singular (zero joints) at p_A = 0 or on the z axis; BadPose if
/// not finite.
[[nodiscard]] Status armInverse(const Vec3& p_A, ArmJoints& joints) noexcept;

/// dp/d(t1, t2, d3), singular at t2 = +-90 deg.
Mat3 armJacobian(const ArmJoints& joints) noexcept;

/// Angular velocity of the barrel by (t1, t2, d3) rates.
Mat3 armAngularJacobian(const ArmJoints& joints) noexcept;

/// Base frame of an arm in D. assumed: the arms face each other along D's y.
Pose armBase(const DualArmParameters& parameters, Side side) noexcept;

/// R_D3 of the left barrel. assumed: it turns with the plate, and at t1 = t2 = q = 0 the handle's axes are
/// D's.
Mat3 barrelRotation(const DualArmParameters& parameters, const ArmJoints& left) noexcept;

// --- Handle
// -------------------------------------------------------------------------------------------------------

/// R_3E, the paper's (6).
Mat3 gimbalRotation(double q1_rad, double q2_rad, double q3_rad) noexcept;

/// Gimbal angles from Y_EE in the barrel's frame, the paper's (7) with its sign put right in the whole plane.
/// Singular when |q2| = 90 deg (q1 then zero).
[[nodiscard]] Status gimbalAngles(const Vec3& Y_3, double& q1_rad, double& q2_rad) noexcept;

/// Pose of the handle H (centre of mass) in D from measured joints, (1) to (8). The gimbal centres' distance
/// need not be exactly L (quantised joints). BadPose or Singular leave X_DH untouched.
[[nodiscard]] Status handlePose(const DualArmParameters& parameters, const DualArmJoints& joints,
                                Pose& X_DH) noexcept;

/// Joints that put the handle at X_DH, q3 within +-180 deg. BadPose or Singular leave joints untouched.
[[nodiscard]] Status handleJoints(const DualArmParameters& parameters, const Pose& X_DH,
                                  DualArmJoints& joints) noexcept;

/// Joint rates from the handle's twist (w, v of H, in D): rates = J V. Wrenches follow by power: (tau, f) =
/// J^T efforts. Singular at |q2| = 90 deg or |t2| = 90 deg.
[[nodiscard]] Status handleJacobian(const DualArmParameters& parameters, const Pose& X_DH,
                                    JointMatrix& J) noexcept;

/// True if every joint, q2 too, is within its range and the arms keep apart.
bool isReachable(const DualArmParameters& parameters, const Pose& X_DH) noexcept;

/// Free distance between the two prismatic links, as capsules [m]; negative when they meet.
double armClearance_m(const DualArmParameters& parameters, const DualArmJoints& joints) noexcept;

// --- Statics
// ------------------------------------------------------------------------------------------------------

/// Motor efforts that give the wrench F_Ho_D to the hand with the handle at X_DH; no squeeze along the handle
/// beyond f/2 on each side. Status as handleJacobian; efforts then zero.
[[nodiscard]] Status motorEfforts(const DualArmParameters& parameters, const Pose& X_DH, const Wrench& F_Ho_D,
                                  JointVector& efforts) noexcept;

/// The wrench that motor efforts give to the hand, by the balance of the arms and the gimbal.
[[nodiscard]] Status handleWrench(const DualArmParameters& parameters, const Pose& X_DH,
                                  const JointVector& efforts, Wrench& F_Ho_D) noexcept;

/// Greatest factor s in [0, 1] such that |bias + s wanted| keeps within `limit` for each motor. Zero if the
/// bias alone does not. Scaling the whole wrench keeps its direction.
double saturationScale(const JointVector& bias, const JointVector& wanted, const JointVector& limit) noexcept;

/// Motor limits; share 0 continuous, 1 peak, linear between.
JointVector motorLimits(const DualArmParameters& parameters, double peak_share) noexcept;

}  // namespace vps
