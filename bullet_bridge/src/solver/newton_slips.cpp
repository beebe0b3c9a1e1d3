// SPDX-License-Identifier: BSD-3-Clause
// From one round of ContactNewton to the next: the terms of slip, and what a round misses.
#include <algorithm>
#include <cmath>

#include "solver/contact_newton.h"
#include "vps/contact_tolerances.h"

namespace vps::bullet::inline v0 {

// The slip at the velocities at the start.
void ContactNewton::startSlips() {
  for (const Patch& patch : patches_) {
    const Vec6 twist = twistOf(patch, u_);
    for (std::size_t i = patch.first; i < patch.end; ++i) points_[i].slip = slipOf(points_[i], twist);
  }
}

// True where the impulses only wait for the terms of slip, which settle.
bool ContactNewton::Miss::isOfSlip(const Miss& last) const {
  return slip_m_s < kSlipReduction * last.slip_m_s && law_m_s < kAccuracyShare * slip_m_s;
}

// Takes the round's impulses. The slip of each contact at its end is left in `slips_`.
ContactNewton::Miss ContactNewton::endRound() {
  Miss miss;
  slips_.resize(static_cast<Eigen::Index>(points_.size()));
  for (const Patch& patch : patches_) {
    const Vec6 twist = twistOf(patch, u_);
    for (std::size_t i = patch.first; i < patch.end; ++i) {
      Point& p = points_[i];
      miss.law_m_s = std::max(miss.law_m_s, p.softness * (p.next - p.impulse).norm());
      const double slip = slipOf(p, twist);
      if (!p.next.isZero(0)) miss.slip_m_s = std::max(miss.slip_m_s, std::abs(slip - p.slip));
      slips_[static_cast<Eigen::Index>(i)] = slip;
      p.impulse = p.next;
    }
  }
  for (const Joint& joint : joint_states_) joint.row->impulse_Ns = joint.next_Ns;
  return miss;
}

// The next round's terms of slip. Those with which a round ended would approach the solution by a constant
// factor only, up to 0.8.
void ContactNewton::updateSlips() {
  Eigen::VectorXd from(slips_.size());
  for (Eigen::Index i = 0; i < from.size(); ++i) from[i] = points_[static_cast<std::size_t>(i)].slip;
  const Eigen::VectorXd next = extrapolation_.next(from, slips_);
  for (Eigen::Index i = 0; i < next.size(); ++i)
    points_[static_cast<std::size_t>(i)].slip = std::max(0.0, next[i]);
}

}  // namespace vps::bullet::inline v0
