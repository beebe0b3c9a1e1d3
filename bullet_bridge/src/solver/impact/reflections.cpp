// SPDX-License-Identifier: BSD-3-Clause
#include "solver/impact/reflections.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vps/contact_tolerances.h"

namespace vps::bullet {
namespace {

/// Iterations over the rows of one impact.
class Impact {
 public:
  Impact(std::span<const ImpactRow> rows, const std::vector<Vec6>& before) : rows_(rows), projection_(rows) {
    for (const ImpactRow& row : rows)
      if (isContact(row)) fastest_m_s_ = std::max(fastest_m_s_, -row.velocity(before));
  }

  /// Computes v(t) of reflections.h. The remaining work budget is shared with the `others` values of t that
  /// follow.
  [[nodiscard]] ImpactState at(double t, const std::vector<Vec6>& before, std::size_t others) {
    if (projection_.work() >= kMostImpactWork) return inelastic(before);
    ImpactState state{before, std::vector<double>(rows_.size(), 0)};
    const std::size_t end = projection_.work() + (kMostImpactWork - projection_.work()) / (others + 1);
    projection_.limitWork(end);
    bool has_ended = false;
    while (!has_ended && projection_.work() < end) {
      if (chooseInelastic(t)) project(1, state);
      has_ended = !addApproaching(t, state.v);
      if (!has_ended) project(2, state);
    }
    if (!has_ended) state = together(t, before);
    stop(state);
    return state;
  }

 private:
  // The limit of massless bodies between others, which a sequence of impacts approaches: all contacts are
  // reflected at once, and a massless body transmits the impact of its neighbours like a spacer.
  ImpactState together(double t, const std::vector<Vec6>& before) {
    projection_.limitWork(std::numeric_limits<std::size_t>::max());
    ImpactState state{before, std::vector<double>(rows_.size(), 0)};
    for (int k = 0; k < kMostIterations; ++k) {
      if (chooseInelastic(t)) project(1, state);
      if (!addApproaching(t, state.v)) break;
      chosen_.assign(rows_.size(), 1);
      project(2, state);
    }
    return state;
  }
  // The inelastic solution, computed once.
  const ImpactState& inelastic(const std::vector<Vec6>& before) {
    if (inelastic_.v.empty()) {
      inelastic_ = {before, std::vector<double>(rows_.size(), 0)};
      stop(inelastic_);
    }
    return inelastic_;
  }
  // One projection onto all rows, without a work limit.
  void stop(ImpactState& state) {
    projection_.limitWork(std::numeric_limits<std::size_t>::max());
    chosen_.assign(rows_.size(), 1);
    project(1, state);
  }
  static bool isContact(const ImpactRow& row) { return row.lower_Ns == 0 && row.upper_Ns > 0; }

  bool chooseInelastic(double t) {
    chosen_.assign(rows_.size(), 0);
    for (std::size_t i = 0; i < rows_.size(); ++i) chosen_[i] = !(rows_[i].restitution > t);
    return std::find(chosen_.begin(), chosen_.end(), 1) != chosen_.end();
  }
  bool addApproaching(double t, const std::vector<Vec6>& v) {
    bool is_any = false;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (!(rows_[i].restitution > t) || !(rows_[i].velocity(v) < -kSlowApproachShare * fastest_m_s_))
        continue;
      chosen_[i] = is_any = true;
    }
    return is_any;
  }
  // Changes v by `times` the change of a projection onto the chosen rows, or by less if this would add
  // energy, since the projection is not exact. With t times its impulses the energy grows by t a + t^2 (b -
  // a) / 2, where a and b are the impulses' work at the velocities before and after them.
  void project(double times, ImpactState& state) {
    before_ = state.v;
    projection_.solve(chosen_, kRoundingShare * fastest_m_s_, state.v, lambda_);
    double a = 0, b = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (lambda_[i] != 0) {
        a += lambda_[i] * rows_[i].velocity(before_);
        b += lambda_[i] * rows_[i].velocity(state.v);
      }
    const double t = b > a ? std::clamp(-2 * a / (b - a), 0.0, times) : 0;
    for (std::size_t i = 0; i < state.v.size(); ++i) state.v[i] = before_[i] + t * (state.v[i] - before_[i]);
    for (std::size_t i = 0; i < rows_.size(); ++i) state.p_Ns[i] += t * lambda_[i];
  }
  std::span<const ImpactRow> rows_;
  ImpactProjection projection_;
  ImpactState inelastic_;
  double fastest_m_s_ = 0;
  std::vector<std::uint8_t> chosen_;
  std::vector<double> lambda_;
  std::vector<Vec6> before_;
};

void addShare(double share, const ImpactState& part, ImpactState& sum) {
  for (std::size_t i = 0; i < sum.v.size(); ++i) sum.v[i] += share * part.v[i];
  for (std::size_t i = 0; i < sum.p_Ns.size(); ++i) sum.p_Ns[i] += share * part.p_Ns[i];
}

}  // namespace

// v(t) is constant between two values of e, so the mean is a sum over these intervals.
ImpactState afterImpact(std::span<const ImpactRow> rows, const std::vector<Vec6>& before) {
  std::vector<double> ends{1};
  for (const ImpactRow& row : rows) ends.push_back(std::clamp(row.restitution, 0.0, 1.0));
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  Impact impact(rows, before);
  ImpactState mean{std::vector<Vec6>(before.size(), Vec6::Zero()), std::vector<double>(rows.size(), 0)};
  double from = 0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const double to = ends[i];
    if (to > from) addShare(to - from, impact.at(from, before, ends.size() - i - 1), mean);
    from = to;
  }
  return mean;
}

}  // namespace vps::bullet
