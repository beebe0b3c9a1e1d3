// SPDX-License-Identifier: BSD-3-Clause
// Functions that inner loops do not need; Eigen's rotations take long to compile.
#include "vps/pose.h"

namespace vps {

Pose::Pose(const Quat& rotation, const Vec3& position)
    : R(rotation.normalized().toRotationMatrix()), p(position) {}

Quat Pose::quaternion() const {
  Quat q(R);
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return q;
}

Vec3 rotationVector(const Mat3& R) {
  const Eigen::AngleAxisd a(R);
  return a.axis() * a.angle();
}

Mat3 rotationFromVector(const Vec3& r) {
  const double angle_rad = r.norm();
  if (angle_rad < 1e-300) return Mat3::Identity();
  return Eigen::AngleAxisd(angle_rad, r / angle_rad).toRotationMatrix();
}

Pose interpolate(const Pose& from, const Pose& to, double share) {
  const Vec3 turn = rotationVector(to.R * from.R.transpose());
  return {Mat3(rotationFromVector(share * turn) * from.R), Vec3(from.p + share * (to.p - from.p))};
}

}  // namespace vps
