// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "vps_device/dual_arm/controller.h"

namespace vps::device::inline v0 {
namespace {

using Mat6 = Eigen::Matrix<double, 6, 6>;

// Beyond this tilt, in the workspace's corners, the gimbal is near its singularity, where the motor no longer
// brakes all rotations.
constexpr double kGreatestTilt_rad = 0.5236;

double leastEigenvalue(const Mat3& m) {
  return Eigen::SelfAdjointEigenSolver<Mat3>(m).eigenvalues()[0];
}

// The sum of joint frictions |f_i v_i| is never less than the root of the sum of their squares, which an
// eigenvalue bounds.
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
  leastFriction(p, limits);
  return limits;
}

}  // namespace vps::device::inline v0
