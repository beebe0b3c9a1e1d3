// SPDX-License-Identifier: BSD-3-Clause
#include "solver/rigid/even_pressure.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>

#include "solver/island/newton_math.h"
#include "vps/contact_tolerances.h"
#include "vps/friction.h"

namespace vps::bullet {

namespace {

constexpr std::size_t kSingleWay =
    3;  // up to this number of contacts, a face's load is shared in a unique way

bool isOfPair(const RigidContact& c, const RigidContact& of) {
  return std::equal(c.object, c.object + 2, of.object);
}

bool touches(const RigidContact& c) {
  return c.p_n > 0 || std::abs(c.gap_m) < kRounding_m;
}

/// Finds impulses p_k = a_k w_k . f that have a given wrench and the least sum of p_k^2 / a_k.
class LeastSquares {
 public:
  void add(double weight, const Vec6& row) { gram_ += weight * row * row.transpose(); }
  /// Returns the factors f. Components that the rows cannot carry are left out.
  [[nodiscard]] Vec6 solve(const Vec6& wanted) const {
    const double least = kSettledShare * gram_.trace();
    if (!(least > 0)) return Vec6::Zero();
    const Eigen::LDLT<Mat6> solver(gram_ + least * Mat6::Identity());
    const Vec6 factors = solver.solve(wanted);
    return factors +
           solver.solve(wanted - gram_ * factors);  // one refinement removes the effect of the regularisation
  }

 private:
  Mat6 gram_ = Mat6::Zero();
};

}  // namespace

void EvenPressure::spread(std::span<RigidContact> contacts) {
  runs_.clear();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (i == 0 || !isOfPair(contacts[i], contacts[i - 1])) runs_.push_back({i, i});
    runs_.back().end = i + 1;
  }
  // A pair's manifolds need not be consecutive. The order of pairs does not matter.
  std::stable_sort(runs_.begin(), runs_.end(), [&](const Run& a, const Run& b) {
    return std::lexicographical_compare(contacts[a.first].object, contacts[a.first].object + 2,
                                        contacts[b.first].object, contacts[b.first].object + 2,
                                        std::less<>());
  });
  for (std::size_t k = 0; k < runs_.size();) {
    const RigidContact& of = contacts[runs_[k].first];
    group_.clear();
    for (; k < runs_.size() && isOfPair(contacts[runs_[k].first], of); ++k)
      for (std::size_t i = runs_[k].first; i < runs_[k].end; ++i)
        if (touches(contacts[i])) group_.push_back(i);
    if (group_.size() > kSingleWay) spreadPair(contacts);
  }
}

void EvenPressure::spreadPair(std::span<RigidContact> contacts) {
  const Vec3 center = contacts[group_.front()].position_W();
  double length_m = 0, total_Ns = 0;
  for (const std::size_t i : group_) {
    length_m = std::max(length_m, (contacts[i].position_W() - center).norm());
    total_Ns += contacts[i].p_n;
  }
  if (!(total_Ns > 0) || !(length_m > 0)) return;
  Vec6 wanted = Vec6::Zero();
  rows_.clear();
  for (const std::size_t i : group_) {
    rows_.push_back(wrenchOf((contacts[i].position_W() - center) / length_m, contacts[i].normal_W()));
    wanted += contacts[i].p_n * rows_.back();
  }
  impulses_Ns_.assign(group_.size(), 1);  // a contact with a positive impulse takes part
  for (int round = 0; round < kMostRounds; ++round) {
    LeastSquares spread;
    for (std::size_t k = 0; k < group_.size(); ++k)
      if (impulses_Ns_[k] > 0) spread.add(contacts[group_[k]].area_m2, rows_[k]);
    const Vec6 factors = spread.solve(wanted);
    bool do_press = true;
    Vec6 found = Vec6::Zero();
    for (std::size_t k = 0; k < group_.size(); ++k) {
      if (!(impulses_Ns_[k] > 0)) continue;
      const double p_n = contacts[group_[k]].area_m2 * rows_[k].dot(factors);
      do_press = do_press && p_n >= 0;
      impulses_Ns_[k] = p_n > 0 ? p_n : 0;
      found += p_n * rows_[k];
    }
    if (!((found - wanted).norm() <= kUnspreadShare * total_Ns)) return;
    if (!do_press) continue;
    double change_Ns = 0;
    for (std::size_t k = 0; k < group_.size(); ++k)
      change_Ns += std::abs(impulses_Ns_[k] - contacts[group_[k]].p_n);
    if (change_Ns <= kEvenShare * total_Ns || !spreadFriction(contacts, center, length_m)) return;
    for (std::size_t k = 0; k < group_.size(); ++k) contacts[group_[k]].p_n = impulses_Ns_[k];
    return;
  }
}

// Sliding contacts get friction along their slip; sticking ones share it in proportion to their limits.
// Returns false if the friction would exceed the limits.
bool EvenPressure::spreadFriction(std::span<RigidContact> contacts, const Vec3& center, double length_m) {
  const auto slipOf = [&](const ContactRow& row) {
    return row.velocity([&](std::size_t i) -> const Vec6& { return island_.bodies[i].u; });
  };
  bool slides = false;
  Vec6 wanted = Vec6::Zero();
  for (const std::size_t i : group_) {
    const RigidContact& c = contacts[i];
    const double had = tangentLength(c.p_t[0], c.p_t[1]);
    if (!(had > 0)) continue;
    slides = slides || (had >= (1 - kSettledShare) * c.mu * c.p_n &&
                        tangentLength(slipOf(c.tangent[0]), slipOf(c.tangent[1])) > kSliding_m_s);
    wanted +=
        wrenchOf((c.position_W() - center) / length_m, c.p_t[0] * c.tangent_W(0) + c.p_t[1] * c.tangent_W(1));
  }
  LeastSquares spread;
  const auto rowOf = [&](const RigidContact& c, int t) {
    return wrenchOf((c.position_W() - center) / length_m, c.tangent_W(t));
  };
  if (!slides)
    for (std::size_t k = 0; k < group_.size(); ++k)
      for (const int t : {0, 1}) spread.add(impulses_Ns_[k], rowOf(contacts[group_[k]], t));
  const Vec6 factors = slides ? Vec6(Vec6::Zero()) : spread.solve(wanted);
  friction_Ns_.clear();
  Vec6 found = Vec6::Zero();
  double total_Ns = 0;
  for (std::size_t k = 0; k < group_.size(); ++k) {
    const RigidContact& c = contacts[group_[k]];
    const double limit = c.mu * impulses_Ns_[k];
    std::array<double, 2>& p_t = friction_Ns_.emplace_back();
    if (slides) {
      const double slip[2] = {slipOf(c.tangent[0]), slipOf(c.tangent[1])};
      const double speed = tangentLength(slip[0], slip[1]);
      for (const std::size_t t : {0U, 1U}) p_t[t] = speed > kSliding_m_s ? -limit / speed * slip[t] : 0;
    } else {
      for (const std::size_t t : {0U, 1U})
        p_t[t] = impulses_Ns_[k] * rowOf(c, static_cast<int>(t)).dot(factors);
      limitToCone(p_t[0], p_t[1], limit);
    }
    for (const std::size_t t : {0U, 1U}) found += p_t[t] * rowOf(c, static_cast<int>(t));
    total_Ns += impulses_Ns_[k];
  }
  if (!slides && (found - wanted).norm() > kUnspreadShare * total_Ns) return false;
  for (std::size_t k = 0; k < group_.size(); ++k)
    std::copy(friction_Ns_[k].begin(), friction_Ns_[k].end(), contacts[group_[k]].p_t);
  return true;
}

}  // namespace vps::bullet
