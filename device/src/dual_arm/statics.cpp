// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/dual_arm/statics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vps::device {
namespace {

constexpr double kNoEffort = 1e-12;  // effort per newton below which a motor does not contribute

double armUp_N(const DualArmParameters& p, Side side, const Vec3& p_D, const Vec3& limits) {
  ArmJoints joints;
  const Pose X_DA = armBase(p, side);
  if (armInverse(X_DA.inverse() * p_D, joints) != Status::Ok) return 0;
  const Vec3 efforts = armJacobian(joints).transpose() * (X_DA.R.transpose() * Vec3::UnitZ());
  double most_N = std::numeric_limits<double>::max();
  for (int i = 0; i < 3; ++i)
    if (std::abs(efforts[i]) > kNoEffort) most_N = std::min(most_N, limits[i] / std::abs(efforts[i]));
  return most_N;
}

}  // namespace

JointVector structureStiffness(const DualArmParameters& p, const JointVector& joints) noexcept {
  const double gimbal = 1 / p.gimbal_N_per_m;
  JointVector k = jointVector(1 / p.plate_Nm_per_rad, 1 / p.link_N_per_m, 1 / p.rotor_Nm_per_rad);
  for (int arm = 0; arm < 6; arm += 3) {
    const double d = joints[arm + 2], lever = d * std::cos(joints[arm + 1]);
    k[arm] += gimbal / (lever * lever);
    k[arm + 1] += gimbal / (d * d);
    k[arm + 2] += gimbal;
  }
  return k.cwiseInverse();
}

JointVector structureDrift(const DualArmParameters& p, const JointVector& joints,
                           const JointVector& stretch) noexcept {
  const double gimbal = 1 / p.gimbal_N_per_m;
  const JointVector k = structureStiffness(p, joints);
  const JointVector load2 = k.cwiseProduct(stretch).cwiseAbs2();  // N^2 m^2, N^2
  JointVector drift = JointVector::Zero();
  for (int arm = 0; arm < 6; arm += 3) {
    // 1/K_1 = .. + g / (d c2)^2,  1/K_2 = .. + g / d^2; the drift is half of K^2 stretch^2 times the
    // derivatives of 1/K.
    const double d = joints[arm + 2], c2 = std::cos(joints[arm + 1]), lever2 = d * d * c2 * c2;
    drift[arm + 1] = gimbal / lever2 * std::tan(joints[arm + 1]) * load2[arm];
    drift[arm + 2] = -gimbal / d * (load2[arm] / lever2 + load2[arm + 1] / (d * d));
  }
  return drift;
}

Status effortMap(const DualArmParameters& parameters, const Pose& X_DH, EffortMap& map) noexcept {
  JointVector efforts;
  Status status = motorEfforts(parameters, X_DH, -handleWeight(parameters), map.weight);
  for (int axis = 0; axis < 3 && status == Status::Ok; ++axis) {
    status = motorEfforts(parameters, X_DH, {Vec3::Zero(), Vec3::Unit(axis)}, efforts);
    map.force.col(axis) = efforts;
    if (status == Status::Ok)
      status = motorEfforts(parameters, X_DH, {Vec3::Unit(axis), Vec3::Zero()}, efforts);
    map.torque.col(axis) = efforts;
  }
  return status;
}

double leastOverDirections(const Eigen::Matrix<double, 7, 3>& efforts, const JointVector& weight,
                           const JointVector& limits) noexcept {
  double least = std::numeric_limits<double>::max();
  for (int i = 0; i < 7; ++i) {
    const double room = std::max(0.0, limits[i] - std::abs(weight[i])), size = efforts.row(i).norm();
    if (size > kNoEffort) least = std::min(least, room / size);
  }
  return least;
}

double alongDirection(const Eigen::Matrix<double, 7, 3>& efforts, const JointVector& weight,
                      const JointVector& limits, const Vec3& direction) noexcept {
  const JointVector wanted = efforts * direction;
  double most = std::numeric_limits<double>::max();
  for (int i = 0; i < 7; ++i) {
    const double room = std::max(0.0, limits[i] - (wanted[i] >= 0 ? weight[i] : -weight[i]));
    if (std::abs(wanted[i]) > kNoEffort) most = std::min(most, room / std::abs(wanted[i]));
  }
  return most;
}

VerticalForce verticalForce(const DualArmParameters& p, const Vec3& p_DE,
                            const JointVector& limits) noexcept {
  VerticalForce force;
  const Vec3 half_m(0, 0.5 * p.handle_m, 0);
  force.left_N = armUp_N(p, Side::Left, p_DE - half_m, limits.head<3>());
  force.right_N = armUp_N(p, Side::Right, p_DE + half_m, limits.segment<3>(3));
  force.sum_N = force.left_N + force.right_N - p.handle_kg * kGravity_m_s2;
  EffortMap map;
  if (effortMap(p, Pose::translation(p_DE + p.p_EH), map) != Status::Ok) return force;
  // The force acts at the midpoint, where both arms carry equal shares; it equals a force at H and a torque.
  const Vec3 p_HE = -p.p_EH;
  map.force.col(2) += map.torque * p_HE.cross(Vec3::UnitZ());
  force.both_N = alongDirection(map.force, map.weight, limits, Vec3::UnitZ());
  return force;
}

}  // namespace vps::device
