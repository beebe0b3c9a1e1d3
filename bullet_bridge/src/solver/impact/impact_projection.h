// SPDX-License-Identifier: BSD-3-Clause
// Rows of an impact, and the projection of velocities onto the states that violate no row.
#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "solver/island/island.h"

namespace vps::bullet {

/// Normal direction of a contact, or a degree of freedom that a joint removes, in an impact.
struct ImpactRow {
  int body[2] = {-1, -1};  ///< index of the body; -1 for a body that contact does not move
  Vec6 J[2] = {Vec6::Zero(), Vec6::Zero()};
  Vec6 MinvJ[2] = {Vec6::Zero(), Vec6::Zero()};
  double fixed_velocity = 0;  ///< velocity along the row of bodies that contact does not move
  double W = 0;               ///< J M^-1 J'
  double lower_Ns = 0, upper_Ns = std::numeric_limits<double>::infinity();  ///< each 0 or infinite
  double restitution = 0;  ///< 0 to 1; only for rows that push

  /// Sets MinvJ and W.
  void prepare(std::span<const Mat6> inverse_mass);
  [[nodiscard]] double velocity(std::span<const Vec6> v) const;
  void apply(double impulse_Ns, std::span<Vec6> v) const;
  [[nodiscard]] bool isTwoSided() const { return lower_Ns < 0 && upper_Ns > 0; }
};

/// Finds the velocities nearest to v, in the norm of the masses, that violate no row: J v >= 0 for one that
/// pushes, J v <= 0 for one that pulls, J v = 0 for one with two sides (J v with the fixed velocity).
///
/// Uses the dual active set method: violated rows join the active set one by one, and rows that would have to
/// pull leave it. The method ends after a finite number of rows with the exact solution. On flush faces with
/// dozens of redundant contacts Gauss-Seidel sweeps would need thousands of iterations, and a reflection
/// doubles the rotation that they leave. Source: Goldfarb and Idnani 1983.
///
/// A light body between heavy ones bounces between them thousands of times. So the last few active sets are
/// tried first, each for the same chosen rows: if all impulses push and no other row is violated, the set is
/// the solution.
class ImpactProjection {
 public:
  explicit ImpactProjection(std::span<const ImpactRow> rows) : rows_(rows) {}

  /// @param chosen  for each row, whether it takes part
  /// @param tolerance_m_s  smaller violations are ignored
  /// @param v  velocities before the impulses; on return, velocities after the impulses
  /// @param p_Ns  impulse of each row, within its limits; 0 if not chosen
  /// Cost per row that joins: one product for each row, and k^2 operations for k active rows.
  void solve(std::span<const std::uint8_t> chosen, double tolerance_m_s, std::vector<Vec6>& v,
             std::vector<double>& p_Ns);
  /// Cost of all solutions so far, in products.
  [[nodiscard]] std::size_t work() const { return work_; }
  /// Sets the work() at which solutions end early, with violations left.
  void limitWork(std::size_t most) { most_work_ = most; }

 private:
  struct Active {
    std::size_t row;
    double sign;  // the row acts as sign * J
    double p_Ns;  // impulse along sign * J
  };
  /// The active rows of an earlier solution.
  struct Known {
    std::vector<std::uint8_t> chosen;
    std::vector<Active> active;
    Eigen::MatrixXd factor;
  };
  bool solveAsBefore(const Known& known, double tolerance_m_s, std::vector<Vec6>& v);
  void remember(std::span<const std::uint8_t> chosen);
  [[nodiscard]] double product(std::size_t i, std::size_t j) const;
  [[nodiscard]] int mostViolated(std::span<const std::uint8_t> chosen, double tolerance_m_s,
                                 const std::vector<Vec6>& v) const;
  bool join(std::size_t row, std::vector<Vec6>& v);
  void move(const Active& joining, const Eigen::VectorXd& r, double t, std::vector<Vec6>& v);
  void append(const Eigen::VectorXd& g, double W);
  void leave(std::size_t k);

  std::span<const ImpactRow> rows_;
  std::vector<Active> active_;
  std::vector<std::uint8_t> is_active_, is_skipped_;
  std::vector<Known> known_;
  std::size_t oldest_ = 0;  // of known_
  Eigen::MatrixXd factor_;  // Cholesky factor of the active rows' products, in the lower triangle
  std::size_t work_ = 0, most_work_ = std::numeric_limits<std::size_t>::max();
};

}  // namespace vps::bullet
