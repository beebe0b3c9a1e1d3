// SPDX-License-Identifier: BSD-3-Clause
// Natural frequencies of thin shells of revolution, for tests.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace vps::test {

/// A point of the meridian of the middle surface.
struct Meridian {
  double radius_m = 0;     ///< distance from the axis
  double slope = 0;        ///< d radius / d s
  double along_per_m = 0;  ///< curvature along the meridian
  double around_per_m = 0;
};

struct ThinShell {
  std::function<Meridian(double s_m)> meridian;
  double length_m = 0;  ///< length of the meridian, from s = 0
  /// Whether s = 0 is on the axis; if so, `along_per_m` must be constant.
  bool has_pole = false;
  double thick_m = 0, youngs_modulus_Pa = 210e9, poissons_ratio = 0.3, density_kg_m3 = 7850;
};

/// Natural frequencies with n >= 2 waves around the axis and free edges, sorted. Ritz's method: displacements
/// u along the meridian and w normal to the surface are proportional to cos(n phi), v around the axis to
/// sin(n phi); along s they are polynomials, times a power of the radius at a pole. Shear and rotary inertia
/// are neglected, so the frequencies are too high if the wall is thick compared to the waves. Source of
/// strains and changes of curvature: Sanders, NASA TR R-24, 1959; Leissa, "Vibration of Shells", NASA SP-288,
/// 1973, section 1.3.
inline std::vector<double> shellFrequencies(const ThinShell& shell, int n) {
  using Eigen::MatrixXd, Eigen::VectorXd;
  constexpr int kTerms = 15, kSteps = 800;  // 11 and 19 terms give the same to 0.1 %
  const double nu = shell.poissons_ratio, h = shell.thick_m;
  const double B = shell.youngs_modulus_Pa * h / (1 - nu * nu), D = B * h * h / 12;
  // Elasticity of membrane strains, then of curvatures: along, around, twist.
  MatrixXd elastic = MatrixXd::Zero(6, 6);
  for (const int i : {0, 3}) {
    elastic.block(i, i, 2, 2) << 1, nu, nu, 1;
    elastic(i + 2, i + 2) = (1 - nu) / 2;
    elastic.block(i, i, 3, 3) *= i == 0 ? B : D;
  }
  MatrixXd K = MatrixXd::Zero(3 * kTerms, 3 * kTerms), M = K;
  for (int step = 0; step < kSteps; ++step) {
    const double s = (step + 0.5) / kSteps * shell.length_m, x = 2 * s / shell.length_m - 1;
    const Meridian at = shell.meridian(s);
    // Chebyshev polynomials and their derivatives with respect to s.
    VectorXd T = VectorXd::Zero(kTerms), dT = T, ddT = T;
    T[0] = 1;
    T[1] = x;
    dT[1] = 1;
    for (int i = 2; i < kTerms; ++i) {
      T[i] = 2 * x * T[i - 1] - T[i - 2];
      dT[i] = 2 * T[i - 1] + 2 * x * dT[i - 1] - dT[i - 2];
      ddT[i] = 4 * dT[i - 1] + 2 * x * ddT[i - 1] - ddT[i - 2];
    }
    dT *= 2 / shell.length_m;
    ddT *= 4 / (shell.length_m * shell.length_m);
    const auto timesRadius = [&](int power) {
      if (!shell.has_pole) return std::array<Eigen::RowVectorXd, 3>{T, dT, ddT};
      const double r = at.radius_m, dr = at.slope, ddr = -r * at.along_per_m * at.along_per_m;
      const double f = std::pow(r, power), df = power * std::pow(r, power - 1) * dr;
      const double ddf =
          power * (power - 1) * std::pow(r, power - 2) * dr * dr + power * std::pow(r, power - 1) * ddr;
      return std::array<Eigen::RowVectorXd, 3>{f * T, df * T + f * dT, ddf * T + 2 * df * dT + f * ddT};
    };
    const auto [u, du, ddu] = timesRadius(n - 1);
    const auto [w, dw, ddw] = timesRadius(n);
    const double c = at.slope / at.radius_m, m = n / at.radius_m, k1 = at.along_per_m, k2 = at.around_per_m;
    // Rows are the six strains, columns are u, v, w. The normal turns by k1 u - dw along the meridian and by
    // k2 v + m w around the axis.
    MatrixXd strain = MatrixXd::Zero(6, 3 * kTerms);
    strain.row(0) << du, 0 * u, k1 * w;
    strain.row(1) << c * u, m * u, k2 * w;
    strain.row(2) << -m * u, du - c * u, 0 * w;
    strain.row(3) << k1 * du, 0 * u, -ddw;
    strain.row(4) << c * k1 * u, m * k2 * u, m * m * w - c * dw;
    strain.row(5) << -m * k1 * u + (k2 - k1) / 2 * m * u, k2 * (du - c * u) + (k2 - k1) / 2 * (du + c * u),
        2 * m * (dw - c * w);
    MatrixXd moved = MatrixXd::Zero(3, 3 * kTerms);
    moved.block(0, 0, 1, kTerms) = u;
    moved.block(1, kTerms, 1, kTerms) = u;
    moved.block(2, 2 * kTerms, 1, kTerms) = w;
    const double area_m2 = shell.length_m / kSteps * at.radius_m;
    K += area_m2 * strain.transpose() * elastic * strain;
    M += area_m2 * shell.density_kg_m3 * h * moved.transpose() * moved;
  }
  const VectorXd scale = M.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solved(
      scale.asDiagonal() * K * scale.asDiagonal(), scale.asDiagonal() * M * scale.asDiagonal());
  std::vector<double> hz;
  for (const double w2 : solved.eigenvalues())
    hz.push_back(std::sqrt(std::max(0.0, w2)) / (2 * std::numbers::pi));
  return hz;
}

}  // namespace vps::test
