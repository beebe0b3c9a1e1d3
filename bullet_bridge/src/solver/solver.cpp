// SPDX-License-Identifier: BSD-3-Clause
// One step's velocities u of an island satisfy
//
//     (M + J' D J) u = M u0 + J' c + sum of contact impulses        (J, c, D: the couplings' linear laws)
//
// so a coupling only adds effective mass and a constant impulse: M_eff = M + J' D J, a 6x6 matrix for each
// body. Contacts are then solved with M_eff, by the constraint or the penalty method. If a coupling were a
// block of solver rows instead, a stiff one on a light part would converge like (1 - 1 / (1 + A D)): 20 kN/m
// on 1 g at 1 kHz would need hundreds of iterations. Sources: Todorov 2014 and Castro et al. 2021 for
// implicit springs as effective mass.
#include "vps_bullet/solver.h"

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <span>
#include <stdexcept>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "log/report.h"
#include "solver/contact_stores.h"
#include "solver/impact/restitution.h"
#include "solver/island/island.h"
#include "solver/penalty/penalty_newton.h"
#include "solver/rigid/contact_loop.h"
#include "solver/rigid/step_check.h"
#include "vps/contact_tolerances.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/coupling.h"

namespace vps::bullet {

/// Working data of one island; kept between calls to reuse its memory.
struct Solver::Work {
  /// A coupling whose part belongs to the island.
  struct ActiveCoupling {
    CouplingConstraint* coupling;
    int body;
    Mat6 J;  // maps the body's twist to the grasp point's
    CouplingConstraint::Law law;
  };
  ContactLoop loop;
  Island& island = loop.island;
  JointRows& joints = loop.joints;
  ContactSweeps& rigid = loop.contacts;
  PenaltyNewton penalty{island, joints};
  Restitution restitution{island, joints};
  std::vector<BodyEnd> ends;
  bool is_penalty = false;
  std::vector<CouplingConstraint*> couplings;
  std::vector<ActiveCoupling> active_couplings;
  std::vector<PenaltyManifold> manifolds;  // with penalty contact
  std::deque<PenaltyPair> converted;       // penalty points made from manifolds without VPS contact
  std::vector<PenaltyPair*> pairs;         // all pairs, each once
  std::size_t points_near = 0;             // number of points of all pairs
  StepSolution solution;                   // solution of the island, before a step is shortened

  bool gatherBodies(std::span<btCollisionObject*> objects, double dt_s);
  void gatherConstraints(std::span<btTypedConstraint*> constraints, const btContactSolverInfo& info);
  bool gatherContacts(std::span<btPersistentManifold*> manifolds, const ContactCreateFunction* stores,
                      const btContactSolverInfo& info);
  void gatherPenaltyPoints(std::size_t limit, double dt_s);
  void gatherCouplings(double dt_s);
  void applyLaws();
  bool updateLaws();
  SolveOutcome solveContacts(const SolverSettings& settings);
  SolveOutcome solveWithLaws(const SolverSettings& settings);
  SolveOutcome solve(const SolverSettings& settings, const btContactSolverInfo& info);
};

namespace {

bool isPlain(const btManifoldPoint& point) {
  constexpr int kSoft = BT_CONTACT_FLAG_HAS_CONTACT_CFM | BT_CONTACT_FLAG_HAS_CONTACT_ERP |
                        BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING | BT_CONTACT_FLAG_FRICTION_ANCHOR;
  return !(point.m_contactPointFlags & kSoft) && !(point.m_combinedRollingFriction > 0) &&
         !(point.m_combinedSpinningFriction > 0);
}

}  // namespace

bool Solver::Work::gatherBodies(std::span<btCollisionObject*> objects, double dt_s) {
  island.clear();
  for (btCollisionObject* object : objects) {
    btRigidBody* rigid = btRigidBody::upcast(object);
    if (!rigid || !Island::takes(*rigid)) return false;
    if (rigid->getInvMass() > 0 && !rigid->isKinematicObject()) island.add(*rigid, dt_s);
  }
  return true;
}

void Solver::Work::gatherConstraints(std::span<btTypedConstraint*> constraints,
                                     const btContactSolverInfo& info) {
  couplings.clear();
  joints.clear();
  for (btTypedConstraint* constraint : constraints) {
    if (!constraint->isEnabled()) continue;
    if (auto* coupling = dynamic_cast<CouplingConstraint*>(constraint))
      couplings.push_back(coupling);
    else
      joints.add(*constraint, island, info);
  }
}

bool Solver::Work::gatherContacts(std::span<btPersistentManifold*> from, const ContactCreateFunction* stores,
                                  const btContactSolverInfo& info) {
  rigid.clear();
  penalty.clear(info.m_timeStep);
  manifolds.clear();
  converted.clear();
  loop.checks.clear();
  for (btPersistentManifold* manifold : from) {
    if (manifold->getBody0()->hasAnisotropicFriction() || manifold->getBody1()->hasAnisotropicFriction())
      return false;
    for (int i = 0; i < manifold->getNumContacts(); ++i)
      if (!isPlain(manifold->getContactPoint(i))) return false;
    manifolds.push_back({manifold, stores ? stores->penalty_contacts->find(manifold) : nullptr});
    if (StepCheck* check = stores ? stores->step_checks->find(manifold) : nullptr)
      loop.checks.push_back(check);
  }
  is_penalty =
      std::any_of(manifolds.begin(), manifolds.end(), [](const auto& m) { return m.pair != nullptr; });
  if (!is_penalty) {
    for (btPersistentManifold* manifold : from)
      for (int i = 0; i < manifold->getNumContacts(); ++i)
        rigid.add(*manifold, manifold->getContactPoint(i), info);
    return true;
  }
  return true;
}

void Solver::Work::gatherPenaltyPoints(std::size_t limit, double dt_s) {
  pairs.clear();
  points_near = 0;
  std::unordered_set<const PenaltyPair*> added;  // a pair may have several manifolds
  for (PenaltyManifold& m : manifolds) {
    if (!m.pair) m.pair = &converted.emplace_back(penaltyPairOf(*m.manifold, dt_s));
    if (!added.insert(m.pair).second) continue;
    pairs.push_back(m.pair);
    points_near += m.pair->points.size();
  }
  const int level = levelFor(pairs, limit);
  for (PenaltyPair* pair : pairs) penalty.add(*pair, level);
}

void Solver::Work::gatherCouplings(double dt_s) {
  active_couplings.clear();
  for (CouplingConstraint* coupling : couplings) {
    coupling->buildJacobian();
    coupling->step_ = coupling->makeStep(dt_s);
    const int index = island.indexOf(&coupling->part_);
    if (coupling->step_.is_open || index < 0) continue;
    ActiveCoupling h{coupling, index, Mat6::Identity(), coupling->lawAt(coupling->step_, Vec6::Zero(), true)};
    h.J.bottomLeftCorner<3, 3>() = -crossMatrix(coupling->step_.r_W);
    active_couplings.push_back(h);
  }
}

void Solver::Work::applyLaws() {
  for (IslandBody& b : island.bodies) {
    b.effective_mass = b.mass;
    b.coupling_impulse.setZero();
  }
  for (const ActiveCoupling& h : active_couplings) {
    IslandBody& b = island.bodies[static_cast<std::size_t>(h.body)];
    b.effective_mass += h.J.transpose() * h.law.D.asDiagonal() * h.J;
    b.coupling_impulse += h.J.transpose() * h.law.c;
  }
  for (IslandBody& b : island.bodies) b.effective_inverse = b.effective_mass.llt().solve(Mat6::Identity());
}

// Replaces the couplings' laws that are not valid at the present velocities. Returns true if all laws were
// valid.
bool Solver::Work::updateLaws() {
  bool is_converged = true;
  for (ActiveCoupling& h : active_couplings) {
    const Vec6 V_G = h.J * island.bodies[static_cast<std::size_t>(h.body)].u;
    const CouplingConstraint::Law law = h.coupling->lawAt(h.coupling->step_, V_G);
    const double change = (law.c - h.law.c).norm();
    if (law.limited != h.law.limited || change > kSettledShare * law.c.norm()) is_converged = false;
    if (!is_converged) h.law = law;
  }
  return is_converged;
}

SolveOutcome Solver::Work::solveContacts(const SolverSettings& settings) {
  return is_penalty ? penalty.solve(settings.residual_m_s, settings.iteration_limit)
                    : loop.solveContacts(settings);
}

// The law of a coupling at its limit depends on the solution, and so do the limits of friction. Solves,
// updates laws and limits, and solves again if they changed.
SolveOutcome Solver::Work::solveWithLaws(const SolverSettings& settings) {
  const int rounds = is_penalty ? 20 : 6;  // assumed; limits of couplings converge in two or three rounds
  SolveOutcome last;
  int most_steps = 0;
  SolverSettings left = settings;
  for (int round = 0; round < rounds; ++round) {
    applyLaws();
    last = solveContacts(left);
    most_steps = std::max(most_steps, last.steps);
    if (is_penalty) left.iteration_limit -= last.steps;  // each step evaluates thousands of points
    if (round == rounds - 1 || left.iteration_limit <= 0)
      break;  // not converged: laws and limits of the last solution remain
    const bool has_settled_friction = !is_penalty || penalty.updateLimits() < kSettledShare;
    if (updateLaws() && has_settled_friction) break;
  }
  return {most_steps, last.is_converged};
}

SolveOutcome Solver::Work::solve(const SolverSettings& settings, const btContactSolverInfo& info) {
  if (is_penalty) return solveWithLaws(settings);
  return loop.run(info, settings.iteration_limit, true, [&] { return solveWithLaws(settings); });
}

Solver::Solver(const SolverSettings& settings) : settings_(settings), work_(std::make_unique<Work>()) {
  if (settings.iteration_limit < 1)
    throw std::invalid_argument("Solver: iteration_limit must be at least 1, not " +
                                std::to_string(settings.iteration_limit));
  if (!(settings.residual_m_s > 0) || !std::isfinite(settings.residual_m_s))
    throw std::invalid_argument("Solver: residual_m_s must be positive and finite");
}
Solver::~Solver() = default;

void Solver::reportGroups() {
  if (points_solved_ >= points_near_ || std::exchange(has_reported_groups_, true)) return;
  report(
      LogLevel::Warning,
      std::to_string(points_near_)
          .append(" penalty points of one island are near a surface: neighbours are solved together, as ")
          .append(std::to_string(points_solved_))
          .append(
              " points (SolverSettings::point_limit). This makes contact a little stiffer; a coarser spacing "
              "of the parts or ContactMethod::Constraint avoids the grouping"));
}

btScalar Solver::solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                            int manifold_count, btTypedConstraint** constraints, int constraint_count,
                            const btContactSolverInfo& info, btIDebugDraw* draw, btDispatcher* dispatcher) {
  const auto spanOf = [](auto** first, int count) {
    return std::span(first, static_cast<std::size_t>(count));
  };
  const double dt_s = info.m_timeStep;
  Work& work = *work_;
  const ContactCreateFunction* stores = contactFunctionOf(dispatcher);
  if (stores) stores->penalty_contacts->setHasSolver();
  if (stores) reportClampedTurn(*stores->turn_reports, spanOf(bodies, body_count), dt_s);
  if (!work.gatherBodies(spanOf(bodies, body_count), dt_s) ||
      !work.gatherContacts(spanOf(manifolds, manifold_count), stores, info)) {
    if (stores) stores->penalty_contacts->setHasLeftIslands();
    return btSequentialImpulseConstraintSolver::solveGroup(
        bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info, draw, dispatcher);
  }
  if (work.island.bodies.empty()) return 0;  // Bullet ends each step with a call that has no bodies
  points_near_ = points_solved_ = 0;
  if (work.is_penalty) {
    work.gatherPenaltyPoints(settings_.point_limit, dt_s);
    points_near_ = work.points_near;
    points_solved_ = work.penalty.pointCount();
    reportGroups();
  }
  work.gatherConstraints(spanOf(constraints, constraint_count), info);
  work.gatherCouplings(dt_s);

  const SolveOutcome outcome = work.solve(settings_, info);
  iterations_used_ = outcome.steps;
  is_converged_ = outcome.is_converged;
  work.island.readSolution(work.solution);
  for (const Work::ActiveCoupling& h : work.active_couplings) {
    const Vec6 V_G = h.J * work.island.bodies[static_cast<std::size_t>(h.body)].u;
    h.coupling->setImpulse(h.law.c - h.law.D.cwiseProduct(V_G), dt_s);
  }
  work.solution.is_cut_short =
      !work.is_penalty && work.loop.hasMissed() &&
      endEarly(work.island, work.rigid.contacts(), work.joints, work.loop.checks, work.rigid.push(), dt_s);
  if (work.solution.is_cut_short) ++shortened_steps_;
  for (StepCheck* check : work.loop.checks) check->endStep();
  const std::span<const Vec6> push = work.is_penalty ? std::span<const Vec6>() : work.rigid.push();
  if (!push.empty()) ++pushed_steps_;
  work.island.readEnds(push, dt_s, work.ends);
  if (!work.is_penalty) work.restitution.apply(work.rigid.contacts(), work.solution, work.ends, info);
  work.joints.hold(work.island, work.ends);
  if (work.is_penalty) work.penalty.finish();
  work.joints.finish(dt_s);
  work.is_penalty ? writeImpulses(work.manifolds, dt_s) : work.rigid.finish();
  work.island.finish(push, dt_s, work.ends);
  return 0;
}

}  // namespace vps::bullet
