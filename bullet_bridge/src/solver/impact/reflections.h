// SPDX-License-Identifier: BSD-3-Clause
// Velocities after a simultaneous impact, with restitution.
//
// Bodies with masses M and velocities v meet at contacts with normal velocities J v. An impact must end
// without approach, J v >= 0, by impulses lambda >= 0, must not make energy, and should treat equal contacts
// equally. Separate velocity targets per contact (v_n = -e v_n before) fail where contacts share bodies: each
// target is right for its own pair, but together they add energy. Instead:
//
// 1. Project: v0 = the velocities without approach that are nearest to v in the norm of M, an inelastic
//    impact. The set {J v >= 0} is a cone, so <v0 - v, v0> = 0: the lost energy is that of v0 - v.
// 2. Reflect: v + 2 (v0 - v), an elastic impact. By the same equation the result has the energy of v exactly.
//
// Elastic impacts follow each other, as along Newton's cradle: only the contacts that approach are reflected,
// together, until none approaches [Smith, Kaufman, Vouga, Tamstorf and Grinspun 2012, "Reflections on
// simultaneous impact"]. Of three bodies in a row, the middle one is hit by the first, moves, and hits the
// third.
//
// Contacts with a restitution e between 0 and 1, and contacts of different e. Let v(t) be the velocities if
// the contacts with e > t are elastic and the others inelastic. The result is the mean of v(t) over t from 0
// to 1. If all contacts have the same e, the mean is (1 - e) v(1) + e v(0). Each v(t) has no approach and at
// most the energy of v. The mean of v(t) has these two properties too, because both sets of velocities are
// convex.
//
// Inelastic contacts beside elastic ones: first v is projected onto the inelastic ones, then reflected at the
// elastic ones that approach, where the inelastic ones react with twice the impulse of a projection. (A body
// that rests on a table and is hit from the side bounces sideways and stays on the table.) Projection and
// reflection both keep the statements above. Rows of joints are two-sided inelastic rows.
//
// Energy is measured relative to bodies that contact does not move. Every impulse acts on both bodies along
// one line, so momentum is conserved to rounding, whether or not an iteration has converged.
#pragma once

#include <span>
#include <vector>

#include "solver/impact/impact_projection.h"

namespace vps::bullet {

/// The bodies' velocities, and the impulse of each row that led to them.
struct ImpactState {
  std::vector<Vec6> v;
  std::vector<double> p_Ns;
};

/// The velocities after an impact of bodies at `before`, and the rows' impulses.
/// @param rows  prepared rows; their body indices refer to `before`
/// @return velocities without approach. Approaches slower than 1e-2 of the fastest one in `before` are
///   stopped without restitution. A chain of impacts that does not end within a work budget (a body with less
///   than some 1e-9 of its neighbours' mass) is replaced by the limit for massless bodies, which also keeps
///   the energy: all contacts are reflected at once. Cost: about 1 us for each impact of two bodies, at most
///   some 0.1 s for all values of restitution together; a row of n bodies has some n impacts.
ImpactState afterImpact(std::span<const ImpactRow> rows, const std::vector<Vec6>& before);

}  // namespace vps::bullet
