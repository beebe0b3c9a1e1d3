// SPDX-License-Identifier: BSD-3-Clause
// Makes a pair's penalty points from its candidates.
#pragma once

#include <span>

#include "narrowphase/pair_material.h"
#include "solver/penalty_pair.h"

namespace vps::bullet {

/// Updates a pair's points from candidates (ascending by key), carried from where they were found to where
/// the bodies are now; points that stay keep bend, force and tolerated overlap.
/// @param usual_N_per_m3  stiffness per area of surfaces that have none of their own
/// @param sides  how many sides' points are queried: they share the stiffness, since their areas overlap
void updatePenaltyPoints(PenaltyPair& pair, std::span<const Candidate> candidates,
                         const PairMaterial& material, double usual_N_per_m3, int sides,
                         const RelativeMotion& motion, const CandidateMotion& moved);

}  // namespace vps::bullet
