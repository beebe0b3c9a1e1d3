// SPDX-License-Identifier: BSD-3-Clause
// A straight, turning or screwing motion of a part, and how long a plane parts it from what is held.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "vps/pose.h"

namespace vps::scenes {

/// The way s goes from 0 on: in metres along `direction`, or in radians about it through `center`, on which a
/// screw goes forward as well.
struct Motion {
  Vec3 direction = Vec3::UnitZ();  ///< unit
  Vec3 center = Vec3::Zero();
  bool is_turn = false;
  double forward_m = 0;  ///< of a turn: along `direction` for each radian

  [[nodiscard]] Pose at(double s) const {
    if (!is_turn) return Pose::translation(s * direction);
    const Mat3 R = rotationFromVector(s * direction);
    return {R, center - R * center + s * forward_m * direction};
  }
  /// The same motion in a frame F, given the pose of its own frame in F.
  [[nodiscard]] Motion in(const Pose& X_F) const {
    return {X_F.R * direction, X_F * center, is_turn, forward_m};
  }
  /// How what is held moves in the frame of the part.
  [[nodiscard]] Motion reversed() const { return {-direction, center, is_turn, forward_m}; }

  /// Velocity of a point at s = 0, per unit of s.
  [[nodiscard]] Vec3 velocity(const Vec3& p) const {
    return is_turn ? Vec3(direction.cross(p - center) + forward_m * direction) : direction;
  }

  /// The s up to which n . p(s) >= least, if it is so at 0; the point p moves. Of a screw less by up to a
  /// thousandth.
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
    if (const double rate = n.dot(direction) * forward_m; rate != 0)
      return screwStaysAbove(level, cosine, sine, rate);
    if (level >= swing) return kForever;
    const double half = std::acos(std::clamp(-level / swing, -1.0, 1.0));
    return std::max(0.0, std::atan2(sine, cosine) + half);
  }

 private:
  /// How long f(s) = level + cosine cos s + sine sin s + rate s, which is not negative at 0, stays so. Steps
  /// to where f + f' h - swing h^2 / 2, which is never above f(s + h), is 0.
  [[nodiscard]] static double screwStaysAbove(double level, double cosine, double sine, double rate) {
    constexpr double kForever = std::numeric_limits<double>::infinity();
    constexpr double kLeast = 1e-3;  // of the way so far
    constexpr int kMostSteps = 64;
    const double swing = std::hypot(cosine, sine);
    if (!(swing > 0)) return rate < 0 ? std::max(0.0, level / -rate) : kForever;
    double s = 0;
    for (int i = 0; i < kMostSteps; ++i) {
      if (rate >= 0 && level + rate * s >= swing) return kForever;
      const double f = level + cosine * std::cos(s) + sine * std::sin(s) + rate * s;
      if (f <= 0) break;
      const double slope = sine * std::cos(s) - cosine * std::sin(s) + rate;
      const double h = (slope + std::sqrt(slope * slope + 2 * swing * f)) / swing;
      s += h;
      if (h < kLeast * s) break;
    }
    return s;
  }
};

}  // namespace vps::scenes
