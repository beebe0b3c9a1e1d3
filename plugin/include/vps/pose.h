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

/// Rigid pose X_AB: p_A = R p_B + p. R is a rotation (determinant +1), p is in metres.
struct VPS_API Pose {
  Mat3 R = Mat3::Identity();
  Vec3 p = Vec3::Zero();

  Pose() = default;
  Pose(const Mat3& rotation, const Vec3& position) : R(rotation), p(position) {}
  Pose(const Quat& rotation, const Vec3& position);
  static Pose translation(const Vec3& position) { return {Mat3(Mat3::Identity()), position}; }

  Pose operator*(const Pose& X_BC) const { return {Mat3(R * X_BC.R), R * X_BC.p + p}; }
  Vec3 operator*(const Vec3& p_B) const { return R * p_B + p; }
  [[nodiscard]] Pose inverse() const { return {Mat3(R.transpose()), -(R.transpose() * p)}; }
  [[nodiscard]] bool isFinite() const { return R.allFinite() && p.allFinite(); }
  /// The rotation as a unit quaternion with w >= 0, so that equal rotations print equal numbers.
  [[nodiscard]] Quat quaternion() const;
};

/// The matrix [r] for which [r] x is the cross product of r and x.
inline Mat3 crossMatrix(const Vec3& r) {
  Mat3 m;
  m(0, 0) = 0, m(0, 1) = -r.z(), m(0, 2) = r.y();
  m(1, 0) = r.z(), m(1, 1) = 0, m(1, 2) = -r.x();
  m(2, 0) = -r.y(), m(2, 1) = r.x(), m(2, 2) = 0;
  return m;
}

/// The rotation vector (axis times angle, |.| <= pi) of R. O(1).
VPS_API Vec3 rotationVector(const Mat3& R);

/// The rotation that the rotation vector r [rad] describes.
VPS_API Mat3 rotationFromVector(const Vec3& r);

/// The pose after `share` (0 to 1) of a motion from one pose to the other: the origin moves on the line
/// between both origins, the rotation is about the axis of the rotation between both poses. O(1).
[[nodiscard]] VPS_API Pose interpolate(const Pose& from, const Pose& to, double share);

/// Spatial velocity of a frame: angular w [rad/s] and linear v [m/s] of its origin, both in one stated frame.
struct Twist {
  Vec3 w = Vec3::Zero();
  Vec3 v = Vec3::Zero();
  [[nodiscard]] bool isFinite() const { return w.allFinite() && v.allFinite(); }
};

}  // namespace vps
