// SPDX-License-Identifier: BSD-3-Clause
#include "motion/least_motion.h"
#include "vps/stoppable.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>

namespace vps::scenes {

namespace {

/// The derivative of a row's gap by the motion of the body that has the point.
SixNumbers slope(const GapRow& row, const LooseBody& body) {
  SixNumbers out;
  out << row.n_W, (row.p_W - body.at_W).cross(row.n_W) / body.arm_m;
  return out;
}

/// The derivatives of all rows. A body that does not move has a slope of zero at index 0.
struct Slopes {
  struct Side {
    Eigen::Index at = 0;
    SixNumbers slope = SixNumbers::Zero();
  };
  std::vector<std::array<Side, 2>> of_row;
  Motions start_m;  ///< by row: the gap extrapolated to x = 0

  Slopes(std::span<const GapRow> rows, std::span<const LooseBody> bodies, const Motions& from)
      : of_row(rows.size()), start_m(static_cast<Eigen::Index>(rows.size())) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const GapRow& row = rows[k];
      if (row.of != GapRow::kHeld) of_row[k][0] = {6 * Eigen::Index(row.of), slope(row, bodies[row.of])};
      if (row.above != GapRow::kHeld)
        of_row[k][1] = {6 * Eigen::Index(row.above), -slope(row, bodies[row.above])};
      start_m[Eigen::Index(k)] = row.gap_m - change(k, from);
    }
  }
  [[nodiscard]] double change(std::size_t row, const Motions& x) const {
    double sum = 0;
    for (const Side& side : of_row[row]) sum += side.slope.dot(x.segment<6>(side.at));
    return sum;
  }
  [[nodiscard]] double gap(std::size_t row, const Motions& x) const {
    return start_m[Eigen::Index(row)] + change(row, x);
  }
};

double costOf(const Slopes& slopes, const Motions& most_m, double e, const Motions& x) {
  double sum = e * x.squaredNorm() + (x.cwiseAbs() - most_m).cwiseMax(0).squaredNorm();
  for (std::size_t k = 0; k < slopes.of_row.size(); ++k)
    if (const double gap_m = slopes.gap(k, x); gap_m < 0) sum += gap_m * gap_m;
  return 0.5 * sum;
}

/// The minimum under the assumption that the gaps that are negative at x stay the only negative ones.
Motions newtonPoint(const Slopes& slopes, const Motions& most_m, double e, const Motions& x) {
  Eigen::MatrixXd H = e * Eigen::MatrixXd::Identity(x.size(), x.size());
  Motions right = Motions::Zero(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (std::abs(x[i]) <= most_m[i]) continue;
    H(i, i) += 1;
    right[i] += std::copysign(most_m[i], x[i]);
  }
  for (std::size_t k = 0; k < slopes.of_row.size(); ++k) {
    if (!(slopes.gap(k, x) < 0)) continue;
    for (const Slopes::Side& one : slopes.of_row[k]) {
      right.segment<6>(one.at) -= slopes.start_m[Eigen::Index(k)] * one.slope;
      for (const Slopes::Side& other : slopes.of_row[k])
        H.block<6, 6>(one.at, other.at) += one.slope * other.slope.transpose();
    }
  }
  return H.ldlt().solve(right);
}

}  // namespace

Motions leastMotion(std::span<const GapRow> rows, std::span<const LooseBody> bodies, const Motions& from,
                    double e, std::vector<double>& closed_m) {
  constexpr int kMostSteps = 60, kMostHalvings = 20;
  constexpr double kEnough = 1e-9;  // relative decrease of the cost that ends the iteration
  const Slopes slopes(rows, bodies, from);
  Motions x = from, most_m(from.size());
  for (std::size_t i = 0; i < bodies.size(); ++i)
    most_m.segment<6>(6 * Eigen::Index(i)).setConstant(bodies[i].most_m);
  double cost = costOf(slopes, most_m, e, x);
  for (int i = 0; i < kMostSteps && cost > 0; ++i) {
    pollStop();
    const Motions step = newtonPoint(slopes, most_m, e, x) - x;
    double share = 1, next = costOf(slopes, most_m, e, x + step);
    for (int k = 0; k < kMostHalvings && !(next < cost); ++k)
      next = costOf(slopes, most_m, e, x + (share *= 0.5) * step);
    if (!(next < cost)) break;
    x += share * step;
    const bool is_done = cost - next <= kEnough * cost;
    cost = next;
    if (is_done) break;
  }
  closed_m.assign(rows.size(), 0);
  for (std::size_t k = 0; k < rows.size(); ++k) closed_m[k] = std::max(0.0, -slopes.gap(k, x));
  return x;
}

Pose poseAfter(const Pose& X_WP, const Vec3& at_W, const SixNumbers& motion) {
  const Mat3 R = rotationFromVector(motion.tail<3>());
  return Pose(R, at_W - R * at_W + motion.head<3>()) * X_WP;
}

Pose movedPose(const Pose& X_WP, const LooseBody& body, const SixNumbers& motion) {
  SixNumbers unscaled = motion;
  unscaled.tail<3>() /= body.arm_m;
  return poseAfter(X_WP, body.at_W, unscaled);
}

}  // namespace vps::scenes
