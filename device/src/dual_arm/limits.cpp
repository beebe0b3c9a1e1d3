// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "vps_device/dual_arm/controller.h"

namespace vps::device {
namespace {

using Mat6 = Eigen::Matrix<double, 6, 6>;

// Beyond this tilt, in the corners of the workspace, the gimbal is near its singularity, where the motor does
// not brake every rotation.
constexpr double kGreatestTilt_rad = 0.5236;

// Within this range the rotation midway between two rotations is unique.
constexpr double kGreatestTurn_rad = 1.5;
constexpr int kTurnBisections = 10;  // gives an accuracy of 1.5 mrad
constexpr int kCubeMiddle = 13;

/// Point 0 to 26 of the grid of -1, 0 and 1 along each axis.
Vec3 cubePoint(int i) {
  return {i % 3 - 1.0, i / 3 % 3 - 1.0, i / 9 - 1.0};
}

double leastEigenvalue(const Mat3& m) {
  return Eigen::SelfAdjointEigenSolver<Mat3>(m).eigenvalues()[0];
}

// The sum of the joint frictions |f_i v_i| is at least the root of the sum of their squares, which an
// eigenvalue bounds from below.
void leastFriction(const DualArmParameters& p, DeviceLimits& limits) {
  const JointVector damping = jointVector(p.plate_damping_Nms, p.link_damping_Ns_per_m, p.rotor_damping_Nms);
  const JointVector coulomb2 =
      jointVector(p.plate_coulomb_Nm, p.link_coulomb_N, p.rotor_coulomb_Nm).cwiseAbs2();
  limits.damping_Ns_per_m = limits.damping_Nms_per_rad = limits.coulomb_N = limits.coulomb_Nm = 1e9;
  for (int i = 0; i < 3 * 3 * 3 * 3 * 3; ++i) {
    const auto third = [i](int power) { return i / power % 3 - 1.0; };
    const Vec3 corner(third(1), third(3), third(9));
    const Vec3 tilt = Vec3(third(27), 0, third(81)).stableNormalized() * kGreatestTilt_rad;
    const Pose X_DH(rotationFromVector(tilt), Vec3(0.5 * p.workspace_m.cwiseProduct(corner)));
    JointMatrix J;
    if (handleJacobian(p, X_DH, J) != Status::Ok) continue;
    const Mat6 B = J.transpose() * damping.asDiagonal() * J, C = J.transpose() * coulomb2.asDiagonal() * J;
    limits.damping_Nms_per_rad =
        std::min(limits.damping_Nms_per_rad, leastEigenvalue(B.topLeftCorner<3, 3>()));
    limits.damping_Ns_per_m = std::min(limits.damping_Ns_per_m, leastEigenvalue(B.bottomRightCorner<3, 3>()));
    limits.coulomb_Nm = std::min(limits.coulomb_Nm, std::sqrt(leastEigenvalue(C.topLeftCorner<3, 3>())));
    limits.coulomb_N = std::min(limits.coulomb_N, std::sqrt(leastEigenvalue(C.bottomRightCorner<3, 3>())));
  }
}

/// The share of a rotation vector that is reachable at a place, by bisection: up to that share every rotation
/// is reachable, and beyond it none.
double reachableShare(const DualArmParameters& p, const Vec3& p_DH, const Vec3& turn_rad) {
  double least = 0, most = 1;
  for (int i = 0; i < kTurnBisections; ++i) {
    const double share = 0.5 * (least + most);
    (isReachable(p, Pose(rotationFromVector(share * turn_rad), p_DH)) ? least : most) = share;
  }
  return least;
}

double leastTurn_rad(const DualArmParameters& p) {
  double least = 1;
  for (int axis = 0; axis < 27; ++axis) {
    const Vec3 along = cubePoint(axis).stableNormalized();
    for (int corner = 0; corner < 27 && axis != kCubeMiddle; ++corner)
      least = std::min(least, reachableShare(p, 0.5 * p.workspace_m.cwiseProduct(cubePoint(corner)),
                                             kGreatestTurn_rad * along));
  }
  return least * kGreatestTurn_rad;
}

}  // namespace

DeviceLimits dualArmLimits(const DualArmParameters& p, double rate_hz, bool has_quantised_encoders) {
  DeviceLimits limits;
  limits.continuous_force_N = p.force_N;
  limits.peak_force_N = p.force_peak_N;
  limits.continuous_torque_Nm = p.torque_Nm;
  limits.peak_torque_Nm = p.torque_peak_Nm;
  limits.workspace_min_D = -0.5 * p.workspace_m;
  limits.workspace_max_D = 0.5 * p.workspace_m;
  limits.rate_hz = rate_hz;
  limits.delay_s = p.delay_ticks / rate_hz;
  limits.resolution_m = has_quantised_encoders ? p.resolution_m : 0;
  limits.resolution_rad = has_quantised_encoders ? p.resolution_rad : 0;
  limits.workspace_rad = leastTurn_rad(p);
  leastFriction(p, limits);
  return limits;
}

}  // namespace vps::device
