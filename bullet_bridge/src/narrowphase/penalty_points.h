// SPDX-License-Identifier: BSD-3-Clause
// Makes a pair's penalty points from its candidates.
#pragma once

#include <span>

#include "narrowphase/contact_candidate.h"
#include "solver/penalty_pair.h"

namespace vps::bullet::inline v0 {

/// Updates a pair's points from candidates (ascending by key), carried from where they were found to where
/// the bodies are now; points that stay keep bend, force and tolerated overlap.
/// @param stiffness_N_per_m3  per area; half of it where both sides' points are queried
void updatePenaltyPoints(PenaltyPair& pair, std::span<const Candidate> candidates, double stiffness_N_per_m3,
                         const RelativeMotion& motion, const CandidateMotion& moved);

}  // namespace vps::bullet::inline v0
