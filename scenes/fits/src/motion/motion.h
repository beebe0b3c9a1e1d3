// SPDX-License-Identifier: BSD-3-Clause
// A translation, rotation or screw motion of a part, and how long a plane separates the part from held parts.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "vps/pose.h"

namespace vps::scenes {

/// A motion with a parameter s that starts at 0: metres along `direction` for a translation, radians about
/// the axis through `center` for a rotation. A screw motion also advances along its axis.
struct Motion {
  Vec3 direction = Vec3::UnitZ();  ///< unit
  Vec3 center = Vec3::Zero();
  bool is_turn = false;
  double forward_m = 0;  ///< advance of a screw motion along `direction` per radian

  [[nodiscard]] Pose at(double s) const {
    if (!is_turn) return Pose::translation(s * direction);
    const Mat3 R = rotationFromVector(s * direction);
    return {R, center - R * center + s * forward_m * direction};
  }
  /// The same motion in a frame F, given the pose in F of the frame of this motion.
  [[nodiscard]] Motion in(const Pose& X_F) const {
    return {X_F.R * direction, X_F * center, is_turn, forward_m};
  }
  /// The motion of held parts as seen in the frame of the moving part.
  [[nodiscard]] Motion reversed() const { return {-direction, center, is_turn, forward_m}; }

  /// Velocity of a point at s = 0, per unit of s.
  [[nodiscard]] Vec3 velocity(const Vec3& p) const {
    return is_turn ? Vec3(direction.cross(p - center) + forward_m * direction) : direction;
  }

  /// The parameter s up to which a moving point p stays above a plane: n . p(s) >= least, which must hold at
  /// s = 0. For a screw motion the result may be too small by up to a thousandth.
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
  /// The parameter up to which f(s) = level + cosine cos s + sine sin s + rate s stays non-negative; f(0)
  /// must not be negative. Each step leads to the zero of f + f' h - swing h^2 / 2, which is a lower bound of
  /// f(s + h).
  [[nodiscard]] static double screwStaysAbove(double level, double cosine, double sine, double rate) {
    constexpr double kForever = std::numeric_limits<double>::infinity();
    constexpr double kLeast = 1e-3;  // least step, relative to s
    constexpr int kMostSteps = 64;
    const double swing = std::hypot(cosine, sine);
    if (!(swing > 0)) return rate < 0 ? std::max(0.0, level / -rate) : kForever;
    double s = 0;
    for (int i = 0; i < kMostSteps; ++i) {
      if (rate >= 0 && level + rate * s >= swing) return kForever;
      const double f = level + cosine * std::cos(s) + sine * std::sin(s) + rate * s;
      if (f <= 0) break;
      const double slope = sine * std::cos(s) - cosine * std::sin(s) + rate;
      // Where f falls, the usual form of the root would be a difference of nearly equal numbers.
      const double root = std::sqrt(slope * slope + 2 * swing * f);
      const double h = slope < 0 ? 2 * f / (root - slope) : (slope + root) / swing;
      s += h;
      if (h < kLeast * s) break;
    }
    return s;
  }
};

}  // namespace vps::scenes
