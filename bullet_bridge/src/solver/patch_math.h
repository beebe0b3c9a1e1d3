// SPDX-License-Identifier: BSD-3-Clause
// Twists, wrenches and stiffness of the points of two bodies, about one place near them.
#pragma once

#include "solver/island.h"

namespace vps::bullet {

/// Of a force at r.
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
  // A spring at a point, equally stiff in all directions.
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

}  // namespace vps::bullet
