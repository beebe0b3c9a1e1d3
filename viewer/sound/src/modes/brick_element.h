// SPDX-License-Identifier: BSD-3-Clause
// Stiffness and mass of a box-shaped finite element of elastic material.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "vps/pose.h"

namespace vps::viewer {

struct Elasticity {
  double youngs_modulus_Pa = 210e9;
  double poissons_ratio = 0.3;
};

/// Nodes of a brick: eight corners and the midpoints of twelve edges.
constexpr int kBrickNodes = 20;
using BrickStiffness = Eigen::Matrix<double, 3 * kBrickNodes, 3 * kBrickNodes>;
using BrickMass = Eigen::Matrix<double, kBrickNodes, kBrickNodes>;
using BrickShapes = Eigen::Matrix<double, kBrickNodes, 1>;

/// The filled region of the brick [-1, 1]^3, described by the integrals of x^i y^j z^k over the region, with
/// i, j, k up to 4. The integrals are normalised, so that the integral of 1 is the filled share of the brick.
class BrickFilling {
 public:
  static constexpr int kPowers = 5;

  /// Adds the box [low, high] to the region.
  void addBox(const Vec3& low, const Vec3& high);
  /// Divides the box [low, high] into equal cells, `along` cells along each edge (at most 8), and adds the
  /// filled cells to the region.
  template <class IsFilled>  // bool(int x, int y, int z)
  void addShares(const Vec3& low, const Vec3& high, int along, const IsFilled& isFilled);

  [[nodiscard]] double total() const { return moments_[0]; }
  [[nodiscard]] double moment(int x, int y, int z) const {
    return moments_[static_cast<std::size_t>(x + kPowers * (y + kPowers * z))];
  }

 private:
  using Powers = std::array<double, kPowers>;
  static Powers powersOf(double x);

  std::array<double, std::size_t{kPowers} * kPowers * kPowers> moments_{};
};

/// The filling of a brick that is filled completely.
const BrickFilling& wholeBrick();

/// Position of a node along each axis: 0, 1 (the middle) or 2.
const std::array<int, 3>& brickNode(int node);

/// Values of the 20 shape functions at the point xi of [-1, 1]^3 (20-node "serendipity" brick). Source:
/// Zienkiewicz and Taylor, "The Finite Element Method", 2000, volume 1, section 8.8.
BrickShapes brickShapes(const Vec3& xi);

struct BrickMatrices {
  BrickStiffness stiffness_N_per_m;  ///< rows 3 i to 3 i + 2: x, y, z of node i
  BrickMass mass_share_m3;           ///< mass matrix divided by the density; equal for x, y and z
};

/// Stiffness and mass of a brick. Energy is integrated over the filled region only, so that a thin wall
/// inside a brick keeps its place and thickness. Quadratic displacements can bend such a wall in any
/// direction: a wall of a sixth of a brick is as accurate as a wall of a whole brick. Trilinear elements with
/// incompatible modes cannot bend a wall in any direction: with a wall of half a brick, frequencies were 20 %
/// too high. Source: Parvizian, Duester and Rank, "Finite cell method", Comput. Mech. 41, 2007.
BrickMatrices brickMatrices(const Vec3& size_m, const Elasticity& material, const BrickFilling& filling);

template <class IsFilled>
void BrickFilling::addShares(const Vec3& low, const Vec3& high, int along, const IsFilled& isFilled) {
  const Vec3 step = (high - low) / along;
  const double share = step.prod() / 8;
  std::array<std::array<Powers, 3>, 8> powers;  // powers of the coordinates of each cell's centre
  for (int i = 0; i < along; ++i)
    for (int k = 0; k < 3; ++k) powers[i][k] = powersOf(low[k] + (i + 0.5) * step[k]);
  for (int z = 0; z < along; ++z) {
    std::array<double, std::size_t{kPowers} * kPowers> layer{};
    for (int y = 0; y < along; ++y) {
      Powers row{};
      for (int x = 0; x < along; ++x)
        if (isFilled(x, y, z))
          for (int i = 0; i < kPowers; ++i) row[i] += powers[x][0][i];
      for (int j = 0; j < kPowers; ++j)
        for (int i = 0; i < kPowers; ++i) layer[i + kPowers * j] += row[i] * powers[y][1][j];
    }
    for (int k = 0; k < kPowers; ++k)
      for (int i = 0; i < kPowers * kPowers; ++i)
        moments_[i + kPowers * kPowers * k] += share * layer[i] * powers[z][2][k];
  }
}

}  // namespace vps::viewer
