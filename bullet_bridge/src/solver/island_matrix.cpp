// SPDX-License-Identifier: BSD-3-Clause
#include "solver/island_matrix.h"

#include <algorithm>

namespace vps::bullet::inline v0 {
namespace {

std::uint64_t blockKey(int row, int column) {
  return static_cast<std::uint64_t>(column) << 32 | static_cast<std::uint32_t>(row);
}
int rowOf(std::uint64_t key) {
  return static_cast<int>(key & 0xffffffffu);
}
int columnOf(std::uint64_t key) {
  return static_cast<int>(key >> 32);
}

}  // namespace

void IslandMatrix::start(std::size_t body_count, std::span<const std::pair<int, int>> pairs) {
  const bool is_as_large = body_count == body_count_;
  body_count_ = body_count;
  const auto size = static_cast<Eigen::Index>(6 * body_count);
  if (isDense()) {
    dense_.setZero(size, size);
    return;
  }
  wanted_.clear();
  for (int i = 0; i < static_cast<int>(body_count); ++i) wanted_.push_back(blockKey(i, i));
  for (const auto& [i, j] : pairs) wanted_.push_back(blockKey(std::max(i, j), std::min(i, j)));
  std::sort(wanted_.begin(), wanted_.end());
  wanted_.erase(std::unique(wanted_.begin(), wanted_.end()), wanted_.end());
  if (!is_as_large || wanted_ != blocks_) {
    blocks_ = wanted_;
    makePattern();
  }
  std::fill_n(sparse_.valuePtr(), sparse_.nonZeros(), 0.0);
}

// Blocks are stored completely, also on the diagonal; the factorisation reads the lower half.
void IslandMatrix::makePattern() {
  first_.assign(body_count_ + 1, 0);
  for (const std::uint64_t key : blocks_) ++first_[static_cast<std::size_t>(columnOf(key)) + 1];
  for (std::size_t i = 0; i < body_count_; ++i) first_[i + 1] += first_[i];
  const auto size = static_cast<Eigen::Index>(6 * body_count_);
  sparse_.resize(size, size);
  sparse_.resizeNonZeros(static_cast<Eigen::Index>(36 * blocks_.size()));
  int next = 0;
  for (std::size_t body = 0; body < body_count_; ++body)
    for (int c = 0; c < 6; ++c) {
      sparse_.outerIndexPtr()[6 * body + static_cast<std::size_t>(c)] = next;
      for (int b = first_[body]; b < first_[body + 1]; ++b)
        for (int r = 0; r < 6; ++r)
          sparse_.innerIndexPtr()[next++] = 6 * rowOf(blocks_[static_cast<std::size_t>(b)]) + r;
    }
  sparse_.outerIndexPtr()[size] = next;
  sparse_factor_.analyzePattern(sparse_);
}

void IslandMatrix::add(int row_body, int column_body, const Mat6& block) {
  if (row_body < column_body) return;
  if (isDense()) {
    dense_.block<6, 6>(6 * row_body, 6 * column_body) += block;
    return;
  }
  const auto column = static_cast<std::size_t>(column_body);
  const auto begin = blocks_.begin() + first_[column], end = blocks_.begin() + first_[column + 1];
  const auto at = std::lower_bound(begin, end, blockKey(row_body, column_body));
  const auto in_column = static_cast<Eigen::Index>(at - begin);
  for (int c = 0; c < 6; ++c) {
    double* to = sparse_.valuePtr() + sparse_.outerIndexPtr()[6 * column_body + c] + 6 * in_column;
    for (int r = 0; r < 6; ++r) to[r] += block(r, c);
  }
}

bool IslandMatrix::factorise() {
  if (isDense()) {
    dense_factor_.compute(dense_);
    return dense_factor_.info() == Eigen::Success;
  }
  sparse_factor_.factorize(sparse_);
  return sparse_factor_.info() == Eigen::Success;
}

void IslandMatrix::solve(std::span<const Vec6> gradient, std::vector<Vec6>& step) {
  x_.resize(static_cast<Eigen::Index>(6 * gradient.size()));
  for (std::size_t i = 0; i < gradient.size(); ++i)
    x_.segment<6>(static_cast<Eigen::Index>(6 * i)) = -gradient[i];
  if (isDense())
    dense_factor_.solveInPlace(x_);
  else
    x_ = sparse_factor_.solve(x_);
  step.resize(gradient.size());
  for (std::size_t i = 0; i < step.size(); ++i) step[i] = x_.segment<6>(static_cast<Eigen::Index>(6 * i));
}

}  // namespace vps::bullet::inline v0
