// SPDX-License-Identifier: BSD-3-Clause
// Force and torque about a point, in a frame; the variable's name states both.
#pragma once

#include "vps/pose.h"

namespace vps {

/// Torque tau [N m] about a point and force f [N]. The variable's name states point and frame: F_Po_W acts on
/// P, about P's origin, in W.
struct Wrench {
  Vec3 tau = Vec3::Zero();
  Vec3 f = Vec3::Zero();

  Wrench& operator+=(const Wrench& other) {
    tau += other.tau;
    f += other.f;
    return *this;
  }
  Wrench operator+(const Wrench& other) const { return {tau + other.tau, f + other.f}; }
  Wrench operator-() const { return {-tau, -f}; }
  Wrench operator*(double s) const { return {tau * s, f * s}; }
  [[nodiscard]] bool isFinite() const { return tau.allFinite() && f.allFinite(); }
};

/// The same wrench about point B, where p_BA runs from B to the old point A, in the wrench's frame.
inline Wrench shifted(const Wrench& F_A, const Vec3& p_BA) {
  return {F_A.tau + p_BA.cross(F_A.f), F_A.f};
}

/// The same wrench with its components in frame A, where R_AB turns B's components into A's.
inline Wrench rotated(const Mat3& R_AB, const Wrench& F_B) {
  return {R_AB * F_B.tau, R_AB * F_B.f};
}

/// Power [W] of a wrench about a point that moves with V; both in one frame.
inline double power(const Wrench& F, const Twist& V) {
  return F.tau.dot(V.w) + F.f.dot(V.v);
}

}  // namespace vps
