// SPDX-License-Identifier: BSD-3-Clause
#include "sound/brick_element.h"

#include <Eigen/LU>
#include <cmath>

namespace vps::viewer::inline v0 {
namespace {

using Strain = Eigen::Matrix<double, 6, 3>;  ///< of a displacement: xx, yy, zz, xy, yz, zx
using Matrix6 = Eigen::Matrix<double, 6, 6>;

Matrix6 elasticityMatrix(const Elasticity& material) {
  const double nu = material.poissons_ratio;
  const double scale = material.youngs_modulus_Pa / ((1 + nu) * (1 - 2 * nu));
  Matrix6 C = Matrix6::Zero();
  C.topLeftCorner<3, 3>().setConstant(nu);
  for (int k = 0; k < 3; ++k) {
    C(k, k) = 1 - nu;
    C(3 + k, 3 + k) = 0.5 - nu;
  }
  return scale * C;
}

/// The strain of a displacement field u(x) = shape(x) u, from the shape's gradient.
Strain strainOf(const Vec3& g) {
  Strain B = Strain::Zero();
  B(0, 0) = B(3, 1) = B(5, 2) = g.x();
  B(1, 1) = B(3, 0) = B(4, 2) = g.y();
  B(2, 2) = B(4, 1) = B(5, 0) = g.z();
  return B;
}

/// Gradient of a corner's trilinear shape at xi in [-1, 1]^3.
Vec3 cornerGradient(int corner, const Vec3& xi, const Vec3& size_m) {
  Vec3 sign, g;
  for (int k = 0; k < 3; ++k) sign[k] = (corner >> k & 1) != 0 ? 1 : -1;
  for (int k = 0; k < 3; ++k) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    g[k] = 0.125 * sign[k] * (1 + sign[a] * xi[a]) * (1 + sign[b] * xi[b]) * 2 / size_m[k];
  }
  return g;
}

}  // namespace

BrickMatrix brickStiffness(const Vec3& size_m, const Elasticity& material) {
  const Matrix6 C = elasticityMatrix(material);
  const double weight_m3 = size_m.prod() / 8;  // of each of 2 x 2 x 2 Gauss points
  BrickMatrix K = BrickMatrix::Zero();
  Eigen::Matrix<double, 24, 9> K_ua = Eigen::Matrix<double, 24, 9>::Zero();
  Eigen::Matrix<double, 9, 9> K_aa = Eigen::Matrix<double, 9, 9>::Zero();
  for (int point = 0; point < 8; ++point) {
    Vec3 xi;
    for (int k = 0; k < 3; ++k) xi[k] = ((point >> k & 1) != 0 ? 1 : -1) / std::sqrt(3.0);
    Eigen::Matrix<double, 6, 24> B;
    for (int i = 0; i < 8; ++i) B.middleCols<3>(3 * i) = strainOf(cornerGradient(i, xi, size_m));
    Eigen::Matrix<double, 6, 9> G;  // of 1 - xi_k^2
    for (int k = 0; k < 3; ++k)
      G.middleCols<3>(3 * k) = strainOf(Vec3(Vec3::Unit(k) * (-2 * xi[k] * 2 / size_m[k])));
    K += weight_m3 * B.transpose() * C * B;
    K_ua += weight_m3 * B.transpose() * C * G;
    K_aa += weight_m3 * G.transpose() * C * G;
  }
  K -= K_ua * K_aa.inverse() * K_ua.transpose();
  return 0.5 * (K + K.transpose());
}

}  // namespace vps::viewer::inline v0
