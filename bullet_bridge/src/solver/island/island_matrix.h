// SPDX-License-Identifier: BSD-3-Clause
// A sparse matrix over the bodies of an island, in blocks of 6x6, and its factorisation.
#pragma once

#include <Eigen/Dense>
#include <Eigen/StdVector>
#include <span>
#include <utility>
#include <vector>

#include "solver/island/island.h"

namespace vps::bullet {

/// Has blocks on the diagonal and for bodies that touch. The pattern is symmetric; the values need not be.
/// Factorised as LU without pivoting of blocks, in an elimination order with little fill-in (minimum degree).
/// Pattern and order are kept as long as the same bodies touch.
///
/// Cost: some 70 ns for each product of two blocks, and d^2 products for a body that touches d bodies that
/// are eliminated later.
class IslandMatrix {
 public:
  /// Sets which blocks exist: the diagonal, and one for each of `pairs` (any order, repeats allowed).
  void setPattern(std::size_t body_count, std::span<const std::pair<int, int>> pairs);
  void setZero();
  /// Adds a matrix to the block of two bodies.
  void add(int row_body, int column_body, const Mat6& block);
  /// Adds matrices to the four blocks of one pair of bodies.
  /// @param blockOf  (i, j): matrix for sides i and j; a side whose body is -1 has no block
  template <typename BlockOf>
  void addPair(const int (&body)[2], const BlockOf& blockOf) {
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        if (body[i] >= 0 && body[j] >= 0) add(body[i], body[j], blockOf(i, j));
  }
  /// Returns false if a diagonal block has no inverse.
  [[nodiscard]] bool factorise();
  /// Newton's step: minus the inverse of the factorised matrix times the gradient.
  void solve(std::span<const Vec6> gradient, std::vector<Vec6>& step);

 private:
  void makePattern();
  [[nodiscard]] Mat6& blockAt(int row, int column);

  std::size_t body_count_ = 0;
  std::vector<std::pair<int, int>> pairs_, wanted_;  // lower body first in each pair; ascending
  std::vector<int> place_, body_;  // place of each body in the order of elimination; body at each place
  // For each place: the later places with which it has blocks, ascending.
  std::vector<std::size_t> first_;
  std::vector<int> later_;
  // For each product of the elimination, in order: the block from which it is subtracted.
  std::vector<Mat6*> targets_;
  std::vector<Mat6> diagonal_, inverse_;
  std::vector<Mat6> below_, beside_;  // by index in later_: row later, column place; and the transposed place
  std::vector<Vec6> x_;
};

}  // namespace vps::bullet
