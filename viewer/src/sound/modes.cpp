// SPDX-License-Identifier: BSD-3-Clause
#include "sound/modes.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <numbers>

#include "sound/brick_grid.h"
#include "vps_device/random.h"

namespace vps::viewer::inline v0 {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kRigidModes = 6;
constexpr double kLeast_hz = 20;  // below are the motions of a rigid body

/// The lowest eigenvalues w^2 of K x = w^2 M x with their vectors, in rising order; M is diagonal.
/// Source: Bathe, "Finite Element Procedures", 1996, section 11.6 (subspace iteration), shifted by a positive
/// amount, since K of a free body is singular.
struct Eigenpairs {
  VectorXd values;
  MatrixXd vectors;  ///< V^T M V = 1
};

MatrixXd startingVectors(Eigen::Index rows, Eigen::Index columns) {
  device::Random random(1);
  MatrixXd X(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j)
    for (Eigen::Index i = 0; i < rows; ++i) X(i, j) = 2 * random.uniform() - 1;
  return X;
}

/// Settled up to `most` and beyond the last wanted one, as far as the columns reach.
Eigenpairs lowest(const Eigen::SparseMatrix<double>& K, const VectorXd& M, double shift, double most,
                  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>& solver, Eigen::Index columns) {
  constexpr int kRounds = 16;
  constexpr double kSettled = 1e-6;  // relative change of w^2
  Eigenpairs found;
  MatrixXd X = startingVectors(K.rows(), columns);
  for (int round = 0; round < kRounds; ++round) {
    const MatrixXd Y = solver.solve(MatrixXd(M.asDiagonal() * X));
    const MatrixXd K_small = Y.transpose() * (K * Y), M_small = Y.transpose() * M.asDiagonal() * Y;
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> small(K_small, M_small);
    if (small.info() != Eigen::Success) return {};
    X = Y * small.eigenvectors();
    const VectorXd before = found.values;
    found.values = small.eigenvalues();
    if (before.size() == 0) continue;
    bool is_settled = true;
    for (Eigen::Index i = 0; i < columns - columns / 4 && is_settled; ++i)
      is_settled = found.values[i] > 1.1 * most ||
                   std::abs(found.values[i] - before[i]) <= kSettled * (std::abs(found.values[i]) + shift);
    if (is_settled) break;
  }
  found.vectors = X;
  return found;
}

/// All up to `most`, or `wanted` of them. Few columns come first, since most parts have few modes that one
/// hears.
Eigenpairs lowest(const Eigen::SparseMatrix<double>& K, const VectorXd& M, double most, Eigen::Index wanted) {
  constexpr double kShift_hz = 300;
  const double shift = std::pow(2 * std::numbers::pi * kShift_hz, 2);
  Eigen::SparseMatrix<double> shifted = K;
  shifted += Eigen::SparseMatrix<double>((shift * M).asDiagonal());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(shifted);
  if (solver.info() != Eigen::Success) return {};
  const Eigen::Index enough = std::min(K.rows(), wanted + wanted / 3 + 8);
  for (Eigen::Index columns = std::min<Eigen::Index>(16, enough);; columns = std::min(2 * columns, enough)) {
    Eigenpairs found = lowest(K, M, shift, most, solver, columns);
    if (found.values.size() == 0 || columns == enough || found.values[columns - columns / 4 - 1] > most)
      return found;
  }
}

/// Of the displacement along the normal, over the surface.
double normalRms(const VectorXd& mode, const BrickGrid& grid) {
  double sum = 0, area_m2 = 0;
  for (std::size_t c = 0; c < grid.corners_P.size(); ++c) {
    const Vec3& a = grid.normal_area_m2[c];
    const double size_m2 = a.norm();
    if (size_m2 == 0) continue;
    const double along = mode.segment<3>(static_cast<Eigen::Index>(3 * c)).dot(a) / size_m2;
    sum += size_m2 * along * along;
    area_m2 += size_m2;
  }
  return area_m2 > 0 ? std::sqrt(sum / area_m2) : 0;
}

}  // namespace

std::size_t BodyModes::nearestCorner(const Vec3& p_P) const {
  std::size_t best = 0;
  for (std::size_t c = 1; c < corners_P.size(); ++c)
    if ((corners_P[c] - p_P).squaredNorm() < (corners_P[best] - p_P).squaredNorm()) best = c;
  return best;
}

BodyModes findModes(const Box& box_P, const std::function<bool(const Vec3& p_P)>& isInside,
                    double density_kg_m3, const Elasticity& material, const ModeSettings& settings) {
  BodyModes body;
  const BrickGrid grid = makeBrickGrid(box_P, isInside, density_kg_m3, settings);
  if (grid.bricks.empty()) return body;
  VectorXd M(static_cast<Eigen::Index>(3 * grid.corners_P.size()));
  for (std::size_t c = 0; c < grid.corners_P.size(); ++c) {
    M.segment<3>(static_cast<Eigen::Index>(3 * c)).setConstant(grid.mass_kg[c]);
    body.mass_kg += grid.mass_kg[c];
    body.surface_m2 += grid.normal_area_m2[c].lpNorm<1>();
  }
  const Eigenpairs pairs =
      lowest(stiffnessOf(grid, material), M, std::pow(2 * std::numbers::pi * settings.most_hz, 2),
             static_cast<Eigen::Index>(settings.most_modes) + kRigidModes);
  std::vector<std::size_t> surface;
  for (std::size_t c = 0; c < grid.corners_P.size(); ++c)
    if (grid.normal_area_m2[c].norm() > 0) {
      surface.push_back(c);
      body.corners_P.push_back(grid.corners_P[c]);
    }
  for (Eigen::Index i = 0; i < pairs.values.size() && body.frequency_hz.size() < settings.most_modes; ++i) {
    const double hz = std::sqrt(std::max(0.0, pairs.values[i])) / (2 * std::numbers::pi);
    if (hz < kLeast_hz) continue;
    if (hz > settings.most_hz) break;
    const VectorXd mode = pairs.vectors.col(i);
    body.frequency_hz.push_back(hz);
    body.normal_rms.push_back(normalRms(mode, grid));
    for (const std::size_t c : surface)
      body.shapes.emplace_back(mode.segment<3>(static_cast<Eigen::Index>(3 * c)).cast<float>());
  }
  return body;
}

}  // namespace vps::viewer::inline v0
