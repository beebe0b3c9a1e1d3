// SPDX-License-Identifier: BSD-3-Clause
// The pose of an arm of two links, by the law of cosines, and its RULA score.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "vps_scenes/uses/ergonomics.h"

namespace vps::scenes {

namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// The angle opposite to c in a triangle.
double cornerOf(double a, double b, double c) {
  return std::acos(std::clamp((a * a + b * b - c * c) / (2 * a * b), -1.0, 1.0));
}

}  // namespace

const std::vector<Body>& assumedBodies() {
  static const std::vector<Body> kBodies{{"small woman", 1.535}, {"large man", 1.855}};
  return kBodies;
}

ArmPose armTo(const Body& body, const Vec3& p_SH) {
  const double upper_m = body.upperArm_m(), fore_m = body.forearm_m(), distance_m = p_SH.norm();
  ArmPose arm;
  arm.reach_share = distance_m / (upper_m + fore_m);
  arm.is_reached = arm.reach_share <= 1;
  const double folded_m = std::abs(upper_m - fore_m);
  const double d_m = std::clamp(distance_m, folded_m, upper_m + fore_m);
  arm.elbow_rad = std::numbers::pi - cornerOf(upper_m, fore_m, d_m);
  // The upper arm's angle from hanging down: the angle of the line from shoulder to hand, minus the angle
  // between this line and the upper arm, which lies below the line.
  const double line_rad = distance_m > 0 ? std::acos(std::clamp(-p_SH.z() / distance_m, -1.0, 1.0)) : 0;
  const double inner_rad = d_m > 0 ? cornerOf(upper_m, d_m, fore_m) : 0;
  arm.raised_rad = std::abs(line_rad - inner_rad);
  return arm;
}

int rulaArm(const ArmPose& arm) {
  constexpr double kRounding_rad = 1e-9;
  const double raised = arm.raised_rad - kRounding_rad, elbow = arm.elbow_rad;
  const int upper = raised <= 20 * kDegree ? 1 : raised <= 45 * kDegree ? 2 : raised <= 90 * kDegree ? 3 : 4;
  const bool is_easy = elbow >= 60 * kDegree - kRounding_rad && elbow <= 100 * kDegree + kRounding_rad;
  return upper + (is_easy ? 1 : 2);
}

}  // namespace vps::scenes
