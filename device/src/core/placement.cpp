// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/placement.h"

#include <Eigen/SVD>
#include <cmath>

namespace vps::device {

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
