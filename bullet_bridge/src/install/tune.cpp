// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/tune.h"

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <type_traits>

#include "solver/contact_stores.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/solver.h"

namespace vps::bullet {

namespace {

int wantedMode(int mode) {
  // With one friction direction, friction follows the slip only while the part slides. Bullet 3.24 keeps the
  // friction directions that we set only with the caching flag. In a random or interleaved order the result
  // would depend on other contacts.
  mode |=
      SOLVER_USE_WARMSTARTING | SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_ENABLE_FRICTION_DIRECTION_CACHING;
  return mode & ~(SOLVER_RANDMIZE_ORDER | SOLVER_INTERLEAVE_CONTACT_AND_FRICTION_CONSTRAINTS);
}

/// Calls visit(value, wanted, name) for every parameter that tuneWorld sets, in a fixed order. Sources:
/// Bullet's defaults from btContactSolverInfo.h and btDbvtBroadphase.cpp of 3.24; measured values from the
/// bridge's tests.
template <typename Visit>
void forEachParameter(btDiscreteDynamicsWorld& world, int solver_iterations, const Visit& visit) {
  btContactSolverInfo& info = world.getSolverInfo();
  // The stock solver's residual decreases with the number of iterations (Bullet's default: 10).
  // bullet::Solver has its own settings.
  visit(info.m_numIterations, solver_iterations, "solver iterations");
  // Position errors are corrected without adding velocity, from the first micrometre on. Parts never reach
  // Bullet's threshold of 40 mm.
  visit(info.m_splitImpulse, 1, "split impulse");
  visit(info.m_splitImpulsePenetrationThreshold, btScalar(0), "split impulse threshold [m]");
  // Overlap is corrected by rotation as much as by translation (Bullet's default: a tenth).
  visit(info.m_splitImpulseTurnErp, btScalar(1), "split impulse turn erp");
  // Share of an overlap that is corrected in one step; this is Bullet's own value.
  visit(info.m_erp2, btScalar(0.2), "contact erp");
  // A tolerated overlap and a compliance of contacts each let a part sink.
  visit(info.m_linearSlop, btScalar(0), "linear slop [m]");
  visit(info.m_globalCfm, btScalar(0), "global cfm");
  // Contacts keep their ids, so last step's impulses are close to this step's (Bullet's default: 0.85).
  visit(info.m_warmstartingFactor, btScalar(1), "warm starting factor");
  // Islands are solved one by one, so that a part's result does not depend on other bodies in the world.
  visit(info.m_minimumSolverBatchSize, 1, "least solver batch size");
  visit(info.m_solverMode, wantedMode(info.m_solverMode),
        "solver mode (warm start, two friction directions kept by contact, fixed order)");
  // At part scale Bullet's margin of 50 mm pairs every body with every other: 1023 pairs instead of 50.
  visit(gDbvtMargin, btScalar(1e-3), "broadphase margin [m], for the whole process");
}

bool hasThresholds(const btRigidBody& body, double speed_m_s, double spin_rad_s) {
  return body.getLinearSleepingThreshold() == toBt(speed_m_s) &&
         body.getAngularSleepingThreshold() == toBt(spin_rad_s);
}

// Defaults of btRigidBodyConstructionInfo.
constexpr btScalar kBulletSpeed_m_s = btScalar(0.8), kBulletSpin_rad_s = btScalar(1);

template <typename Visit>
void forEachBody(btDiscreteDynamicsWorld& world, const Visit& visit) {
  for (int i = 0; i < world.getNumCollisionObjects(); ++i)
    if (btRigidBody* body = btRigidBody::upcast(world.getCollisionObjectArray()[i])) visit(*body);
}

}  // namespace

WorldTuning tuneWorld(btDiscreteDynamicsWorld& world, int solver_iterations) {
  if (solver_iterations < 1)
    throw std::invalid_argument("tuneWorld: the solver needs at least one iteration, not " +
                                std::to_string(solver_iterations));
  // Otherwise the narrow phase would know the solver only from the second step on.
  const ContactCreateFunction* stores = contactFunctionOf(world.getDispatcher());
  if (stores && dynamic_cast<Solver*>(world.getConstraintSolver())) stores->penalty_contacts->setHasSolver();
  WorldTuning tuning;
  forEachParameter(world, solver_iterations, [&tuning](auto& value, auto wanted, const char* name) {
    tuning.values.emplace_back(value, wanted);
    if (value == wanted) return;
    std::ostringstream line;
    line << name << ": " << value << " -> " << wanted;
    tuning.changes.push_back(line.str());
    value = wanted;
  });
  forEachBody(world, [&tuning](btRigidBody& body) {
    if (body.isStaticOrKinematicObject() || !hasThresholds(body, kBulletSpeed_m_s, kBulletSpin_rad_s)) return;
    tuneBody(body);
    tuning.bodies.push_back(&body);
  });
  if (!tuning.bodies.empty()) {
    std::ostringstream line;
    line << "sleeping thresholds of " << tuning.bodies.size() << " bodies [m/s, rad/s]: " << kBulletSpeed_m_s
         << ", " << kBulletSpin_rad_s << " -> " << kSleepSpeed_m_s << ", " << kSleepSpin_rad_s;
    tuning.changes.push_back(line.str());
  }
  return tuning;
}

void restoreWorld(btDiscreteDynamicsWorld& world, const WorldTuning& tuning) {
  std::size_t next = 0;
  forEachParameter(world, 0, [&](auto& value, auto, const char*) {
    if (next >= tuning.values.size()) return;
    using Value = std::remove_reference_t<decltype(value)>;
    const auto& [before, after] = tuning.values[next++];
    if (value == static_cast<Value>(after)) value = static_cast<Value>(before);
  });
  forEachBody(world, [&](btRigidBody& body) {
    const bool is_ours = std::find(tuning.bodies.begin(), tuning.bodies.end(), &body) != tuning.bodies.end();
    if (is_ours && hasThresholds(body, kSleepSpeed_m_s, kSleepSpin_rad_s))
      body.setSleepingThresholds(kBulletSpeed_m_s, kBulletSpin_rad_s);
  });
}

void tuneBody(btRigidBody& body) {
  body.setSleepingThresholds(toBt(kSleepSpeed_m_s), toBt(kSleepSpin_rad_s));
}

}  // namespace vps::bullet
