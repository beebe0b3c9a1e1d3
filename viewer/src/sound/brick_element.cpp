// SPDX-License-Identifier: BSD-3-Clause
#include "sound/brick_element.h"

#include <Eigen/Cholesky>
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

/// A brick's stiffness as it is summed over points.
class BrickIntegral {
 public:
  BrickIntegral(const Vec3& size_m, const Elasticity& material)
      : size_m_(size_m), C_(elasticityMatrix(material)) {}

  void add(const Vec3& xi, double weight_m3) {
    Corners B;
    for (int i = 0; i < 8; ++i) B.middleCols<3>(3 * i) = strainOf(cornerGradient(i, xi, size_m_));
    Inner G;  // of 1 - xi_k^2
    for (int k = 0; k < 3; ++k)
      G.middleCols<3>(3 * k) = strainOf(Vec3(Vec3::Unit(k) * (-2 * xi[k] * 2 / size_m_[k])));
    const Corners CB = weight_m3 * C_ * B;
    const Inner CG = weight_m3 * C_ * G;
    K_uu_ += B.transpose() * CB;
    K_ua_ += B.transpose() * CG;
    K_aa_ += G.transpose() * CG;
    B_sum_ += weight_m3 * B;
    G_sum_ += weight_m3 * G;
    volume_m3_ += weight_m3;
  }
  /// The inner displacements take the values of least energy. Their mean strain is taken from them, so that
  /// they do no work on a constant stress, which makes constant strain exact in every shape (the patch test):
  /// Simo and Rifai, Int. J. Numer. Methods Eng. 29, 1990. In a whole brick it is 0.
  [[nodiscard]] BrickMatrix result() const {
    const Corners B_mean = B_sum_ / volume_m3_;
    const Inner G_mean = G_sum_ / volume_m3_;
    const Eigen::Matrix<double, 24, 9> K_ua = K_ua_ - volume_m3_ * B_mean.transpose() * C_ * G_mean;
    Matrix9 K_aa = K_aa_ - volume_m3_ * G_mean.transpose() * C_ * G_mean;
    K_aa.diagonal().array() +=
        kLeastInner * K_aa_.trace();  // in a filling that is flat some are without energy
    const BrickMatrix K = K_uu_ - K_ua * K_aa.ldlt().solve(K_ua.transpose());
    return 0.5 * (K + K.transpose());
  }

 private:
  using Corners = Eigen::Matrix<double, 6, 24>;
  using Inner = Eigen::Matrix<double, 6, 9>;
  using Matrix9 = Eigen::Matrix<double, 9, 9>;
  static constexpr double kLeastInner = 1e-9;

  Vec3 size_m_;
  Matrix6 C_;
  BrickMatrix K_uu_ = BrickMatrix::Zero();
  Eigen::Matrix<double, 24, 9> K_ua_ = Eigen::Matrix<double, 24, 9>::Zero();
  Matrix9 K_aa_ = Matrix9::Zero();
  Corners B_sum_ = Corners::Zero();
  Inner G_sum_ = Inner::Zero();
  double volume_m3_ = 0;
};

}  // namespace

BrickMatrix brickStiffness(const Vec3& size_m, const Elasticity& material) {
  BrickIntegral integral(size_m, material);
  for (int point = 0; point < 8; ++point) {  // 2 x 2 x 2 Gauss points
    Vec3 xi;
    for (int k = 0; k < 3; ++k) xi[k] = ((point >> k & 1) != 0 ? 1 : -1) / std::sqrt(3.0);
    integral.add(xi, size_m.prod() / 8);
  }
  return integral.result();
}

BrickMatrix brickStiffness(const Vec3& size_m, const Elasticity& material, const BrickFilling& filling) {
  BrickIntegral integral(size_m, material);
  for (const Vec3& xi : filling.at) integral.add(xi, filling.share_volume * size_m.prod());
  return integral.result();
}

std::array<double, 8> cornerShares(const BrickFilling& filling) {
  std::array<double, 8> shares{};
  for (const Vec3& xi : filling.at)
    for (int i = 0; i < 8; ++i) {
      double shape = 0.125;
      for (int k = 0; k < 3; ++k) shape *= 1 + ((i >> k & 1) != 0 ? xi[k] : -xi[k]);
      shares[i] += shape * filling.share_volume;
    }
  return shares;
}

}  // namespace vps::viewer::inline v0
