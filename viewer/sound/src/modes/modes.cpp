// SPDX-License-Identifier: BSD-3-Clause
#include "modes/modes.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "modes/brick_grid.h"
#include "vps_device/random.h"

namespace vps::viewer {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

constexpr int kRigidModes = 6;
constexpr double kLeast_hz = 20;  // modes with lower frequencies are rigid-body motions

struct Eigenpairs {
  VectorXd values;
  MatrixXd vectors;  ///< V^T M V = 1
};

/// A growing basis of vectors that are orthonormal with respect to M.
class Basis {
 public:
  Basis(const Sparse& M, Eigen::Index most) : M_(M), V_(M.rows(), most), MV_(M.rows(), most) {}

  /// Adds the components of the columns that are independent of the basis. Returns the number of added
  /// vectors.
  Eigen::Index add(const MatrixXd& columns) {
    constexpr double kDependent = 1e-8;  // a smaller remaining share of a column is rounding error
    const Eigen::Index before = size_;
    for (Eigen::Index j = 0; j < columns.cols() && size_ < V_.cols(); ++j) {
      VectorXd x = columns.col(j);
      const double norm = std::sqrt(std::max(0.0, x.dot(M_ * x)));
      for (int twice = 0; twice < 2; ++twice) x -= V_.leftCols(size_) * (MV_.leftCols(size_).transpose() * x);
      const double left = std::sqrt(std::max(0.0, x.dot(M_ * x)));
      if (!(left > kDependent * norm)) continue;
      V_.col(size_) = x / left;
      MV_.col(size_) = M_ * V_.col(size_);
      ++size_;
    }
    return size_ - before;
  }
  [[nodiscard]] Eigen::Index size() const { return size_; }
  [[nodiscard]] auto vectors() const { return V_.leftCols(size_); }
  [[nodiscard]] auto weighted() const { return MV_.leftCols(size_); }

 private:
  const Sparse& M_;
  MatrixXd V_, MV_;
  Eigen::Index size_ = 0;
};

MatrixXd startingVectors(Eigen::Index rows, Eigen::Index columns) {
  device::Random random(1);
  MatrixXd X(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j)
    for (Eigen::Index i = 0; i < rows; ++i) X(i, j) = 2 * random.uniform() - 1;
  return X;
}

/// Whether the wanted eigenvalues (all up to `most`, or `wanted` of them) have converged since the last
/// iteration.
bool areSettled(const VectorXd& values, const VectorXd& before, double most, double shift,
                Eigen::Index wanted) {
  constexpr double kSettled = 1e-7;  // relative change of w^2
  for (Eigen::Index i = 0; i < wanted; ++i) {
    if (i >= before.size()) return false;
    if (std::abs(values[i] - before[i]) > kSettled * (std::abs(values[i]) + shift)) return false;
    if (values[i] > most) return true;
  }
  return true;
}

/// The lowest eigenvalues w^2 of K x = w^2 M x with their vectors, sorted: all up to `most`, or `wanted` of
/// them, and some further ones that have not converged. The method is block Lanczos with inversion, and with
/// a positive shift, since K of a free body is singular. The block has eight vectors, since symmetric bodies
/// have several modes of one frequency, and a free body has six of frequency zero. Source: Golub and Van
/// Loan, "Matrix Computations", 2013, section 10.3.6.
Eigenpairs lowest(const Sparse& K, const Sparse& M, double most, Eigen::Index wanted) {
  constexpr double kShift_hz = 300;
  constexpr Eigen::Index kBlock = 8;
  const double shift = std::pow(2 * std::numbers::pi * kShift_hz, 2);
  const Sparse shifted = K + shift * M;
  const Eigen::SimplicialLDLT<Sparse> solver(shifted);
  if (solver.info() != Eigen::Success) return {};
  const Eigen::Index greatest = std::min(K.rows(), 6 * (wanted + kBlock));
  Basis basis(M, greatest);
  MatrixXd inverse(greatest, greatest);  // inverse of the shifted K, projected on the basis
  MatrixXd block = startingVectors(K.rows(), kBlock);
  VectorXd values;
  MatrixXd small_vectors;
  while (const Eigen::Index added = basis.add(block)) {
    const Eigen::Index size = basis.size();
    block = solver.solve(MatrixXd(basis.weighted().rightCols(added)));
    inverse.block(0, size - added, size, added) = basis.weighted().transpose() * block;
    inverse.block(size - added, 0, added, size) =
        inverse.block(0, size - added, size, added).transpose().eval();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> small(inverse.topLeftCorner(size, size));
    if (small.info() != Eigen::Success) return {};
    const VectorXd before =
        std::exchange(values, (small.eigenvalues().reverse().cwiseInverse().array() - shift).matrix());
    small_vectors = small.eigenvectors().rowwise().reverse();
    if (areSettled(values, before, most, shift, wanted)) break;
  }
  return {values, basis.vectors() * small_vectors};
}

struct SurfacePoint {
  Vec3 p_P, n_P;
};

/// Points on the surface, each for the same share of the area.
std::vector<SurfacePoint> surfacePoints(const Mesh& mesh) {
  constexpr double kPoints = 2000;
  const double each_m2 = std::max(area(mesh) / kPoints, 1e-300);
  device::Random random(2);
  std::vector<SurfacePoint> points;
  double due_m2 = 0.5 * each_m2;  // area until the next point
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 &a = mesh.vertices[i], ab = mesh.vertices[j] - a, ac = mesh.vertices[k] - a;
    const Vec3 twice_m2 = ab.cross(ac);
    const double size_m2 = 0.5 * twice_m2.norm();
    for (due_m2 -= size_m2; due_m2 < 0; due_m2 += each_m2) {
      double u = random.uniform(), v = random.uniform();
      if (u + v > 1) std::tie(u, v) = std::pair(1 - u, 1 - v);
      points.push_back({a + u * ab + v * ac, twice_m2.normalized()});
    }
  }
  return points;
}

}  // namespace

std::vector<Vec3> BodyModes::shapesAt(const Vec3& p_P) const {
  std::vector<Vec3> shapes(frequency_hz.size(), Vec3::Zero());
  const PointShapes at = viewer::shapesAt(grid, p_P);
  if (at.brick == nullptr) return shapes;
  for (std::size_t mode = 0; mode < shapes.size(); ++mode)
    for (int i = 0; i < kBrickNodes; ++i)
      shapes[mode] +=
          at.shapes[i] *
          nodes.col(static_cast<Eigen::Index>(mode)).segment<3>(3 * at.brick->nodes[i]).cast<double>();
  return shapes;
}

BodyModes findModes(const Mesh& mesh_P, const std::function<bool(const Vec3& p_P)>& isInside,
                    double density_kg_m3, const Elasticity& material, const ModeSettings& settings) {
  BodyModes body;
  body.grid = makeBrickGrid(bounds(mesh_P), isInside, settings.most_bricks);
  if (body.grid.bricks.empty()) return body;
  const VibrationMatrices matrices = matricesOf(body.grid, density_kg_m3, material);
  for (Brick& brick : body.grid.bricks) brick.cut.reset();
  body.mass_kg = matrices.mass_kg;
  body.surface_m2 = area(mesh_P);
  const Eigenpairs pairs =
      lowest(matrices.stiffness, matrices.mass, std::pow(2 * std::numbers::pi * settings.most_hz, 2),
             static_cast<Eigen::Index>(settings.most_modes) + kRigidModes);
  std::vector<Eigen::Index> heard;
  for (Eigen::Index i = 0; i < pairs.values.size() && heard.size() < settings.most_modes; ++i) {
    const double hz = std::sqrt(std::max(0.0, pairs.values[i])) / (2 * std::numbers::pi);
    if (hz < kLeast_hz) continue;
    if (hz > settings.most_hz) break;
    body.frequency_hz.push_back(hz);
    heard.push_back(i);
  }
  body.nodes.resize(matrices.mass.rows(), static_cast<Eigen::Index>(heard.size()));
  for (std::size_t i = 0; i < heard.size(); ++i)
    body.nodes.col(static_cast<Eigen::Index>(i)) = pairs.vectors.col(heard[i]).cast<float>();
  body.normal_rms.assign(heard.size(), 0);
  const std::vector<SurfacePoint> surface = surfacePoints(mesh_P);
  for (const SurfacePoint& point : surface) {
    const std::vector<Vec3> shapes = body.shapesAt(point.p_P);
    for (std::size_t i = 0; i < shapes.size(); ++i)
      body.normal_rms[i] += std::pow(shapes[i].dot(point.n_P), 2) / static_cast<double>(surface.size());
  }
  for (double& rms : body.normal_rms) rms = std::sqrt(rms);
  return body;
}

}  // namespace vps::viewer
