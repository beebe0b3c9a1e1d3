// SPDX-License-Identifier: BSD-3-Clause
// Constraint contact: selects a few points, each of which becomes a constraint of the solver.
#include <algorithm>
#include <utility>

#include "narrowphase/check/feature_check.h"
#include "narrowphase/check/pair_check.h"
#include "narrowphase/pair/pair_view.h"
#include "narrowphase/selection/contact_selection.h"

namespace vps::bullet {

namespace {

// Reuses the contacts of a part that has not moved since they were selected; their planes move with the part.
// If planes were searched again in each step, they would turn with rounding where an edge lies on an edge and
// let the part fall for a step, so that a heap would never sleep. Returns false if the contacts must be
// selected again.
bool reuseSelection(const PairView& pair, PairState& state) {
  if (std::exchange(state.is_incomplete, false)) return false;
  if (!hasNotMoved(state.selection, pair, state.motion)) return false;
  // Points that were out of reach had a greater gap than the contact margin.
  if (motionChange_m(state.selection, pair, state.motion) > state.motion.contact_margin_m) return false;
  const CandidateMotion moved = motionSince(state.selection, pair);
  state.contacts = state.selection.contacts;
  for (Candidate& c : state.contacts) moved(c);
  dropUnreachable(state.motion, state.contacts);
  return true;
}

// Greatest size of an area from which a query reported only the most urgent point.
double mergedTo_m(const PairState& state) {
  double most_m = 0;
  for (const auto& query : state.query_state)
    if (query && query->leading) most_m = std::max(most_m, query->leading->mergedTo_m());
  return most_m;
}

void markBounces(std::vector<Candidate>& candidates, const RelativeMotion& motion,
                 const PairMaterial& material) {
  for (Candidate& c : candidates)
    c.bounces = meetsWithBounce(material.restitution(c), c.distance_m, c.predicted_m, motion.dt_s);
}

// True for bodies that spin freely about an axis with room around it. The check of the solved step finds
// contacts that arise because other bodies push the pair.
bool needsNoContacts(const PairView& pair, PairState& state) {
  if (!state.motion.is_checked) return false;
  PairView end = pair;
  advance(end, pair, state.motion.dt_s, state.motion.dt_s);
  return spinsFreely(pair, end.X_WS, state);
}

}  // namespace

bool meetsWithBounce(double restitution, double gap_m, double predicted_m, double dt_s) {
  constexpr double kThreshold_m_s = 0.2;  // btContactSolverInfo::m_restitutionVelocityThreshold
  return restitution > 0 && gap_m > 0 && predicted_m < 0 && predicted_m < gap_m - kThreshold_m_s * dt_s;
}

void selectRigid(const PairView& pair, PairState& state) {
  Context& context = *state.context;
  state.motion.is_checked = isSurelyChecked(pair, state);
  if (needsNoContacts(pair, state)) {
    state.contacts.clear();
    state.missed_features.clear();
    state.selection.refined.clear();
    state.selection.leaves_out = false;
    state.selection.is_of_path = true;
    state.is_incomplete = true;  // this empty selection must not be reused
    storeSelection(state.contacts, pair, state.motion, state.selection);
    return;
  }
  if (!reuseSelection(pair, state)) {
    findStepCandidates(pair, state.motion, state, state.contacts);
    ++context.pair_updates;
    context.candidates += state.contacts.size();
    selectContacts(pair, state.motion, context.settings, state.writer.get(), state.contacts,
                   &state.selection);
    state.selection.sampling_m = std::max(state.selection.sampling_m, mergedTo_m(state));
    addMissedFeatures(pair, context.settings, state, state.contacts);
    storeSelection(state.contacts, pair, state.motion, state.selection);
  }
  markSharp(pair, context.settings, !checksAlone(pair, state), state.contacts);
  markBounces(state.contacts, state.motion, PairMaterial(pair.wrapper, context.settings.friction_model));
}

}  // namespace vps::bullet
