// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/calibration.h"

#include <Eigen/Dense>
#include <cmath>

namespace vps::device {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr std::size_t kMinReadings = 12;  // two readings for each unknown
constexpr int kMaxIterations = 50;
constexpr double kSettled = 1e-13;  // m and rad: a few roundings of lengths of 1 m
constexpr double kBlur_m = 1e-3;    // readings from which the base is less certain than this are too similar

// Sums of the least squares: J^T J, J^T r and r^T r, for a rotation and shift (w, v) of the right base in its
// own frame.
struct Sums {
  Mat6 JJ = Mat6::Zero();
  Vec6 Jr = Vec6::Zero();
  double rr = 0;
};

Sums sumsOf(const DualArmParameters& parameters, const Pose& X_DR, std::span<const DualArmJoints> readings) {
  const Pose X_DL = armBase(parameters, Side::Left);
  Sums sums;
  for (const DualArmJoints& joints : readings) {
    const Vec3 p_A = armPosition(joints.right);
    const Vec3 p_LR = X_DR * p_A - X_DL * armPosition(joints.left);
    const double length_m = p_LR.norm(), residual_m = length_m - parameters.handle_m;
    const Vec3 along_A = X_DR.R.transpose() * (p_LR / length_m);
    Vec6 row;
    row << p_A.cross(along_A), along_A;
    sums.JJ += row * row.transpose();
    sums.Jr += row * residual_m;
    sums.rr += residual_m * residual_m;
  }
  return sums;
}

bool areFinite(std::span<const DualArmJoints> readings) {
  for (const DualArmJoints& joints : readings)
    if (!toVector(joints).allFinite()) return false;
  return true;
}

}  // namespace

BaseCalibration calibrateBases(const DualArmParameters& parameters,
                               std::span<const DualArmJoints> readings) noexcept {
  BaseCalibration result;
  result.parameters = parameters;
  result.status = Status::Truncated;
  if (readings.size() < kMinReadings) return result;
  result.status = Status::BadPose;
  if (!areFinite(readings)) return result;

  Pose X_DR = armBase(parameters, Side::Right);
  Sums sums = sumsOf(parameters, X_DR, readings);
  bool is_settled = false;
  double damping = 0;  // Levenberg damping, only where a full step increases the residual
  while (!is_settled && result.iterations < kMaxIterations) {
    ++result.iterations;
    const Mat6 A = sums.JJ + damping * sums.JJ.trace() * Mat6::Identity();
    const Vec6 step = -A.ldlt().solve(sums.Jr);
    if (!step.allFinite()) break;
    const Pose X_next = X_DR * Pose(rotationFromVector(step.head<3>()), step.tail<3>());
    const Sums next = sumsOf(parameters, X_next, readings);
    is_settled = step.norm() < kSettled;
    if (next.rr <= sums.rr || is_settled) {
      X_DR = X_next;
      sums = next;
      damping = damping > 1e-9 ? 0.1 * damping : 0;
    } else {
      // Within rounding of the minimum: a smaller step has no effect.
      is_settled = step.norm() < 1e-9;
      damping = damping > 0 ? 10 * damping : 1e-6;
    }
  }

  const double count = static_cast<double>(readings.size());
  const Eigen::SelfAdjointEigenSolver<Mat6> eigen(sums.JJ);
  const double least = eigen.eigenvalues()[0];
  result.status = Status::Singular;
  if (!(least > 0) || parameters.resolution_m / std::sqrt(least) > kBlur_m) return result;
  result.status = Status::Fault;
  if (!is_settled) return result;
  result.status = Status::Ok;
  result.rms_m = std::sqrt(sums.rr / count);
  const Mat6 covariance = sums.rr / (count - 6) * sums.JJ.inverse();
  const auto greatest = [](const Mat3& m) {
    return std::sqrt(std::max(0.0, Eigen::SelfAdjointEigenSolver<Mat3>(m).eigenvalues()[2]));
  };
  result.sigma_rad = greatest(covariance.topLeftCorner<3, 3>());
  result.sigma_m = greatest(covariance.bottomRightCorner<3, 3>());

  DualArmParameters nominal = parameters;
  nominal.right_shift_m = nominal.right_turn_rad = Vec3::Zero();
  const Pose offset = armBase(nominal, Side::Right).inverse() * X_DR;
  result.parameters.right_shift_m = offset.p;
  result.parameters.right_turn_rad = rotationVector(offset.R);
  return result;
}

Placement fitPlacement(std::span<const TouchedPoint> points) noexcept {
  Placement found;
  if (points.size() < 3) return found;
  const auto count = static_cast<double>(points.size());
  Vec3 middle_D = Vec3::Zero(), middle_S = Vec3::Zero();
  for (const TouchedPoint& point : points) {
    if (!point.p_D.allFinite() || !point.p_S.allFinite()) {
      found.status = Status::BadPose;
      return found;
    }
    middle_D += point.p_D / count;
    middle_S += point.p_S / count;
  }
  Mat3 cross = Mat3::Zero();
  for (const TouchedPoint& point : points)
    cross += (point.p_S - middle_S) * (point.p_D - middle_D).transpose();
  const Eigen::JacobiSVD<Mat3> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  constexpr double kLine = 1e-6;  // share of the second direction below which points count as on a line
  if (!(svd.singularValues()[1] > kLine * svd.singularValues()[0])) {
    found.status = Status::Singular;
    return found;
  }
  Vec3 signs = Vec3::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs.z() = -1;
  found.X_SD.R = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  found.X_SD.p = middle_S - found.X_SD.R * middle_D;
  double sum_m2 = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double miss_m = (found.X_SD * points[i].p_D - points[i].p_S).norm();
    sum_m2 += miss_m * miss_m;
    if (miss_m <= found.greatest_m) continue;
    found.greatest_m = miss_m;
    found.worst = i;
  }
  found.rms_m = std::sqrt(sum_m2 / count);
  found.status = Status::Ok;
  return found;
}

}  // namespace vps::device
