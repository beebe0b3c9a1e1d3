// SPDX-License-Identifier: BSD-3-Clause
// Penalty mode: every point that can touch is a spring of the solver's.
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include "narrowphase/contact_selection.h"

namespace vps::bullet {

namespace {

// A point on an edge has no normal of its own, and the field is worst near the other side's edges: 14 um at
// the root of an M10 thread with voxels of 0.2 mm, and normals that follow the grid. A nut that stood on such
// points lost 21 % of its acceleration.
void correctSprings(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
                    std::vector<Candidate>& candidates) {
  // Of a body that was looked at along its way, the places are elsewhere.
  if (!settings.use_surfaces ||
      motion.contact_margin_m + motion.speed_m_s * motion.dt_s > query_range_m(pair))
    return;
  Pose way[2];
  coast(pair, motion.dt_s, way);
  for (int i = 0; i < 2; ++i)
    if (pair.hasShell(i))
      correctEdges(candidates, pair.side(i), pair.side(1 - i), *pair.wrapper[1 - i]->getCollisionShape(), way,
                   motion);
  dropUnreachable(motion, candidates);
}

// All that can touch, and the few of them that stand in the manifolds, to be seen and for solvers that know
// nothing of springs.
void chooseSprings(const PairView& pair, PairState& state) {
  Context& context = *state.context;
  const RelativeMotion& motion = state.motion;
  Selection& selection = state.selection;
  std::vector<Candidate>& candidates = state.contacts;
  collectForStep(pair, motion, state, candidates);
  ++context.pair_updates;
  context.candidates += candidates.size();
  dropUnreachable(motion, candidates);
  correctSprings(pair, motion, context.settings, candidates);
  selection.springs = candidates;
  Settings seen = context.settings;
  seen.use_surfaces = false;
  choose(pair, motion, seen, state.writer.get(), candidates);
  keepSelection(candidates, pair, motion, selection);
}

// What recallSelection() does for thousands of points: within kStill_m their planes are as good as a look.
// The points that could be left out as the motion was are those that can be left out now.
bool recallSprings(const PairView& pair, PairState& state, Carry& carry) {
  const Selection& selection = state.selection;
  const RelativeMotion& motion = state.motion;
  if (!(motionChange_m(selection, pair, motion) <= kStill_m) || !isWhereItWas(selection, pair, motion))
    return false;
  carry = carryOf(selection, pair);
  state.contacts = selection.chosen;
  for (Candidate& c : state.contacts) carry(c);
  return true;
}

}  // namespace

void choosePenalty(const PairView& pair, PairState& state) {
  const Context& context = *state.context;
  Carry carry;
  if (!recallSprings(pair, state, carry)) chooseSprings(pair, state);
  for (int i = 0; i < 2; ++i) state.penalty.object[i] = pair.wrapper[i]->getCollisionObject();
  state.penalty.mu =
      btManifoldResult::calculateCombinedFriction(state.penalty.object[0], state.penalty.object[1]);
  const double stiffness = context.settings.stiffness_N_per_m3 / sideCount(pair, context.settings.sides);
  renewPoints(state.penalty, state.selection.springs, stiffness, state.motion, carry);
}

}  // namespace vps::bullet
