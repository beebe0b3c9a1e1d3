// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/install.h"

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <sstream>

#include "vps_bullet/convert.h"

namespace vps {

namespace {

template <typename T>
void change(T& value, T wanted, const char* name, std::vector<std::string>& said) {
  if (value == wanted) return;
  std::ostringstream line;
  line << name << ": " << value << " -> " << wanted;
  said.push_back(line.str());
  value = wanted;
}

}  // namespace

std::vector<std::string> tuneWorld(btDiscreteDynamicsWorld& world, int solver_iterations) {
  std::vector<std::string> said;
  btContactSolverInfo& info = world.getSolverInfo();
  change(info.m_numIterations, solver_iterations, "solver iterations", said);
  // Position errors are pushed out without leaving velocity behind, from the first micrometre on.
  change(info.m_splitImpulse, 1, "split impulse", said);
  change(info.m_splitImpulsePenetrationThreshold, btScalar(0), "split impulse threshold [m]", said);
  change(info.m_splitImpulseTurnErp, btScalar(1), "split impulse turn erp", said);
  change(info.m_erp2, btScalar(0.2), "contact erp", said);
  change(info.m_linearSlop, btScalar(0), "linear slop [m]", said);
  change(info.m_globalCfm, btScalar(0), "global cfm", said);
  change(info.m_warmstartingFactor, btScalar(1), "warm starting factor", said);
  // Islands are solved one by one, so that one part's result does not depend on what else is in the world.
  change(info.m_minimumSolverBatchSize, 1, "least solver batch size", said);
  int mode = info.m_solverMode;
  mode |=
      SOLVER_USE_WARMSTARTING | SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_ENABLE_FRICTION_DIRECTION_CACHING;
  mode &= ~(SOLVER_RANDMIZE_ORDER | SOLVER_INTERLEAVE_CONTACT_AND_FRICTION_CONSTRAINTS);
  change(info.m_solverMode, mode,
         "solver mode (warm start, two friction directions kept by contact, fixed order)", said);
  // A process-wide setting of Bullet: 50 mm of margin pairs everything with everything at part scale.
  change(gDbvtMargin, btScalar(1e-3), "broadphase margin [m], for the whole process", said);
  return said;
}

}  // namespace vps
