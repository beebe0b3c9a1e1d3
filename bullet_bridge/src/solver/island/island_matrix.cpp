// SPDX-License-Identifier: BSD-3-Clause
#include "solver/island/island_matrix.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <set>

namespace vps::bullet {

void IslandMatrix::setPattern(std::size_t body_count, std::span<const std::pair<int, int>> pairs) {
  wanted_.clear();
  for (const auto& [i, j] : pairs)
    if (i != j) wanted_.emplace_back(std::min(i, j), std::max(i, j));
  std::sort(wanted_.begin(), wanted_.end());
  wanted_.erase(std::unique(wanted_.begin(), wanted_.end()), wanted_.end());
  if (body_count == body_count_ && wanted_ == pairs_) return;
  body_count_ = body_count;
  pairs_ = wanted_;
  makePattern();
}

void IslandMatrix::setZero() {
  for (std::vector<Mat6>* blocks : {&diagonal_, &below_, &beside_})
    for (Mat6& block : *blocks) block.setZero();
}

void IslandMatrix::makePattern() {
  const auto n = static_cast<int>(body_count_);
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [i, j] : pairs_) {
    entries.emplace_back(i, j, 1.0);
    entries.emplace_back(j, i, 1.0);
  }
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 1.0);
  Eigen::SparseMatrix<double> graph(n, n);
  graph.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(graph, order);
  body_.assign(order.indices().data(), order.indices().data() + n);
  place_.resize(body_count_);
  for (int k = 0; k < n; ++k) place_[static_cast<std::size_t>(body_[static_cast<std::size_t>(k)])] = k;

  std::vector<std::set<int>> later(body_count_);
  for (const auto& [i, j] : pairs_) {
    const auto [a, b] = std::minmax(place_[static_cast<std::size_t>(i)], place_[static_cast<std::size_t>(j)]);
    later[static_cast<std::size_t>(a)].insert(b);
  }
  first_.assign(1, 0);
  later_.clear();
  for (std::size_t k = 0; k < body_count_; ++k) {
    for (auto a = later[k].begin(); a != later[k].end(); ++a)
      later[static_cast<std::size_t>(*a)].insert(std::next(a), later[k].end());
    later_.insert(later_.end(), later[k].begin(), later[k].end());
    first_.push_back(later_.size());
  }
  diagonal_.resize(body_count_);
  inverse_.resize(body_count_);
  below_.resize(later_.size());
  beside_.resize(later_.size());
  targets_.clear();
  for (std::size_t k = 0; k < body_count_; ++k)
    for (std::size_t s = first_[k]; s < first_[k + 1]; ++s)
      for (std::size_t t = first_[k]; t < first_[k + 1]; ++t)
        targets_.push_back(&blockAt(later_[s], later_[t]));
}

// @param row, column  places in the order of elimination
Mat6& IslandMatrix::blockAt(int row, int column) {
  if (row == column) return diagonal_[static_cast<std::size_t>(row)];
  const auto place = static_cast<std::size_t>(std::min(row, column));
  const auto begin = later_.begin() + static_cast<std::ptrdiff_t>(first_[place]),
             end = later_.begin() + static_cast<std::ptrdiff_t>(first_[place + 1]);
  const auto at =
      static_cast<std::size_t>(std::lower_bound(begin, end, std::max(row, column)) - later_.begin());
  return row > column ? below_[at] : beside_[at];
}

void IslandMatrix::add(int row_body, int column_body, const Mat6& block) {
  blockAt(place_[static_cast<std::size_t>(row_body)], place_[static_cast<std::size_t>(column_body)]) += block;
}

bool IslandMatrix::factorise() {
  auto target = targets_.begin();
  for (std::size_t k = 0; k < body_count_; ++k) {
    inverse_[k] = diagonal_[k].inverse();
    if (!inverse_[k].allFinite()) return false;
    for (std::size_t s = first_[k]; s < first_[k + 1]; ++s) {
      below_[s] = (below_[s] * inverse_[k]).eval();
      for (std::size_t t = first_[k]; t < first_[k + 1]; ++t)
        (*target++)->noalias() -= below_[s] * beside_[t];
    }
  }
  return true;
}

void IslandMatrix::solve(std::span<const Vec6> gradient, std::vector<Vec6>& step) {
  x_.resize(body_count_);
  step.resize(body_count_);
  for (std::size_t k = 0; k < body_count_; ++k) x_[k] = -gradient[static_cast<std::size_t>(body_[k])];
  for (std::size_t k = 0; k < body_count_; ++k)
    for (std::size_t s = first_[k]; s < first_[k + 1]; ++s)
      x_[static_cast<std::size_t>(later_[s])] -= below_[s] * x_[k];
  for (std::size_t k = body_count_; k-- > 0;) {
    for (std::size_t s = first_[k]; s < first_[k + 1]; ++s)
      x_[k] -= beside_[s] * x_[static_cast<std::size_t>(later_[s])];
    x_[k] = (inverse_[k] * x_[k]).eval();
    step[static_cast<std::size_t>(body_[k])] = x_[k];
  }
}

}  // namespace vps::bullet
