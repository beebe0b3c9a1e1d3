// SPDX-License-Identifier: BSD-3-Clause
#include "solver/impact/impact_projection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vps/contact_tolerances.h"

namespace vps::bullet {

void ImpactRow::prepare(std::span<const Mat6> inverse_mass) {
  W = 0;
  for (int i = 0; i < 2; ++i) {
    if (body[i] < 0) continue;
    MinvJ[i] = inverse_mass[static_cast<std::size_t>(body[i])] * J[i];
    W += J[i].dot(MinvJ[i]);
  }
}

double ImpactRow::velocity(std::span<const Vec6> v) const {
  double sum = fixed_velocity;
  for (int i = 0; i < 2; ++i)
    if (body[i] >= 0) sum += J[i].dot(v[static_cast<std::size_t>(body[i])]);
  return sum;
}

void ImpactRow::apply(double impulse_Ns, std::span<Vec6> v) const {
  for (int i = 0; i < 2; ++i)
    if (body[i] >= 0) v[static_cast<std::size_t>(body[i])] += impulse_Ns * MinvJ[i];
}

// J M^-1 J' of rows i and j.
double ImpactProjection::product(std::size_t i, std::size_t j) const {
  const ImpactRow &a = rows_[i], &b = rows_[j];
  double sum = 0;
  for (int s = 0; s < 2; ++s)
    for (int t = 0; t < 2; ++t)
      if (a.body[s] >= 0 && a.body[s] == b.body[t]) sum += a.J[s].dot(b.MinvJ[t]);
  return sum;
}

// Finds the most violated row; -1 if there is none. Violations are scaled to a body of one kilogram, so that
// rotations and translations compare.
int ImpactProjection::mostViolated(std::span<const std::uint8_t> chosen, double tolerance_m_s,
                                   const std::vector<Vec6>& v) const {
  int most = -1;
  double worst = 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const ImpactRow& row = rows_[i];
    if (!chosen[i] || is_active_[i] || is_skipped_[i] || !(row.W > 0)) continue;
    const double velocity_m_s = row.velocity(v);
    const double violation_m_s = row.isTwoSided()   ? std::abs(velocity_m_s)
                                 : row.lower_Ns < 0 ? velocity_m_s
                                                    : -velocity_m_s;
    if (!(violation_m_s > tolerance_m_s)) continue;
    const double here = violation_m_s / std::sqrt(row.W);
    if (here <= worst) continue;
    worst = here;
    most = static_cast<int>(i);
  }
  return most;
}

// Raises the impulse of the joining row by t while the active rows keep their velocities.
void ImpactProjection::move(const Active& joining, const Eigen::VectorXd& r, double t, std::vector<Vec6>& v) {
  rows_[joining.row].apply(joining.sign * t, v);
  for (std::size_t k = 0; k < active_.size(); ++k) {
    const double change_Ns = -t * r[static_cast<Eigen::Index>(k)];
    active_[k].p_Ns += change_Ns;
    rows_[active_[k].row].apply(active_[k].sign * change_Ns, v);
  }
}

void ImpactProjection::append(const Eigen::VectorXd& y, double rest) {
  const Eigen::Index k = y.size();
  if (k >= factor_.rows()) factor_.conservativeResize(2 * k + 8, 2 * k + 8);
  factor_.row(k).head(k) = y.transpose();
  factor_(k, k) = std::sqrt(rest);
}

void ImpactProjection::leave(std::size_t k) {
  is_active_[active_[k].row] = 0;
  active_.erase(active_.begin() + static_cast<std::ptrdiff_t>(k));
  // Rows before k keep their factor; rows after k are appended again.
  const std::vector<Active> after(active_.begin() + static_cast<std::ptrdiff_t>(k), active_.end());
  active_.resize(k);
  for (const Active& a : after) {
    const auto n = static_cast<Eigen::Index>(active_.size());
    Eigen::VectorXd y(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Active& other = active_[static_cast<std::size_t>(i)];
      y[i] = a.sign * other.sign * product(a.row, other.row);
    }
    factor_.topLeftCorner(n, n).triangularView<Eigen::Lower>().solveInPlace(y);
    append(y, std::max(rows_[a.row].W - y.squaredNorm(),
                       std::numeric_limits<double>::epsilon() * rows_[a.row].W));
    active_.push_back(a);
    work_ += static_cast<std::size_t>(n * n);
  }
}

// Returns false if the row depends linearly on the active rows, none of which can leave.
bool ImpactProjection::join(std::size_t row, std::vector<Vec6>& v) {
  const double velocity_m_s = rows_[row].velocity(v);
  Active joining{row, velocity_m_s < 0 ? 1.0 : -1.0, 0};
  for (;;) {
    const auto n = static_cast<Eigen::Index>(active_.size());
    Eigen::VectorXd y(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Active& other = active_[static_cast<std::size_t>(i)];
      y[i] = joining.sign * other.sign * product(row, other.row);
    }
    const auto factor = factor_.topLeftCorner(n, n).triangularView<Eigen::Lower>();
    factor.solveInPlace(y);
    Eigen::VectorXd r = y;
    factor.transpose().solveInPlace(r);
    work_ += static_cast<std::size_t>(n * n) + rows_.size();
    const double rest = rows_[row].W - y.squaredNorm();
    const bool is_dependent = !(rest > kSumRounding * rows_[row].W);
    const double full = is_dependent ? std::numeric_limits<double>::infinity()
                                     : -joining.sign * rows_[row].velocity(v) / rest;
    double t = std::max(full, 0.0);
    std::size_t blocking = active_.size();
    for (std::size_t k = 0; k < active_.size(); ++k) {
      const double slope = r[static_cast<Eigen::Index>(k)];
      if (rows_[active_[k].row].isTwoSided() || !(slope > 0) || !(active_[k].p_Ns < t * slope)) continue;
      t = active_[k].p_Ns / slope;
      blocking = k;
    }
    if (!std::isfinite(t)) {
      if (joining.p_Ns > 0) move(joining, Eigen::VectorXd::Zero(n), -joining.p_Ns, v);
      return false;
    }
    move(joining, r, t, v);
    joining.p_Ns += t;
    if (blocking == active_.size()) {
      append(y, rest);
      active_.push_back(joining);
      is_active_[row] = 1;
      return true;
    }
    active_[blocking].p_Ns = 0;
    leave(blocking);
  }
}

// Returns true if the known active set is the solution; v then holds its velocities. Otherwise v is
// unchanged.
bool ImpactProjection::solveAsBefore(const Known& known, double tolerance_m_s, std::vector<Vec6>& v) {
  const auto n = static_cast<Eigen::Index>(known.active.size());
  Eigen::VectorXd p(n);
  const auto velocityOf = [&](const Active& a) { return a.sign * rows_[a.row].velocity(v); };
  for (Eigen::Index k = 0; k < n; ++k) p[k] = -velocityOf(known.active[static_cast<std::size_t>(k)]);
  const auto factor = known.factor.triangularView<Eigen::Lower>();
  factor.solveInPlace(p);
  factor.transpose().solveInPlace(p);
  work_ += static_cast<std::size_t>(n * n) + rows_.size();
  for (Eigen::Index k = 0; k < n; ++k)
    if (!(p[k] >= 0) && !rows_[known.active[static_cast<std::size_t>(k)].row].isTwoSided()) return false;
  const std::vector<Vec6> before = v;
  active_ = known.active;
  for (std::size_t k = 0; k < active_.size(); ++k) {
    active_[k].p_Ns = p[static_cast<Eigen::Index>(k)];
    rows_[active_[k].row].apply(active_[k].sign * active_[k].p_Ns, v);
  }
  // Active rows are tested too, since nearly dependent rows may keep a velocity.
  if (std::all_of(active_.begin(), active_.end(),
                  [&](const Active& a) { return std::abs(velocityOf(a)) <= tolerance_m_s; }) &&
      mostViolated(known.chosen, tolerance_m_s, v) < 0)
    return true;
  active_.clear();
  v = before;
  return false;
}

void ImpactProjection::remember(std::span<const std::uint8_t> chosen) {
  // Assumed. A body that bounces between two others alternates between two active sets.
  constexpr std::size_t kMost = 4;
  const auto n = static_cast<Eigen::Index>(active_.size());
  Known now{{chosen.begin(), chosen.end()}, active_, factor_.topLeftCorner(n, n)};
  for (Known& known : known_)
    if (known.chosen == now.chosen) return std::swap(known, now);
  if (known_.size() < kMost) return known_.push_back(std::move(now));
  known_[oldest_] = std::move(now);
  oldest_ = (oldest_ + 1) % kMost;
}

void ImpactProjection::solve(std::span<const std::uint8_t> chosen, double tolerance_m_s, std::vector<Vec6>& v,
                             std::vector<double>& p_Ns) {
  active_.clear();
  is_active_.assign(rows_.size(), 0);
  is_skipped_.assign(rows_.size(), 0);
  p_Ns.assign(rows_.size(), 0);
  const auto known = std::find_if(known_.begin(), known_.end(), [&](const Known& k) {
    return std::equal(chosen.begin(), chosen.end(), k.chosen.begin(), k.chosen.end());
  });
  if (known != known_.end() && solveAsBefore(*known, tolerance_m_s, v)) {
    for (const Active& a : active_) p_Ns[a.row] = a.sign * a.p_Ns;
    return;
  }
  // Far more steps than needed; rounding may let rows join and leave repeatedly.
  const std::size_t most = 20 + 4 * rows_.size();
  for (std::size_t step = 0; step < most && work_ < most_work_; ++step) {
    work_ += rows_.size();
    const int row = mostViolated(chosen, tolerance_m_s, v);
    if (row < 0) break;
    if (!join(static_cast<std::size_t>(row), v)) is_skipped_[static_cast<std::size_t>(row)] = 1;
  }
  for (const Active& a : active_) p_Ns[a.row] = a.sign * a.p_Ns;
  remember(chosen);
}

}  // namespace vps::bullet
