// SPDX-License-Identifier: BSD-3-Clause
// How much of a bounce a group may take, so that it gains no energy.
#include <algorithm>
#include <cmath>

#include "solver/restitution.h"
#include "vps/contact_tolerances.h"

namespace vps::bullet {

// The greatest share s of the change of velocities for which a s^2 + b s + c, the energy above what is
// allowed, is not positive, or else least.
double Restitution::shareWithoutGain(std::span<const BodyEnd> ends) const {
  const Group& g = group_;
  double a = 0, b = 0, c = 0, scale_J = 0;
  for (std::size_t i = 0; i < g.bodies.size(); ++i) {
    const auto at = static_cast<std::size_t>(g.bodies[i]);
    const IslandBody& body = island_.bodies[at];
    const Vec6 change = g.v[i] - g.solved[i], momentum = ends[at].mass * change;
    // The velocities of the poses, half a kick from those that Bullet stores: their energy is what a step
    // keeps.
    const Vec6 start = body.start + 0.5 * body.mass.llt().solve(body.external_Ns),
               solved = g.solved[i] + 0.5 * g.kick[i];
    const double before_J = 0.5 * start.dot(body.mass * start);
    a += 0.5 * momentum.dot(change);
    b += momentum.dot(solved);
    c += 0.5 * solved.dot(ends[at].mass * solved) - before_J - g.impulse[i].dot(body.u);
    scale_J += before_J;
  }
  // Contacts work against bodies that they do not move only; their other work is not allowed.
  const auto twistOf = [&](std::size_t i) -> const Vec6& { return island_.bodies[i].u; };
  for (std::size_t k = 0; k < g.rows.size(); ++k)
    b += g.rows[k].fixed_velocity * (g.p_Ns[k] - g.solved_Ns[k]);
  for (const Contact& contact : g.contacts) {
    const RigidContact& of = *contact.of;
    c += of.p_n * of.normal.velocity(twistOf);
    for (int t = 0; t < 2; ++t) {
      c += of.p_t[t] * of.tangent[t].velocity(twistOf);
      b += of.tangent[t].fixed_velocity * (contact.p_t[t] - of.p_t[t]);
    }
  }
  if (a + b + c <= kSumRounding * scale_J) return 1;
  if (!(a > 0)) return 0;  // also where a value is not finite
  // A solution that has not converged may have more energy than is allowed by itself: then the share with the
  // least.
  const double root = std::max(b * b - 4 * a * c, 0.0);
  return std::clamp((-b + std::sqrt(root)) / (2 * a), 0.0, 1.0);
}

}  // namespace vps::bullet
