// SPDX-License-Identifier: BSD-3-Clause
#include "pair/pair_measures.h"
#include "vps/box_intersection.h"
#include "vps/stoppable.h"

#include <algorithm>

namespace vps::scenes {

namespace {

/// Distance below which the direction to the nearest point is not reliable, because of rounding.
constexpr double kBallDirection_m = 1e-9;

}  // namespace

SharedBalls::SharedBalls(const PlacedSurface& a, const PlacedSurface& b)
    : a_(*a.surface), b_(*b.surface), X_WA_(a.X_WP), X_BA_(b.X_WP.inverse() * a.X_WP) {
  const Box box_A = moved(b_.box(), X_BA_.inverse());
  both_A_ = intersection(a_.box(), box_A);
}

double SharedBalls::radiusAt(const Vec3& p_A) const {
  const double in_a_m = -a_.solid().signedDistance(p_A);
  return std::min(in_a_m, -b_.solid().signedDistance(X_BA_ * p_A));
}

SharedBalls::Limit SharedBalls::limitAt(const Vec3& p_A) const {
  const auto of = [&](const PartSurface& solid, const Vec3& p, bool is_of_b) {
    const Solid::Closest nearest = solid.solid().closest(p);
    const Vec3 to = nearest.q - p;
    const double sign = nearest.normal.dot(to) > 0 ? 1 : -1;
    const Vec3 out = nearest.distance_m > kBallDirection_m ? Vec3(sign * to.normalized()) : nearest.normal;
    return Limit{sign * nearest.distance_m, is_of_b, out, nearest.q};
  };
  const Limit in_a = of(a_, p_A, false), in_b = of(b_, X_BA_ * p_A, true);
  if (in_a.radius_m <= in_b.radius_m) return in_a;
  const Pose X_AB = X_BA_.inverse();
  return {in_b.radius_m, true, X_AB.R * in_b.out, X_AB * in_b.q};
}

Overlap SharedBalls::grownFrom(const Vec3& p_A, double step_m) const {
  return grownFrom(p_A, Vec3::Constant(step_m));
}

// Steps to the best of the 26 neighbours while the radius grows, then halves the step. Steps along the axes
// alone would end at ridges between faces.
Overlap SharedBalls::grownFrom(const Vec3& p_A, Vec3 step_A) const {
  constexpr int kRounds = 60;
  Vec3 best_A = p_A;
  double radius_m = radiusAt(p_A);
  for (int round = 0; round < kRounds; ++round) {
    pollStop();
    const Vec3 from_A = best_A;
    for (int k = 0; k < 27; ++k) {
      const Vec3 at_A = from_A + step_A.cwiseProduct(Vec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1));
      if (const double at_m = radiusAt(at_A); at_m > radius_m) {
        radius_m = at_m;
        best_A = at_A;
      }
    }
    if (best_A == from_A) step_A *= 0.5;
  }
  return {std::max(radius_m, 0.0), X_WA_ * best_A};
}

Overlap SharedBalls::greatest() const {
  constexpr int kGrid = 12;
  if (both_A_.isEmpty()) return {};
  const Vec3 cell = both_A_.size() / kGrid;
  Vec3 best_A = Vec3::Zero();
  double best_m = 0;
  for (int i = 0; i < kGrid * kGrid * kGrid; ++i) {
    pollStop();
    const Vec3 at(i % kGrid + 0.5, i / kGrid % kGrid + 0.5, i / kGrid / kGrid + 0.5);
    const Vec3 p_A = both_A_.min + at.cwiseProduct(cell);
    if (const double radius_m = radiusAt(p_A); radius_m > best_m) {
      best_m = radius_m;
      best_A = p_A;
    }
  }
  return best_m > 0 ? grownFrom(best_A, 0.5 * cell) : Overlap{};
}

}  // namespace vps::scenes
