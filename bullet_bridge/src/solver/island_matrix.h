// SPDX-License-Identifier: BSD-3-Clause
// A symmetric positive definite matrix over the bodies of an island, in blocks of 6x6, and its factorisation.
#pragma once

#include <Eigen/SparseCholesky>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "solver/island.h"

namespace vps::bullet::inline v0 {

/// Dense for a few bodies, sparse for many. The sparse pattern is kept as long as the same bodies touch:
/// finding it and ordering its columns takes several times as long as the factorisation.
class IslandMatrix {
 public:
  /// Sets all entries to zero. Afterwards add() accepts the blocks of `pairs` (row body, column body; any
  /// order, repeats allowed) and the diagonal.
  void start(std::size_t body_count, std::span<const std::pair<int, int>> pairs);
  /// Adds to the block of two bodies. Blocks of the upper half are ignored.
  void add(int row_body, int column_body, const Mat6& block);
  /// False: the matrix is not positive definite.
  [[nodiscard]] bool factorise();
  /// Adds to the blocks of one pair of bodies, each with itself and with the other, those that are read.
  /// @param blockOf  (i, j): block of sides i and j; a side whose body is -1 has none
  template <typename BlockOf>
  void addPair(const int (&body)[2], const BlockOf& blockOf) {
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        if (body[i] >= body[j] && body[j] >= 0) add(body[i], body[j], blockOf(i, j));
  }
  /// Newton's step: minus the inverse of the factorised matrix times the gradient.
  void solve(std::span<const Vec6> gradient, std::vector<Vec6>& step);

 private:
  static constexpr std::size_t kDense = 12;  // assumed: greatest number of bodies for which dense is faster
  [[nodiscard]] bool isDense() const { return body_count_ <= kDense; }
  void makePattern();

  std::size_t body_count_ = 0;
  Eigen::VectorXd x_;
  Eigen::MatrixXd dense_;
  Eigen::LLT<Eigen::MatrixXd> dense_factor_;
  std::vector<std::uint64_t> blocks_, wanted_;  // column body, then row body; ascending
  std::vector<int> first_;                      // of a column body's blocks in blocks_
  Eigen::SparseMatrix<double> sparse_;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> sparse_factor_;
};

}  // namespace vps::bullet::inline v0
