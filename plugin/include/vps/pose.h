// SPDX-License-Identifier: BSD-3-Clause
// Rigid poses and velocities. Letters: X pose, R rotation, p position, v/w velocity; X_AB is the pose of B in
// A.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vps/export.h"

namespace vps {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;

/// Rigid pose X_AB: p_A = R p_B + p. R is a rotation (det +1); p in metres.
struct VPS_API Pose {
  Mat3 R = Mat3::Identity();
  Vec3 p = Vec3::Zero();

  Pose() = default;
  Pose(const Mat3& rotation, const Vec3& position) : R(rotation), p(position) {}
  Pose(const Quat& rotation, const Vec3& position)
      : R(rotation.normalized().toRotationMatrix()), p(position) {}
  static Pose translation(const Vec3& position) { return {Mat3(Mat3::Identity()), position}; }

  Pose operator*(const Pose& X_BC) const { return {Mat3(R * X_BC.R), R * X_BC.p + p}; }
  Vec3 operator*(const Vec3& p_B) const { return R * p_B + p; }
  [[nodiscard]] Pose inverse() const { return {Mat3(R.transpose()), -(R.transpose() * p)}; }
  [[nodiscard]] bool isFinite() const { return R.allFinite() && p.allFinite(); }
  /// The rotation as a unit quaternion with w >= 0, so that equal rotations print equal numbers.
  [[nodiscard]] Quat quaternion() const {
    Quat q(R);
    q.normalize();
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    return q;
  }
};

/// The matrix [r] for which [r] x is the cross product of r and x.
inline Mat3 crossMatrix(const Vec3& r) {
  Mat3 m;
  m << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return m;
}

/// The rotation vector (axis times angle, |.| <= pi) of R. O(1).
inline Vec3 rotationVector(const Mat3& R) {
  const Eigen::AngleAxisd a(R);
  return a.axis() * a.angle();
}

/// The rotation that the rotation vector r [rad] describes.
inline Mat3 rotationFromVector(const Vec3& r) {
  const double angle_rad = r.norm();
  if (angle_rad < 1e-300) return Mat3::Identity();
  return Eigen::AngleAxisd(angle_rad, r / angle_rad).toRotationMatrix();
}

/// Spatial velocity of a frame: angular w [rad/s] and linear v [m/s] of its origin, both in one stated frame.
struct VPS_API Twist {
  Vec3 w = Vec3::Zero();
  Vec3 v = Vec3::Zero();
  [[nodiscard]] bool isFinite() const { return w.allFinite() && v.allFinite(); }
};

}  // namespace vps
