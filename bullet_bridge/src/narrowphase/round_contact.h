// SPDX-License-Identifier: BSD-3-Clause
// Where a part's face touches the round side of a primitive, between the points of its shell.
#pragma once

#include "narrowphase/contact_candidate.h"

namespace vps::bullet {

/// How much farther than the contact itself the nearest shell point of a face can be from a primitive's round
/// side: s^2 / (2 r) for points s apart on a ball of radius r, at most s. 0 for primitives without a round
/// side.
double roundReach_m(const btCollisionShape& primitive, double spacing_m);

/// Moves a candidate of `side` on a face from its shell point to where that face touches the primitive, if
/// that is nearer: the primitive's farthest point against the face's normal, near the candidate, and its foot
/// on the part's exact surface. That point belongs to the primitive's solid, so the distance found is never
/// less than the true one. Exact for a flat face. Returns false, and changes nothing, for points on edges,
/// parts without exact surfaces, flat sides of primitives, and where the distance would not decrease.
bool refineOnRound(Candidate& c, const SideView& side, const SideView& other,
                   const btCollisionShape& primitive);

}  // namespace vps::bullet
