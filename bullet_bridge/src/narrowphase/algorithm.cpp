// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/algorithm.h"

#include <BulletCollision/CollisionDispatch/btConvexConcaveCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include <algorithm>
#include <cstdio>
#include <typeinfo>
#include <utility>

#include "narrowphase/contact_selection.h"

namespace vps::bullet {

// Bullet's pool hands out elements as large as its own largest algorithm, whatever is asked for.
static_assert(sizeof(Algorithm) <= sizeof(btConvexConcaveCollisionAlgorithm));

namespace {

// Point ids do not outlive the models they belong to.
void forgetReplacedModels(PairState& state, const PairView& pair) {
  for (int i = 0; i < 2; ++i) {
    const unsigned revision = pair.vps[i] ? pair.vps[i]->revision() : 0;
    if (state.revision[i] == revision) continue;
    state.revision[i] = revision;
    state.selection.is_valid = false;
    state.selection.chosen.clear();
    state.penalty.points.clear();
    for (auto& memory : state.memory) memory.reset();
    state.writer->forget();
  }
}

// Bodies that meet for the first time where their motion cannot have brought them were put into each other:
// by mistake, more often than not.
void noteStart(const PairView& pair, PairState& state) {
  if (std::exchange(state.has_met, true)) return;
  double overlap_m = 0;
  for (const Candidate& c : state.contacts) overlap_m = std::max(overlap_m, -c.distance_m);
  if (overlap_m <= state.motion.contact_margin_m + state.motion.speed_m_s * state.motion.dt_s) return;
  Context& context = *state.context;
  double deepest_m = context.deepest_start_m;
  while (overlap_m > deepest_m && !context.deepest_start_m.compare_exchange_weak(deepest_m, overlap_m)) {
  }
  if (context.overlapping_starts++ > 0) return;
  const Vec3 at = pair.center_W();
  std::fprintf(stderr,
               "vps: two bodies begin %.3g mm inside each other, near (%.4g, %.4g, %.4g) m; they are moved "
               "apart at 0.05 m/s. Others are counted in stats().\n",
               1e3 * overlap_m, at.x(), at.y(), at.z());
}

// Points now rather than contacts for a step.
void answerQuery(const PairView& pair, Context& context, btManifoldResult& result) {
  RelativeMotion still;
  still.contact_margin_m =
      std::min<double>(std::max<double>(result.m_closestPointDistanceThreshold, 0), query_range_m(pair));
  std::vector<Candidate> candidates;
  collect(pair, still.contact_margin_m, context, candidates);
  choose(pair, still, context.settings, nullptr, candidates);
  reportToQuery(candidates, pair.wrapper, result);
}

}  // namespace

Algorithm::Algorithm(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* body0,
                     const btCollisionObjectWrapper* body1, std::shared_ptr<Context> context)
    : PairAlgorithm(info, body0, body1), state_(std::make_unique<PairState>()) {
  state_->context = std::move(context);
  state_->writer = std::make_unique<ManifoldWriter>(*m_dispatcher, body0->getCollisionObject(),
                                                    body1->getCollisionObject());
}

Algorithm::~Algorithm() {
  state_->context->penalty.remove(&state_->penalty);
}

void Algorithm::getAllContactManifolds(btManifoldArray& manifolds) {
  state_->writer->append(manifolds);
}

void Algorithm::prepare(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                        const btDispatcherInfo& info) {
  PairState& state = *state_;
  const PairView pair(body0, body1);
  state.contacts.clear();
  state.motion = {};
  state.is_prepared = true;
  forgetReplacedModels(state, pair);
  const Settings& settings = state.context->settings;
  const bool is_penalty = settings.mode == ContactMethod::Penalty;
  if (!pair.X_WS[0].isFinite() || !pair.X_WS[1].isFinite() || !is_penalty) state.penalty.points.clear();
  if (!pair.X_WS[0].isFinite() || !pair.X_WS[1].isFinite()) return;
  // Springs push from the first touch on, and only then: what is farther than the step's travel need not be
  // there.
  constexpr double kPenaltyMargin_m = 2e-6;  // assumed: contact turns the motion within the step
  const double contact_margin_m =
      is_penalty ? std::min(kPenaltyMargin_m, settings.contact_margin_m) : settings.contact_margin_m;
  state.motion = relativeMotion(pair, info.m_timeStep, contact_margin_m);
  is_penalty ? choosePenalty(pair, state) : chooseRigid(pair, state);
}

void Algorithm::processCollision(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                                 const btDispatcherInfo& info, btManifoldResult* result) {
  Context& context = *state_->context;
  const PairView pair(body0, body1);
  // A contactTest hands in a result of its own type.
  if (typeid(*result) != typeid(btManifoldResult)) {
    if (pair.X_WS[0].isFinite() && pair.X_WS[1].isFinite()) answerQuery(pair, context, *result);
    return;
  }
  if (!state_->is_prepared) prepare(body0, body1, info);
  state_->is_prepared = false;
  noteStart(pair, *state_);
  context.contacts += state_->contacts.size();
  state_->writer->write(state_->contacts, pair.wrapper, state_->motion);
  // Pairs that press on nothing, and all of rigid mode, have nothing to say to the solver.
  const bool presses = !state_->penalty.points.empty();
  if (!presses && state_->is_registered) context.penalty.remove(&state_->penalty);
  state_->is_registered = presses;
  if (presses)
    for (const btPersistentManifold* manifold : state_->writer->manifolds())
      context.penalty.add(manifold, &state_->penalty);
}

}  // namespace vps::bullet
