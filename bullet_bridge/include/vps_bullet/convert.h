// SPDX-License-Identifier: BSD-3-Clause
// All conversion between our types and Bullet's, both ways.
#pragma once

#include <LinearMath/btTransform.h>

#include "vps/pose.h"
#include "vps_bullet/precision.h"

namespace vps::bullet {

inline btScalar toBt(double x) {
  return static_cast<btScalar>(x);
}
inline btVector3 toBt(const Vec3& v) {
  return {toBt(v.x()), toBt(v.y()), toBt(v.z())};
}
inline Vec3 fromBt(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

inline btQuaternion toBt(const Quat& q) {
  return {toBt(q.x()), toBt(q.y()), toBt(q.z()), toBt(q.w())};
}
inline Quat fromBt(const btQuaternion& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

inline btMatrix3x3 toBt(const Mat3& m) {
  return {toBt(m(0, 0)), toBt(m(0, 1)), toBt(m(0, 2)), toBt(m(1, 0)), toBt(m(1, 1)),
          toBt(m(1, 2)), toBt(m(2, 0)), toBt(m(2, 1)), toBt(m(2, 2))};
}
inline Mat3 fromBt(const btMatrix3x3& m) {
  Mat3 out;
  out << m[0][0], m[0][1], m[0][2], m[1][0], m[1][1], m[1][2], m[2][0], m[2][1], m[2][2];
  return out;
}

inline btTransform toBt(const Pose& X) {
  return btTransform(toBt(X.R), toBt(X.p));
}
inline Pose fromBt(const btTransform& X) {
  return {fromBt(X.getBasis()), fromBt(X.getOrigin())};
}

}  // namespace vps::bullet
