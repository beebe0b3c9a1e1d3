// SPDX-License-Identifier: BSD-3-Clause
#include "motion/gap_program.h"

#include <array>
#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace vps::scenes {

namespace {

using Seven = Eigen::Matrix<double, 7, 1>;
using Basis = Eigen::Matrix<double, 7, 7>;

// The program: minimise the sum of w_i at_zero_i + sum_k (y_k + z_k) with w, y, z >= 0, sum_i w_i slope_i + y
// - z = 0 and sum_i w_i = 1. Columns 0 to n - 1 are w, then y, then z.
class Program {
 public:
  explicit Program(std::span<const LinearGap> gaps) : gaps_(gaps) {}

  [[nodiscard]] std::size_t columns() const { return gaps_.size() + 12; }
  [[nodiscard]] double cost(std::size_t j) const { return j < gaps_.size() ? gaps_[j].at_zero_m : 1; }
  [[nodiscard]] Seven column(std::size_t j) const {
    Seven out = Seven::Zero();
    if (j < gaps_.size())
      out << gaps_[j].slope_m, 1;
    else
      out[Eigen::Index((j - gaps_.size()) % 6)] = j - gaps_.size() < 6 ? 1 : -1;
    return out;
  }
  /// The basis of a single gap, whose slope is balanced by y and z.
  [[nodiscard]] std::array<std::size_t, 7> start(std::size_t gap) const {
    std::array<std::size_t, 7> basis{};
    for (std::size_t k = 0; k < 6; ++k)
      basis[k] = gaps_.size() + k + (gaps_[gap].slope_m[Eigen::Index(k)] > 0 ? 6 : 0);
    basis[6] = gap;
    return basis;
  }

 private:
  std::span<const LinearGap> gaps_;
};

double boundOf(std::span<const LinearGap> gaps, const std::vector<double>& weight) {
  LinearGap mean;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    mean.at_zero_m += weight[i] * gaps[i].at_zero_m;
    mean.slope_m += weight[i] * gaps[i].slope_m;
  }
  return mean.at_zero_m + mean.slope_m.cwiseAbs().sum();
}

}  // namespace

GreatestGap greatestLeastGap(std::span<const LinearGap> gaps) {
  constexpr int kMostSteps = 200;
  constexpr double kNone = 1e-12;  // of the scale of the costs; smaller improvements and pivots are rounding
  std::size_t least = 0;
  double scale = std::numeric_limits<double>::min();
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    if (gaps[i].at_zero_m < gaps[least].at_zero_m) least = i;
    scale = std::max({scale, std::abs(gaps[i].at_zero_m), gaps[i].slope_m.cwiseAbs().maxCoeff()});
  }
  // Lengths are divided by the scale, so that y and z cost as much as the gaps.
  std::vector<LinearGap> scaled(gaps.begin(), gaps.end());
  for (LinearGap& gap : scaled) gap = {gap.at_zero_m / scale, gap.slope_m / scale};
  const Program program(scaled);
  std::array<std::size_t, 7> basis = program.start(least);
  Seven value = Seven::Zero();
  for (int step = 0; step < kMostSteps; ++step) {
    Basis B;
    Seven cost;
    for (int k = 0; k < 7; ++k) {
      B.col(k) = program.column(basis[std::size_t(k)]);
      cost[k] = program.cost(basis[std::size_t(k)]);
    }
    const Eigen::PartialPivLU<Basis> lu(B);
    value = lu.solve(Seven(Seven::Unit(6)));
    const Seven price = lu.transpose().solve(cost);
    // The column that improves most enters; after many steps the first that improves, which cannot cycle.
    const bool is_late = step > kMostSteps / 2;
    std::size_t enters = program.columns();
    double best = -kNone;
    for (std::size_t j = 0; j < program.columns(); ++j) {
      const double gain = program.cost(j) - price.dot(program.column(j));
      if (!(gain < best)) continue;
      best = is_late ? -std::numeric_limits<double>::infinity() : gain;
      enters = j;
    }
    if (enters == program.columns()) break;
    const Seven change = lu.solve(program.column(enters));
    int leaves = -1;
    double most = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 7; ++k) {
      if (!(change[k] > kNone)) continue;
      const double ratio = std::max(value[k], 0.0) / change[k];
      if (ratio < most) most = ratio, leaves = k;
    }
    if (leaves < 0) break;
    basis[std::size_t(leaves)] = enters;
  }
  GreatestGap out;
  out.weight.assign(gaps.size(), 0);
  double sum = 0;
  for (std::size_t k = 0; k < 7; ++k)
    if (basis[k] < gaps.size()) sum += out.weight[basis[k]] = std::max(value[Eigen::Index(k)], 0.0);
  if (sum > 0)
    for (double& weight : out.weight) weight /= sum;
  else
    out.weight[least] = 1;
  out.most_m = boundOf(gaps, out.weight);
  return out;
}

}  // namespace vps::scenes
