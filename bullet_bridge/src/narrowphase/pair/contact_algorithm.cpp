// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/pair/pair_algorithm.h"

#include <BulletCollision/CollisionDispatch/btConvexConcaveCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <typeinfo>
#include <utility>

#include "log/report.h"
#include "narrowphase/check/pair_check.h"
#include "narrowphase/selection/contact_selection.h"
#include "solver/contact_stores.h"
#include "solver/rigid/step_check.h"
#include "vps/contact_tolerances.h"
#include "vps_bullet/turn.h"

namespace vps::bullet {

// Elements of Bullet's pool are as large as Bullet's largest algorithm, whatever size is requested.
static_assert(sizeof(ContactAlgorithm) <= sizeof(btConvexConcaveCollisionAlgorithm));

namespace {

// Point ids are valid for one revision of the models only.
void resetIfModelsChanged(PairState& state, const PairView& pair) {
  for (int i = 0; i < 2; ++i) {
    const std::uint64_t revision = pair.shape[i] ? pair.shape[i]->revision() : 0;
    if (state.revision[i] == revision) continue;
    state.revision[i] = revision;
    state.clear_way.forget();
    state.selection = {};
    state.penalty.points.clear();
    state.features.reset();
    state.spin.reset();
    state.are_both_curved.reset();
    state.missed_features.clear();
    state.crossings.reset();
    for (auto& query_state : state.query_state) query_state.reset();
    for (auto& ids : state.always) ids.clear();
    state.writer->invalidateIds();
  }
}

// Counts, and reports once, bodies that overlap at their first query by more than their motion explains. Such
// bodies were placed into each other, usually by mistake.
void countInitialOverlap(const PairView& pair, PairState& state) {
  if (std::exchange(state.was_queried, true)) return;
  double overlap_m = 0;
  for (const Candidate& c : state.contacts) overlap_m = std::max(overlap_m, -c.distance_m);
  if (overlap_m <= state.motion.contact_margin_m + state.motion.speed_m_s * state.motion.dt_s) return;
  Context& context = *state.context;
  double deepest_m = context.deepest_start_m;
  while (overlap_m > deepest_m && !context.deepest_start_m.compare_exchange_weak(deepest_m, overlap_m)) {
  }
  if (context.overlapping_starts++ > 0) return;
  const Vec3 at = pair.center_W();
  const Vec3 body[2] = {pair.X_WS[0].p, pair.X_WS[1].p};
  char words[500];
  std::snprintf(
      words, sizeof words,
      "the bodies at (%.4g, %.4g, %.4g) m and (%.4g, %.4g, %.4g) m begin at least %.3g mm inside "
      "each other, near (%.4g, %.4g, %.4g) m; a voxmap measures no deeper than its band. Both bodies "
      "are moved apart at 0.05 m/s. Further pairs that begin inside each other are not reported.",
      body[0].x(), body[0].y(), body[0].z(), body[1].x(), body[1].y(), body[1].z(), 1e3 * overlap_m, at.x(),
      at.y(), at.z());
  report(LogLevel::Warning, words);
}

// True for a query, false for a step. Bullet's contactTest passes a result type that the library does not
// export. A host may pass its own type: with a distance threshold for a query, without one for a step.
bool isQuery(const btManifoldResult& result) {
  if (typeid(result) == typeid(btManifoldResult)) return false;
  return result.m_closestPointDistanceThreshold > 0 ||
         std::strstr(typeid(result).name(), "btBridgedManifoldResult") != nullptr;
}

// Reports the points that are near at the present poses, for a query.
void reportClosestPoints(const PairView& pair, Context& context, btManifoldResult& result) {
  const double wanted_m = std::max<double>(result.m_closestPointDistanceThreshold, 0);
  RelativeMotion still;
  std::vector<Candidate> candidates;
  still.contact_margin_m = std::min(wanted_m, queryRange_m(pair));
  findCandidates(pair, still.contact_margin_m, context, candidates);
  // Beyond the band of the fields only the exact surfaces give distances.
  if (candidates.empty() && wanted_m > still.contact_margin_m)
    candidates = nearestFarPoints(pair, wanted_m, context);
  else
    selectContacts(pair, still, context.settings, nullptr, candidates);
  reportContacts(candidates, pair.wrapper, result);
}

// Solvers other than bullet::Solver do not use penalty points.
void warnWithoutSolver() {
  static std::atomic_flag was_reported;
  if (!was_reported.test_and_set())
    report(
        LogLevel::Warning,
        "Settings::contact_method is Penalty, but the world's solver is not bullet::Solver, so all contacts "
        "are rigid");
}

// Greatest distance by which a touching point leaves its plane in the step; zero for bodies that roll on each
// other.
double sagitta_m(const PairState& state) {
  const RelativeMotion& motion = state.motion;
  double most_m = 0;
  for (const Candidate& c : state.contacts)
    if (c.distance_m <= motion.contact_margin_m)
      most_m = std::max(most_m,
                        0.5 * motion.V.w.cross(motion.velocityAt(c.p_W)).norm() * motion.dt_s * motion.dt_s);
  return most_m;
}

// Reports bodies that turn so far in a step that contact planes are inaccurate (PairCheck does not carry them
// along).
void warnOfTurn(PairState& state, const PairView& pair) {
  const double w_rad_s = state.motion.V.w.norm(), dt_s = state.motion.dt_s;
  const bool is_fast = w_rad_s * dt_s > kContactTurn_rad && sagitta_m(state) > kContactSagitta_m;
  state.turns_in_row = is_fast ? state.turns_in_row + 1 : 0;
  state.fastest_rad_s = is_fast ? std::max(state.fastest_rad_s, w_rad_s) : 0;
  if (state.turns_in_row < kTurnsInRow) return;
  reportContactTurn(*state.context->turn_reports, *pair.wrapper[0]->getCollisionObject(),
                    *pair.wrapper[1]->getCollisionObject(), state.fastest_rad_s, dt_s);
}

// Registers the pair's penalty points for the solver, or removes them.
void passToSolver(PairState& state) {
  PenaltyContacts& contacts = *state.context->penalty_contacts;
  const bool has_points = !state.penalty.points.empty();
  const bool was_registered = std::exchange(state.is_registered, has_points);
  // The points were registered a whole step ago, and no solver has used them since.
  if (was_registered && !contacts.hasSolver()) warnWithoutSolver();
  if (!has_points && was_registered) contacts.remove(&state.penalty);
  if (has_points)
    for (const btPersistentManifold* manifold : state.writer->manifolds())
      contacts.add(manifold, &state.penalty);
}

// True if the pair gets spare manifolds for contacts that the solver may add. Contact with other bodies may
// throw the pair's bodies at each other within the step. A pair with a kinematic body and no contact gets no
// spare manifolds, since Bullet wakes a sleeping body for each manifold with a kinematic body.
bool mayNeedMore(const PairView& pair, const PairState& state) {
  if (state.context->settings.contact_method != ContactMethod::Constraint) return false;
  const auto isKinematic = [&](int i) { return pair.wrapper[i]->getCollisionObject()->isKinematicObject(); };
  return !state.contacts.empty() || !(isKinematic(0) || isKinematic(1));
}

// Registers the pair's check under its first manifold, where the solver looks for it.
void registerCheck(const PairView& pair, PairState& state) {
  const bool has_manifold = !state.writer->manifolds().empty();
  if (state.context->settings.contact_method != ContactMethod::Constraint || !has_manifold) return;
  if (!state.check) {
    auto check = std::make_unique<PairCheck>(state);
    state.context->step_checks->add(state.writer->manifolds().front(), check.get());
    state.check = std::move(check);
  }
  static_cast<PairCheck&>(*state.check).setBodies(pair);
}

}  // namespace

ContactAlgorithm::ContactAlgorithm(const btCollisionAlgorithmConstructionInfo& info,
                                   const btCollisionObjectWrapper* body0,
                                   const btCollisionObjectWrapper* body1, std::shared_ptr<Context> context)
    : PairAlgorithm(info, body0, body1), state_(std::make_unique<PairState>()) {
  state_->context = std::move(context);
  state_->writer =
      std::make_unique<ManifoldWriter>(*m_dispatcher, body0->getCollisionObject(),
                                       body1->getCollisionObject(), state_->context->settings.friction_model);
}

ContactAlgorithm::~ContactAlgorithm() {
  state_->context->penalty_contacts->remove(&state_->penalty);
  if (state_->check) state_->context->step_checks->remove(state_->writer->manifolds().front());
}

void ContactAlgorithm::getAllContactManifolds(btManifoldArray& manifolds) {
  state_->writer->append(manifolds);
}

void ContactAlgorithm::prepare(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                               const btDispatcherInfo& info) {
  PairState& state = *state_;
  const PairView pair(body0, body1);
  state.contacts.clear();
  state.motion = {};
  state.is_prepared = true;
  // Bullet does not renew the algorithm of a compound's child if another compound replaces the compound.
  if (!isFor(body0->getCollisionShape(), body1->getCollisionShape())) return;
  resetIfModelsChanged(state, pair);
  const Settings& settings = state.context->settings;
  const bool is_penalty = settings.contact_method == ContactMethod::Penalty;
  if (!pair.X_WS[0].isFinite() || !pair.X_WS[1].isFinite() || !is_penalty) state.penalty.points.clear();
  if (!pair.X_WS[0].isFinite() || !pair.X_WS[1].isFinite()) return;
  // Penalty points press only once they touch, so points beyond the step's travel are not needed.
  const double contact_margin_m =
      is_penalty ? std::min(2 * kSamePlace_m, settings.contact_margin_m) : settings.contact_margin_m;
  const bool is_held = !is_penalty && state.selection.is_valid && !state.selection.contacts.empty();
  state.motion = relativeMotion(pair, info.m_timeStep, contact_margin_m, is_held);
  if (settings.friction_model.coefficient) state.motion.V_start = presentVelocity(pair);
  is_penalty ? selectPenalty(pair, state) : selectRigid(pair, state);
}

void ContactAlgorithm::processCollision(const btCollisionObjectWrapper* body0,
                                        const btCollisionObjectWrapper* body1, const btDispatcherInfo& info,
                                        btManifoldResult* result) {
  Context& context = *state_->context;
  const PairView pair(body0, body1);
  if (!isFor(body0->getCollisionShape(), body1->getCollisionShape())) {
    state_->selection = {};
    state_->penalty.points.clear();
    state_->writer->write({}, pair.wrapper, {}, false);
    passToSolver(*state_);
    return;
  }
  if (isQuery(*result)) {
    if (pair.X_WS[0].isFinite() && pair.X_WS[1].isFinite()) reportClosestPoints(pair, context, *result);
    return;
  }
  if (!state_->is_prepared) prepare(body0, body1, info);
  state_->is_prepared = false;
  countInitialOverlap(pair, *state_);
  context.contacts += state_->contacts.size();
  warnOfTurn(*state_, pair);
  state_->writer->write(state_->contacts, pair.wrapper, state_->motion, mayNeedMore(pair, *state_));
  registerCheck(pair, *state_);
  addMissedAlone(*m_dispatcher, pair, *state_);
  passToSolver(*state_);
}

}  // namespace vps::bullet
