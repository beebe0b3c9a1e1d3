// SPDX-License-Identifier: BSD-3-Clause
// Penalty forces of one pair of bodies, as functions of their relative twist.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "solver/island/island.h"
#include "solver/penalty/penalty_pair.h"
#include "vps/friction.h"

namespace vps::bullet {

/// Twists are of body 0 relative to body 1, about center, in W. Most points of a pair are near but do not
/// press. The data that decides whether a point presses is stored in columns, so that such points cost
/// little.
class PenaltyPatch {
 public:
  /// Force of a point at a twist.
  struct PointForce {
    double f_n_N = 0;
    BristleForce friction;  // on body 1, along the slip of body 0
  };

  /// @param off_tangent  for body 0 and 1: maps a point's position from its body's origin to its displacement
  ///   in the step beyond that of the body's present velocity
  /// @param level  level of groupPoints()
  void build(PenaltyPair& pair, const Mat3 (&off_tangent)[2], double dt_s, int level);

  /// Sets the gradient, and with_hessian the Hessian, of the potential at a twist. O(points), cheap for
  /// points that do not press.
  void evaluate(const Vec6& twist, bool with_hessian);
  /// Updates the limits of friction from the normal forces at a twist. Raises `change` and `greatest` to the
  /// greatest change and limit [N].
  void updateLimits(const Vec6& twist, double& change, double& greatest);
  /// Writes forces and bristle deflections at a twist to the pair's points. The points of a group share its
  /// force in proportion to their stiffness and have the same deflection, so that another grouping in the
  /// next step starts from the same forces and deflections.
  void finish(const Vec6& twist) const;

  [[nodiscard]] std::size_t pointCount() const { return points_.size(); }

  PenaltyPair* pair = nullptr;
  int body[2] = {-1, -1};
  Mat6 X[2];  ///< maps each body's twist to its share of the relative twist at the centre
  Vec6 fixed = Vec6::Zero();
  Vec3 center = Vec3::Zero();
  double radius_m = 0;
  Vec6 gradient;
  Mat6 hessian;

 private:
  struct Point {
    Vec3 r;  // vector from the centre
    Vec3 n;
    double k;
    double mu;
  };
  using Columns = std::array<std::vector<double>, 3>;
  void findGaps(const Vec6& twist) const;
  void findSlips(const Vec6& twist) const;
  [[nodiscard]] bool isActive(std::size_t i) const { return end_m_[i] < 0 || limit_N_[i] > 0; }
  [[nodiscard]] PointForce forceAt(std::size_t i) const;

  double dt_s_ = 0;
  std::vector<PointGroup> groups_;             // groups of the pair's points
  std::vector<Point> points_;                  // one point per group
  std::array<std::vector<double>, 6> wrench_;  // wrench of a unit normal force, by component: r x n, n
  std::vector<double> gap_m_, limit_N_;
  Columns r_m_, bend_m_;
  // At the end of the step, for the last twist evaluated: gaps, and bristle deflections
  // without slip.
  mutable std::vector<double> end_m_;
  mutable Columns bent_m_;
};

}  // namespace vps::bullet
