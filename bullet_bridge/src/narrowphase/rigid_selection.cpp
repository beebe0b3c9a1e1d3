// SPDX-License-Identifier: BSD-3-Clause
// Constraint mode: few points, each a constraint of the solver.
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include "narrowphase/contact_selection.h"

namespace vps::bullet {

namespace {

// A part that has not moved since its points were chosen keeps them, and their planes go with it: at rest
// that is all the work there is. Planes that were found anew each step would turn within a hair where an edge
// lies on an edge, and let the part fall for a step: then a heap never sleeps. False: choose anew.
bool recallSelection(const PairView& pair, PairState& state) {
  if (!isWhereItWas(state.selection, pair, state.motion)) return false;
  // Points that could not be reached as the motion was had more than the slack to go.
  if (motionChange_m(state.selection, pair, state.motion) > state.motion.contact_margin_m) return false;
  const Carry carry = carryOf(state.selection, pair);
  state.contacts = state.selection.chosen;
  for (Candidate& c : state.contacts) carry(c);
  dropUnreachable(state.motion, state.contacts);
  return true;
}

void prepareRestitution(std::vector<Candidate>& candidates, const RelativeMotion& motion,
                        const btCollisionObject* object0, const btCollisionObject* object1) {
  // The solver takes the gap off the rebound's speed, which kills a bounce that would happen within the step.
  // So a point that bounces does so at once: early by less than a step's travel, with the right energy.
  if (!(btManifoldResult::calculateCombinedRestitution(object0, object1) > 0)) return;
  for (Candidate& c : candidates)
    if (c.distance_m > 0 && c.predicted_m < 0 && c.predicted_m < c.distance_m - 0.2 * motion.dt_s)
      c.distance_m = 0;
}

}  // namespace

void chooseRigid(const PairView& pair, PairState& state) {
  Context& context = *state.context;
  if (!recallSelection(pair, state)) {
    collectForStep(pair, state.motion, state, state.contacts);
    ++context.pair_updates;
    context.candidates += state.contacts.size();
    choose(pair, state.motion, context.settings, state.writer.get(), state.contacts);
    keepSelection(state.contacts, pair, state.motion, state.selection);
  }
  prepareRestitution(state.contacts, state.motion, pair.wrapper[0]->getCollisionObject(),
                     pair.wrapper[1]->getCollisionObject());
}

}  // namespace vps::bullet
