// SPDX-License-Identifier: BSD-3-Clause
// Penalty contact: every point that can touch presses.
#include "narrowphase/contact_selection.h"
#include "narrowphase/penalty_points.h"
#include "vps/contact_tolerances.h"

namespace vps::bullet {

namespace {

// A point on an edge has no normal of its own, and the field has its greatest errors near the other side's
// edges: 14 um at the root of an M10 thread with voxels of 0.2 mm, with normals that follow the grid. A nut
// supported by such points lost 21 % of its acceleration.
void refinePenaltyPoints(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
                         std::vector<Candidate>& candidates) {
  // Candidates of a fast body were found elsewhere along its path.
  if (!settings.use_surfaces || motion.contact_margin_m + motion.speed_m_s * motion.dt_s > queryRange_m(pair))
    return;
  Pose way[2];
  coast(pair, motion.dt_s, way);
  for (int i = 0; i < 2; ++i)
    if (pair.hasShell(i))
      refineEdges(candidates, pair.side(i), pair.side(1 - i), *pair.wrapper[1 - i]->getCollisionShape(), way,
                  motion);
  dropUnreachable(motion, candidates);
}

// Selects all points that can touch, and the few of them that are written to the manifolds, for users and for
// solvers without penalty contact.
void selectPenaltyPoints(const PairView& pair, PairState& state) {
  Context& context = *state.context;
  const RelativeMotion& motion = state.motion;
  Selection& selection = state.selection;
  std::vector<Candidate>& candidates = state.contacts;
  findStepCandidates(pair, motion, state, candidates);
  ++context.pair_updates;
  context.candidates += candidates.size();
  dropUnreachable(motion, candidates);
  refinePenaltyPoints(pair, motion, context.settings, candidates);
  selection.penalty_points = candidates;
  Settings seen = context.settings;
  seen.use_surfaces = false;
  selectContacts(pair, motion, seen, state.writer.get(), candidates);
  storeSelection(candidates, pair, motion, selection);
}

// As reuseSelection() for rigid contact, but for thousands of points: the motion must be unchanged too, so
// that the points that were out of reach still are.
bool reusePenaltyPoints(const PairView& pair, PairState& state, CandidateMotion& moved) {
  const Selection& selection = state.selection;
  const RelativeMotion& motion = state.motion;
  if (!(motionChange_m(selection, pair, motion) <= kSamePlace_m) || !hasNotMoved(selection, pair, motion))
    return false;
  moved = motionSince(selection, pair);
  state.contacts = selection.contacts;
  for (Candidate& c : state.contacts) moved(c);
  return true;
}

}  // namespace

void selectPenalty(const PairView& pair, PairState& state) {
  const Context& context = *state.context;
  CandidateMotion moved;
  if (!reusePenaltyPoints(pair, state, moved)) selectPenaltyPoints(pair, state);
  for (int i = 0; i < 2; ++i) state.penalty.object[i] = pair.wrapper[i]->getCollisionObject();
  updatePenaltyPoints(state.penalty, state.selection.penalty_points, PairMaterial(pair.wrapper),
                      context.settings.stiffness_N_per_m3, sideCount(pair, context.settings.sides),
                      state.motion, moved);
}

}  // namespace vps::bullet
