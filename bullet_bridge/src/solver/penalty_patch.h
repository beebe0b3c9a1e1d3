// SPDX-License-Identifier: BSD-3-Clause
// The springs and bristles of one pair of bodies, as functions of their relative twist.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "solver/island.h"
#include "solver/penalty_pair.h"
#include "vps/friction.h"

namespace vps::bullet {

/// Twists are of body 0 against body 1, about center, in W. Most points of a pair are near and do not press:
/// what tells them apart is kept in columns, so that looking at them costs little.
class PenaltyPatch {
 public:
  /// What a point's springs give at a twist.
  struct Push {
    double f_n_N = 0;
    BristleForce friction;  // on body 1, along the slip of body 0
  };

  /// @param off_tangent  of body 0 and 1: what a point's place against its body's origin changes by in the
  /// step,
  ///                     beyond what the body's velocity now says
  void build(PenaltyPair& pair, const Mat3 (&off_tangent)[2], double dt_s);

  /// Sets gradient, and hessian if asked, of the potential at a twist. O(points), little for those that do
  /// not press.
  void evaluate(const Vec6& twist, bool with_hessian);
  /// Limits of friction by the normal forces at a twist. Raises `change` and `greatest` to the greatest
  /// change and limit [N].
  void renewLimits(const Vec6& twist, double& change, double& greatest);
  /// Leaves forces and bends at a twist in the pair's points.
  void finish(const Vec6& twist) const;

  PenaltyPair* pair = nullptr;
  int body[2] = {-1, -1};
  Mat6 X[2];  ///< each body's twist -> its part of the relative twist at the centre
  Vec6 fixed = Vec6::Zero();
  Vec3 center = Vec3::Zero();
  double radius_m = 0;
  Vec6 gradient;
  Mat6 hessian;

 private:
  struct Point {
    Vec3 r;  // from the centre
    Vec3 n;
    double k;
  };
  using Columns = std::array<std::vector<double>, 3>;
  void findGaps(const Vec6& twist) const;
  void findSlips(const Vec6& twist) const;
  [[nodiscard]] bool presses(std::size_t i) const { return end_m_[i] < 0 || limit_N_[i] > 0; }
  [[nodiscard]] Push pushOf(std::size_t i) const;

  double dt_s_ = 0;
  std::vector<Point> points_;
  std::array<std::vector<double>, 6> wrench_;  // of a unit push, by component: r x n, n
  std::vector<double> gap_m_, limit_N_;
  Columns r_m_, bend_m_;
  // At the end of the step, of the last twist looked at: gaps, and bends if nothing slipped.
  mutable std::vector<double> end_m_;
  mutable Columns bent_m_;
};

}  // namespace vps::bullet
