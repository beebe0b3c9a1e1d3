// SPDX-License-Identifier: BSD-3-Clause
// Where a part's face touches the round side of a primitive, between the points of its shell.
#pragma once

#include "narrowphase/contact_candidate.h"

namespace vps::bullet {

/// How much farther from a primitive's round side than the contact itself the nearest of a face's points can
/// be: s^2 / (2 r) for points s apart on a ball of radius r, at most s. 0 for primitives without a round
/// side.
double roundReach_m(const btCollisionShape& primitive, double spacing_m);

/// Moves a candidate of `side` on a face from its point to where that face touches the primitive, if that is
/// nearer: the primitive's farthest point against the face's normal, near where the candidate is, and its
/// foot on the part's exact surface. That point is of the primitive's solid, so what it finds is never nearer
/// than the truth. Exact for a flat face. False, and nothing changed, for points on edges, parts without
/// exact surfaces, flat sides of primitives, and where nothing is gained.
bool touchRound(Candidate& c, const SideView& side, const SideView& other, const btCollisionShape& primitive);

}  // namespace vps::bullet
