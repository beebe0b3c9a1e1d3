// SPDX-License-Identifier: BSD-3-Clause
// From all points of a pair that are near the other side to those that the solver is given: few, of rigid
// bodies (choose_rigid.cpp), or all that press, of springs (choose_springs.cpp).
#pragma once

#include <vector>

#include "narrowphase/pair_state.h"
#include "narrowphase/pair_view.h"

namespace vps::bullet {

// What both need.

/// Adds all points nearer to the other side than the cutoff, both ways if the settings say so. With a pair's
/// memory at least those: what the last steps' distances exclude is not read.
void collect(const PairView& pair, double cutoff_m, Context& context, std::vector<Candidate>& out,
             PairState* state = nullptr);

/// Adds the candidates of the step. A body that moves less than the fields can see is looked at once, where
/// it is. A faster one is looked at along its way, so that it cannot pass through; the plane it first meets
/// then holds for the whole step.
void collectForStep(const PairView& pair, const RelativeMotion& motion, PairState& state,
                    std::vector<Candidate>& out);

/// The candidates' planes from the exact surfaces, where the settings want them.
void correctAll(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
                std::vector<Candidate>& candidates);

void dropUnreachable(const RelativeMotion& motion, std::vector<Candidate>& candidates);

/// From thousands of near points to the few that hold the part.
/// @param writer  knows last step's contacts; may be null
void choose(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
            ManifoldWriter* writer, std::vector<Candidate>& candidates);

void keepSelection(const std::vector<Candidate>& chosen, const PairView& pair, const RelativeMotion& motion,
                   Selection& selection);

/// assumed: a part that moved less [m] would have no better points than those chosen before
constexpr double kStill_m = 1e-6;
/// True if the selection's points are still the ones to look at.
bool isWhereItWas(const Selection& selection, const PairView& pair, const RelativeMotion& motion);

/// How much farther than foreseen then any point of the smaller body may go in the step [m].
double motionChange_m(const Selection& selection, const PairView& pair, const RelativeMotion& motion);

/// What takes a selection's planes to where the bodies are now. Within kStill_m that is as good as a look.
Carry carryOf(const Selection& selection, const PairView& pair);

// The two modes: state.contacts of the coming step, with springs state.penalty as well.

void chooseRigid(const PairView& pair, PairState& state);
void choosePenalty(const PairView& pair, PairState& state);

}  // namespace vps::bullet
