// SPDX-License-Identifier: BSD-3-Clause
#include "modes/brick_element.h"

#include <Eigen/LU>
#include <cmath>

namespace vps::viewer {
namespace {

std::array<std::array<int, 3>, kBrickNodes> makeNodes() {
  std::array<std::array<int, 3>, kBrickNodes> nodes{};
  int count = 0;
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 3; ++x)
        if (int(x == 1) + int(y == 1) + int(z == 1) <= 1) nodes[count++] = {x, y, z};
  return nodes;
}

/// Axis of the edge that has the node at its midpoint; -1 for a corner.
int edgeOf(const std::array<int, 3>& node) {
  for (int k = 0; k < 3; ++k)
    if (node[k] == 1) return k;
  return -1;
}

/// Exponents of x, y and z of the monomials that span the shape functions.
const std::array<std::array<int, 3>, kBrickNodes>& monomials() {
  static const std::array<std::array<int, 3>, kBrickNodes> kMonomials = [] {
    std::array<std::array<int, 3>, kBrickNodes> all{};
    int count = 0;
    for (int i = 0; i < 27; ++i) {
      const std::array<int, 3> powers = {i % 3, i / 3 % 3, i / 9};
      if (int(powers[0] == 2) + int(powers[1] == 2) + int(powers[2] == 2) <= 1) all[count++] = powers;
    }
    return all;
  }();
  return kMonomials;
}

/// Column i has the monomial coefficients of shape function i: the inverse of the monomials' values at the
/// nodes.
const BrickMass& shapeCoefficients() {
  static const BrickMass kCoefficients = [] {
    BrickMass at_nodes;
    for (int i = 0; i < kBrickNodes; ++i)
      for (int m = 0; m < kBrickNodes; ++m) {
        at_nodes(i, m) = 1;
        for (int k = 0; k < 3; ++k) at_nodes(i, m) *= std::pow(brickNode(i)[k] - 1, monomials()[m][k]);
      }
    return BrickMass(at_nodes.inverse());
  }();
  return kCoefficients;
}

/// Integrals of d m_i / dx_k * d m_j / dx_l over the filled region, for all monomials m; for k = l = -1,
/// integrals of m_i m_j.
BrickMass integralOf(const BrickFilling& filling, int k, int l) {
  BrickMass integral;
  for (int i = 0; i < kBrickNodes; ++i)
    for (int j = 0; j < kBrickNodes; ++j) {
      std::array<int, 3> a = monomials()[i], b = monomials()[j];
      double factor = 1;
      if (k >= 0) factor = a[k]-- * b[l]--;
      integral(i, j) = factor == 0 ? 0 : factor * filling.moment(a[0] + b[0], a[1] + b[1], a[2] + b[2]);
    }
  return integral;
}

/// Stiffness matrix from H, where H(k n + i, l n + j) is the integral of d shape_i / dx_k * d shape_j / dx_l.
BrickStiffness stiffnessFrom(const BrickStiffness& H, const Elasticity& material) {
  const double nu = material.poissons_ratio, shear_Pa = material.youngs_modulus_Pa / (2 * (1 + nu));
  const double lame_Pa = 2 * shear_Pa * nu / (1 - 2 * nu);
  constexpr int n = kBrickNodes;
  BrickStiffness K;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double trace = H(i, j) + H(n + i, n + j) + H(2 * n + i, 2 * n + j);
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l)
          K(3 * i + k, 3 * j + l) = lame_Pa * H(k * n + i, l * n + j) + shear_Pa * H(l * n + i, k * n + j) +
                                    (k == l ? shear_Pa * trace : 0);
    }
  return K;
}

}  // namespace

BrickFilling::Powers BrickFilling::powersOf(double x) {
  Powers powers = {1};
  for (int i = 1; i < kPowers; ++i) powers[i] = powers[i - 1] * x;
  return powers;
}

void BrickFilling::addBox(const Vec3& low, const Vec3& high) {
  std::array<Powers, 3> integral{};  // integral of each power along each axis, divided by 2
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < kPowers; ++i)
      integral[k][i] = (std::pow(high[k], i + 1) - std::pow(low[k], i + 1)) / (2 * (i + 1));
  for (int z = 0; z < kPowers; ++z)
    for (int y = 0; y < kPowers; ++y)
      for (int x = 0; x < kPowers; ++x)
        moments_[x + kPowers * (y + kPowers * z)] += integral[0][x] * integral[1][y] * integral[2][z];
}

const BrickFilling& wholeBrick() {
  static const BrickFilling kWhole = [] {
    BrickFilling whole;
    whole.addBox(-Vec3::Ones(), Vec3::Ones());
    return whole;
  }();
  return kWhole;
}

const std::array<int, 3>& brickNode(int node) {
  static const std::array<std::array<int, 3>, kBrickNodes> kNodes = makeNodes();
  return kNodes[node];
}

BrickShapes brickShapes(const Vec3& xi) {
  BrickShapes shapes;
  for (int i = 0; i < kBrickNodes; ++i) {
    const std::array<int, 3>& node = brickNode(i);
    const Vec3 s(node[0] - 1, node[1] - 1, node[2] - 1);
    const double f = (Vec3::Ones() + s.cwiseProduct(xi)).prod();
    const int edge = edgeOf(node);
    shapes[i] = edge < 0 ? f * (s.dot(xi) - 2) / 8 : f * (1 - xi[edge] * xi[edge]) / 4;
  }
  return shapes;
}

BrickMatrices brickMatrices(const Vec3& size_m, const Elasticity& material, const BrickFilling& filling) {
  const BrickMass& C = shapeCoefficients();
  constexpr int n = kBrickNodes;
  BrickStiffness H;
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3; ++l)
      H.block<n, n>(k * n, l * n) =
          size_m.prod() * 4 / (size_m[k] * size_m[l]) * (C.transpose() * integralOf(filling, k, l) * C);
  return {stiffnessFrom(H, material), size_m.prod() * (C.transpose() * integralOf(filling, -1, -1) * C)};
}

}  // namespace vps::viewer
