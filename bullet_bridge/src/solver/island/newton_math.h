// SPDX-License-Identifier: BSD-3-Clause
// Functions that Newton's method uses for both contact methods: wrenches, sums of stiffness, the line
// search.
#pragma once

#include <algorithm>
#include <cmath>

#include "solver/island/island.h"
#include "vps/contact_tolerances.h"

namespace vps::bullet {

/// Wrench about the origin of a force f at r.
inline Vec6 wrenchOf(const Vec3& r, const Vec3& f) {
  return stacked(r.cross(f), f);
}

/// Transforms a twist about `from` into one about `to`.
inline Mat6 twistShift(const Vec3& from, const Vec3& to) {
  Mat6 X = Mat6::Identity();
  X.bottomLeftCorner<3, 3>() = -crossMatrix(to - from);
  return X;
}

/// Sum of symmetric matrices.
class SymmetricSum {
 public:
  // Column by column, so that the compiler vectorises the inner loop.
  void add(double factor, const Vec6& g) {
    for (int c = 0; c < 6; ++c) {
      const double scaled = factor * g[c];
      for (int r = 0; r < 6; ++r) sum_(r, c) += scaled * g[r];
    }
  }
  // Adds a spring at a point that is equally stiff in all directions.
  void addEven(double k, const Vec3& r) {
    k_ += k;
    kr_ += k * r;
    krr_ += (k * r) * r.transpose();
  }
  // v = v_c - [r] w, so k I becomes k [(r.r) I - r r', [r]; -[r], I].
  [[nodiscard]] Mat6 total() const {
    Mat6 H = sum_;
    H.topLeftCorner<3, 3>() += krr_.trace() * Mat3::Identity() - krr_;
    H.topRightCorner<3, 3>() += crossMatrix(kr_);
    H.bottomLeftCorner<3, 3>() -= crossMatrix(kr_);
    H.bottomRightCorner<3, 3>() += k_ * Mat3::Identity();
    return H;
  }

 private:
  Mat6 sum_ = Mat6::Zero();
  double k_ = 0;
  Vec3 kr_ = Vec3::Zero();
  Mat3 krr_ = Mat3::Zero();
};

/// Minimises a convex function along a step of Newton's method: returns 1, or the share of the step at which
/// the function's derivative along the step is nearly zero. The derivative increases along the step, since
/// the function is convex.
/// @param slope  derivative at the start of the step; negative
/// @param slopeAt  returns the derivative at a share of the step
template <typename SlopeAt>
double lineSearch(double slope, const SlopeAt& slopeAt) {
  double low = 0, low_slope = slope, high = 1, high_slope = slopeAt(1);
  if (high_slope <= -kAccuracyShare * slope) return 1;
  double share = 1;
  for (int k = 0; k < kMostPlaces; ++k) {
    const double room = high - low;
    share =
        std::clamp(low - low_slope * room / (high_slope - low_slope), low + 0.05 * room, high - 0.05 * room);
    const double here = slopeAt(share);
    if (std::abs(here) <= -kAccuracyShare * slope) break;
    (here < 0 ? low : high) = share;
    (here < 0 ? low_slope : high_slope) = here;
  }
  return share;
}

}  // namespace vps::bullet
