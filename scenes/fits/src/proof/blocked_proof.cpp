// SPDX-License-Identifier: BSD-3-Clause
#include "proof/blocked_proof.h"
#include "vps/stoppable.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vps::scenes {

namespace {

/// How far a body may be from its present place.
struct BodyReach {
  double most_m = 0;    ///< greatest displacement of any point of the body
  double turn_rad = 0;  ///< greatest turn
};

/// The contribution of a touch to the mean of provenOverlap_m(), without the touch's weight.
struct Bounded {
  double most_m = 0;  ///< h of provenOverlap_m() plus the terms that are not linear in the motion
  Vec3 n_W = Vec3::Zero(), c_W = Vec3::Zero();
};

/// Bounds of the displacements of all bodies from their present places.
class Reaches {
 public:
  Reaches(const std::vector<PlacedSurface>& parts, const std::vector<Pose>& X_WP,
          const std::vector<MovableBody>& bodies, const std::vector<double>& moved_m)
      : parts_(parts), X_WP_(X_WP), bodies_(bodies), body_of_(bodyOfPart(bodies, parts.size())) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const double most_m = bodies[i].allowed_m + moved_m[i];
      const double turn_rad = bodies[i].is_fixed ? 0 : bodies[i].mostTurn(most_m);
      // at() is the middle of the body as drawn; a thin body that has moved may no longer contain this point.
      reach_.push_back({most_m + turn_rad * moved_m[i], turn_rad});
    }
  }
  [[nodiscard]] std::size_t bodyOf(std::size_t part) const { return body_of_[part]; }
  [[nodiscard]] const BodyReach& of(std::size_t body) const { return reach_[body]; }
  [[nodiscard]] const Vec3& at(std::size_t body) const { return bodies_[body].loose.at_W; }

  /// Bounds the contribution of a touch. Of several balls that touch the surface at the nearest point q_A,
  /// the ball with the least bound is used.
  [[nodiscard]] Bounded bounded(const Touch& touch) const {
    constexpr int kBalls = 14;
    constexpr double kSmaller = 0.6;
    const std::size_t a = bodyOf(touch.of), b = bodyOf(touch.above);
    const PartSurface& above = *parts_[touch.above].surface;
    const Vec3 p_W = X_WP_[touch.of] * touch.p_O;
    const double w_m = of(a).most_m + of(b).most_m;
    const auto turned_m = [&](std::size_t body, const Vec3& x_W) {
      return 0.5 * of(body).turn_rad * of(body).turn_rad * (x_W - at(body)).norm();
    };
    Bounded best{std::numeric_limits<double>::infinity()};
    double radius_m = 0.5 * above.box().size().norm();
    for (int i = 0; i < kBalls; ++i, radius_m *= kSmaller) {
      pollStop();
      const Vec3 c_A = touch.q_A - radius_m * touch.n_A;
      const double inside_m = -above.solid().signedDistance(c_A);
      if (!(inside_m > 0)) continue;
      const Vec3 c_W = X_WP_[touch.above] * c_A, v = p_W - c_W;
      const double length_m = v.norm();
      if (!(length_m > 2 * w_m)) continue;
      const double most_m =
          length_m - inside_m + w_m * w_m / (2 * (length_m - w_m)) + turned_m(a, p_W) + turned_m(b, c_W);
      if (most_m < best.most_m) best = {most_m, v / length_m, c_W};
    }
    return best;
  }

 private:
  const std::vector<PlacedSurface>& parts_;
  const std::vector<Pose>& X_WP_;
  const std::vector<MovableBody>& bodies_;
  std::vector<std::size_t> body_of_;
  std::vector<BodyReach> reach_;
};

}  // namespace

std::vector<double> greatestGaps_m(const std::vector<PlacedSurface>& parts, const std::vector<Pose>& X_WP,
                                   std::span<const PressedTouch> touches,
                                   const std::vector<MovableBody>& bodies,
                                   const std::vector<double>& moved_m) {
  const Reaches reaches(parts, X_WP, bodies, moved_m);
  std::vector<double> out;
  for (const PressedTouch& pressed : touches) out.push_back(reaches.bounded(pressed.touch).most_m);
  return out;
}

double provenOverlap_m(const std::vector<PlacedSurface>& parts, const std::vector<Pose>& X_WP,
                       std::span<const PressedTouch> touches, const std::vector<MovableBody>& bodies,
                       const std::vector<double>& moved_m) {
  const Reaches reaches(parts, X_WP, bodies, moved_m);
  double weight = 0, sum_m = 0;
  std::vector<Vec3> force(bodies.size(), Vec3::Zero()), torque = force;
  for (const PressedTouch& pressed : touches) {
    const Bounded found = reaches.bounded(pressed.touch);
    if (!(pressed.weight > 0) || !std::isfinite(found.most_m)) continue;
    const std::size_t a = reaches.bodyOf(pressed.touch.of), b = reaches.bodyOf(pressed.touch.above);
    const Vec3 p_W = X_WP[pressed.touch.of] * pressed.touch.p_O;
    weight += pressed.weight;
    sum_m += pressed.weight * (found.most_m + pressed.error_m);
    force[a] += pressed.weight * found.n_W;
    force[b] -= pressed.weight * found.n_W;
    torque[a] += pressed.weight * (p_W - reaches.at(a)).cross(found.n_W);
    torque[b] -= pressed.weight * (found.c_W - reaches.at(b)).cross(found.n_W);
  }
  if (!(weight > 0)) return 0;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (!bodies[i].is_fixed)
      sum_m += force[i].norm() * reaches.of(i).most_m + torque[i].norm() * reaches.of(i).turn_rad;
  return -sum_m / weight;
}

}  // namespace vps::scenes
