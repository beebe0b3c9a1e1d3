// SPDX-License-Identifier: BSD-3-Clause
// A straight or turning motion of a part, and how long a plane parts it from what is held.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "vps/pose.h"

namespace vps::scenes::inline v0 {

/// The way s goes from 0 on: in metres along `direction`, or in radians about it through `center`.
struct Motion {
  Vec3 direction = Vec3::UnitZ();  ///< unit
  Vec3 center = Vec3::Zero();
  bool is_turn = false;

  [[nodiscard]] Pose at(double s) const {
    if (!is_turn) return Pose::translation(s * direction);
    const Mat3 R = rotationFromVector(s * direction);
    return {R, center - R * center};
  }
  /// The same motion in a frame F, given the pose of its own frame in F.
  [[nodiscard]] Motion in(const Pose& X_F) const { return {X_F.R * direction, X_F * center, is_turn}; }
  /// How what is held moves in the frame of the part.
  [[nodiscard]] Motion reversed() const { return {-direction, center, is_turn}; }

  /// Velocity of a point at s = 0, per unit of s.
  [[nodiscard]] Vec3 velocity(const Vec3& p) const {
    return is_turn ? Vec3(direction.cross(p - center)) : direction;
  }

  /// The s up to which n . p(s) >= least, if it is so at 0; the point p moves.
  [[nodiscard]] double staysAbove(const Vec3& n, const Vec3& p, double least) const {
    constexpr double kForever = std::numeric_limits<double>::infinity();
    if (!is_turn) {
      const double rate = n.dot(direction);
      return rate < 0 ? (n.dot(p) - least) / -rate : kForever;
    }
    // n . p(s) - least = level + cosine cos s + sine sin s, which is not negative at 0.
    const Vec3 r = p - center, across = r - direction.dot(r) * direction;
    const double level = n.dot(p - across) - least, cosine = n.dot(across),
                 sine = n.dot(direction.cross(across)), swing = std::hypot(cosine, sine);
    if (level >= swing) return kForever;
    const double half = std::acos(std::clamp(-level / swing, -1.0, 1.0));
    return std::max(0.0, std::atan2(sine, cosine) + half);
  }
};

}  // namespace vps::scenes::inline v0
