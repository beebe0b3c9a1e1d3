// SPDX-License-Identifier: BSD-3-Clause
// The dual-arm device of the paper's section 3: kinematics and statics as pure functions.
//
//      left arm                 handle                 right arm        D: origin at the workspace's centre,
//   base o==========>(P_L)--|====E=====|--(P_R)<==========o base           y from left to right, z up
//          d3, t1, t2  gimbal  H, motor    gimbal   t2, t1, d3
//
// Source: [Tripicchio et al., section 3], with the corrections of signs and of the motor's reaction that are
// derived next to the code and checked by power in the tests.
#pragma once

#include <Eigen/Core>

#include "vps/errors.h"
#include "vps/pose.h"
#include "vps/wrench.h"
#include "vps_device/dual_arm/parameters.h"
#include "vps_device/export.h"

namespace vps::device {

/// Joints of one arm: t1, t2 [rad] of the plate and the prismatic d3 [m].
struct ArmJoints {
  double t1_rad = 0;
  double t2_rad = 0;
  double d3_m = 0;
};

/// All measured joints; q1 and q2 of the gimbal follow from them.
struct DualArmJoints {
  ArmJoints left, right;
  double q3_rad = 0;  ///< handle motor
};

enum class Side { Left, Right };

/// Seven values in joint order: left t1, t2, d3, right t1, t2, d3, q3. Rates [rad/s, m/s] or efforts [N m,
/// N].
using JointVector = Eigen::Matrix<double, 7, 1>;
using JointMatrix = Eigen::Matrix<double, 7, 6>;  ///< joint rates from a twist (w, v)

VPS_DEVICE_API JointVector toVector(const DualArmJoints& joints) noexcept;
VPS_DEVICE_API DualArmJoints fromVector(const JointVector& values) noexcept;

/// One value for each plate joint, sliding joint and the handle's motor, in joint order.
VPS_DEVICE_API JointVector jointVector(double plate, double link, double rotor) noexcept;

// --- One arm, in its base frame A: x towards the other arm, z up

/// p = d3 (c2 c1, c2 s1, s2).
VPS_DEVICE_API Vec3 armPosition(const ArmJoints& joints) noexcept;

/// Computes the joints that place the arm's end at p_A, with t2_rad within +-90 degrees. Singular at p_A = 0
/// or on the z axis, BadPose if p_A is not finite; the joints are then unchanged.
[[nodiscard]] VPS_DEVICE_API Status armInverse(const Vec3& p_A, ArmJoints& joints) noexcept;

/// dp/d(t1, t2, d3), singular at t2 = +-90 deg.
VPS_DEVICE_API Mat3 armJacobian(const ArmJoints& joints) noexcept;

/// Jacobian from the rates of (t1, t2, d3) to the barrel's angular velocity.
VPS_DEVICE_API Mat3 armAngularJacobian(const ArmJoints& joints) noexcept;

/// Base frame of an arm in D. assumed: the arms face each other along D's y; the right arm's base is as
/// calibrated.
VPS_DEVICE_API Pose armBase(const DualArmParameters& parameters, Side side) noexcept;

/// R_D3 of the left barrel. assumed: the barrel turns with the plate, and at t1 = t2 = q = 0 the handle's
/// axes are D's.
VPS_DEVICE_API Mat3 barrelRotation(const DualArmParameters& parameters, const ArmJoints& left) noexcept;

// --- The paper's three coordinate systems: one local to each arm, and one independent of both

enum class DeviceFrame {
  Independent,  ///< D: origin at the workspace's centre
  Left,         ///< left arm's base: x towards the other arm, z up
  Right,        ///< right arm's base
};
VPS_DEVICE_API const char* toText(DeviceFrame frame) noexcept;

/// Pose of a frame in D; the right arm's frame is as calibrated.
VPS_DEVICE_API Pose framePose(const DualArmParameters& parameters, DeviceFrame frame) noexcept;

/// Expresses a pose, velocity or wrench given in `from` in `to`. Velocity and wrench keep their reference
/// point.
VPS_DEVICE_API Pose inFrame(const DualArmParameters& parameters, const Pose& X, DeviceFrame from,
                            DeviceFrame to) noexcept;
VPS_DEVICE_API Twist inFrame(const DualArmParameters& parameters, const Twist& V, DeviceFrame from,
                             DeviceFrame to) noexcept;
VPS_DEVICE_API Wrench inFrame(const DualArmParameters& parameters, const Wrench& F, DeviceFrame from,
                              DeviceFrame to) noexcept;

// --- Handle

/// R_3E, the paper's (6).
VPS_DEVICE_API Mat3 gimbalRotation(double q1_rad, double q2_rad, double q3_rad) noexcept;

/// Gimbal angles from Y_EE in the barrel's frame: the paper's equation (7) with its signs corrected for the
/// whole plane. Singular when |q2| = 90 deg (q1 is then zero).
[[nodiscard]] VPS_DEVICE_API Status gimbalAngles(const Vec3& Y_3, double& q1_rad, double& q2_rad) noexcept;

/// Pose of the handle H (centre of mass) in D from measured joints, by the paper's equations (1) to (8). The
/// gimbal centres' distance need not be exactly L (quantised joints). BadPose or Singular leave X_DH
/// untouched.
[[nodiscard]] VPS_DEVICE_API Status handlePose(const DualArmParameters& parameters,
                                               const DualArmJoints& joints, Pose& X_DH) noexcept;

/// Joints that put the handle at X_DH, q3 within +-180 deg. BadPose or Singular leave joints untouched.
[[nodiscard]] VPS_DEVICE_API Status handleJoints(const DualArmParameters& parameters, const Pose& X_DH,
                                                 DualArmJoints& joints) noexcept;

/// Joint rates from the handle's twist (w, v of H, in D): rates = J V. Wrenches follow by power: (tau, f) =
/// J^T efforts. Singular at |q2| = 90 deg or |t2| = 90 deg.
[[nodiscard]] VPS_DEVICE_API Status handleJacobian(const DualArmParameters& parameters, const Pose& X_DH,
                                                   JointMatrix& J) noexcept;

/// Joints and derivatives at one pose of the handle, for motion and stops.
struct HandleMotion {
  JointVector joints = JointVector::Zero();  ///< values in joint order
  JointMatrix J = JointMatrix::Zero();       ///< joint rates = J V, as handleJacobian
  double q2_rad = 0;                         ///< angle of the gimbal, which no motor moves
  Eigen::Matrix<double, 1, 6> J_q2 = Eigen::Matrix<double, 1, 6>::Zero();  ///< q2' = J_q2 V
};

/// Status as handleJacobian; otherwise `motion` stays untouched.
[[nodiscard]] VPS_DEVICE_API Status handleMotion(const DualArmParameters& parameters, const Pose& X_DH,
                                                 HandleMotion& motion) noexcept;

/// Axes with stops: the joints in joint order, then q2.
inline constexpr int kStoppedAxes = 8;
struct AxisRange {
  double least = 0, most = 0;  ///< [m] of a slide, else [rad]
  bool is_slide = false;
};
VPS_DEVICE_API AxisRange axisRange(const DualArmParameters& parameters, int axis) noexcept;
/// @param joints  in joint order
VPS_DEVICE_API double axisValue(const JointVector& joints, double q2_rad, int axis) noexcept;

/// True if every joint, including q2, is within its range and the arms do not collide.
VPS_DEVICE_API bool isReachable(const DualArmParameters& parameters, const Pose& X_DH) noexcept;

/// Free distance between the two prismatic links, as capsules [m]; negative when they collide.
VPS_DEVICE_API double armClearance_m(const DualArmParameters& parameters,
                                     const DualArmJoints& joints) noexcept;

// --- Statics

/// Motor efforts that give the wrench F_Ho_D to the hand with the handle at X_DH; along the handle each arm
/// exerts f/2, without a squeeze in addition. Status as handleJacobian; unless Ok, the efforts are zero.
[[nodiscard]] VPS_DEVICE_API Status motorEfforts(const DualArmParameters& parameters, const Pose& X_DH,
                                                 const Wrench& F_Ho_D, JointVector& efforts) noexcept;

/// The wrench that motor efforts exert on the hand, from the balance of the arms and the gimbal.
[[nodiscard]] VPS_DEVICE_API Status handleWrench(const DualArmParameters& parameters, const Pose& X_DH,
                                                 const JointVector& efforts, Wrench& F_Ho_D) noexcept;

/// Greatest factor s in [0, 1] such that |bias + s wanted| keeps within `limit` for each motor. Zero if the
/// bias alone exceeds `limit`. Scaling the whole wrench keeps its direction.
VPS_DEVICE_API double saturationScale(const JointVector& bias, const JointVector& wanted,
                                      const JointVector& limit) noexcept;

/// Motor limits for a share from 0 (continuous) to 1 (peak), linear in between.
VPS_DEVICE_API JointVector motorLimits(const DualArmParameters& parameters, double peak_share) noexcept;

}  // namespace vps::device
