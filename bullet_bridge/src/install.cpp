// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/install.h"

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionConfiguration.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btEmptyCollisionAlgorithm.h>
#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <mutex>
#include <new>
#include <sstream>
#include <stdexcept>

#include "context.h"
#include "vps_bullet/algorithm.h"
#include "vps_bullet/convert.h"

namespace vps {

namespace {

constexpr int kVps = FAST_CONCAVE_MESH_PROXYTYPE;
constexpr int kPrimitives[] = {BOX_SHAPE_PROXYTYPE, SPHERE_SHAPE_PROXYTYPE, CAPSULE_SHAPE_PROXYTYPE,
                               CYLINDER_SHAPE_PROXYTYPE, STATIC_PLANE_PROXYTYPE};
// Concave against concave has no stock algorithm; Bullet would do nothing in silence.
constexpr int kRefused[] = {
    TRIANGLE_MESH_SHAPE_PROXYTYPE, SCALED_TRIANGLE_MESH_SHAPE_PROXYTYPE,  TERRAIN_SHAPE_PROXYTYPE,
    GIMPACT_SHAPE_PROXYTYPE,       MULTIMATERIAL_TRIANGLE_MESH_PROXYTYPE, CUSTOM_CONCAVE_SHAPE_TYPE};

struct VpsCreate : btCollisionAlgorithmCreateFunc {
  std::shared_ptr<VpsContext> context;
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* body0,
                                                 const btCollisionObjectWrapper* body1) override {
    void* room = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(VpsAlgorithm));
    return new (room) VpsAlgorithm(info, body0, body1, context);
  }
};

struct RefusingCreate : btCollisionAlgorithmCreateFunc {
  bool has_said = false;
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* body0,
                                                 const btCollisionObjectWrapper* body1) override {
    if (!has_said) {
      has_said = true;
      std::fprintf(stderr, "vps: VpsShape and %s do not collide: build a VpsShape from that mesh too\n",
                   (body0->getCollisionShape()->getShapeType() == kVps ? body1 : body0)
                       ->getCollisionShape()
                       ->getName());
    }
    void* room = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(btEmptyAlgorithm));
    return new (room) btEmptyAlgorithm(info);
  }
};

struct Installation {
  std::shared_ptr<VpsContext> context = std::make_shared<VpsContext>();
  VpsCreate create;
  RefusingCreate refuse;
};

// The dispatcher's tables have no room for an owner, so installations are kept here.
std::mutex g_mutex;
std::map<const btCollisionDispatcher*, std::unique_ptr<Installation>>& installations() {
  static std::map<const btCollisionDispatcher*, std::unique_ptr<Installation>> all;
  return all;
}

template <typename Register>
void forEachPair(const Register& set) {
  set(kVps, kVps, true);
  for (const int type : kPrimitives) set(kVps, type, true), set(type, kVps, true);
  for (const int type : kRefused) set(kVps, type, false), set(type, kVps, false);
}

void requireUsable(const VpsBulletSettings& s) {
  if (s.contact_limit < 4) throw std::invalid_argument("installVps: contact_limit must be at least 4");
  if (s.candidate_limit != 0 && s.candidate_limit < s.contact_limit)
    throw std::invalid_argument("installVps: candidate_limit must be 0 (all) or at least contact_limit");
  if (!(s.stiffness_N_per_m3 > 0) || !std::isfinite(s.stiffness_N_per_m3))
    throw std::invalid_argument("installVps: stiffness_N_per_m3 must be positive and finite");
  if (!(s.slack_m > 0) || !(s.slack_m < 1e-2))
    throw std::invalid_argument("installVps: slack_m must be positive and below 10 mm");
}

template <typename T>
void change(T& value, T wanted, const char* name, std::vector<std::string>& said) {
  if (value == wanted) return;
  std::ostringstream line;
  line << name << ": " << value << " -> " << wanted;
  said.push_back(line.str());
  value = wanted;
}

}  // namespace

void installVps(btCollisionDispatcher& dispatcher, const VpsBulletSettings& settings) {
  requireUsable(settings);
  const std::lock_guard lock(g_mutex);
  std::unique_ptr<Installation>& installation = installations()[&dispatcher];
  if (!installation) {
    installation = std::make_unique<Installation>();
    installation->create.context = installation->context;
  }
  installation->context->settings = settings;
  forEachPair([&](int a, int b, bool is_supported) {
    btCollisionAlgorithmCreateFunc* create =
        is_supported ? static_cast<btCollisionAlgorithmCreateFunc*>(&installation->create)
                     : &installation->refuse;
    dispatcher.registerCollisionCreateFunc(a, b, create);
    dispatcher.registerClosestPointsCreateFunc(a, b, create);
  });
}

void uninstallVps(btCollisionDispatcher& dispatcher) {
  const std::lock_guard lock(g_mutex);
  if (installations().erase(&dispatcher) == 0) return;
  btCollisionConfiguration& stock = *dispatcher.getCollisionConfiguration();
  forEachPair([&](int a, int b, bool) {
    dispatcher.registerCollisionCreateFunc(a, b, stock.getCollisionAlgorithmCreateFunc(a, b));
    dispatcher.registerClosestPointsCreateFunc(a, b, stock.getClosestPointsAlgorithmCreateFunc(a, b));
  });
}

bool isVpsInstalled(const btCollisionDispatcher& dispatcher) {
  const std::lock_guard lock(g_mutex);
  return installations().count(&dispatcher) > 0;
}

std::shared_ptr<VpsContext> contextOf(const btDispatcher* dispatcher) {
  const std::lock_guard lock(g_mutex);
  const auto it = installations().find(static_cast<const btCollisionDispatcher*>(dispatcher));
  return it == installations().end() ? nullptr : it->second->context;
}

VpsBulletStats vpsStats(const btCollisionDispatcher& dispatcher) {
  const std::lock_guard lock(g_mutex);
  VpsBulletStats stats;
  const auto it = installations().find(&dispatcher);
  if (it == installations().end()) return stats;
  const VpsContext& c = *it->second->context;
  stats.pair_updates = c.pair_updates;
  stats.points_tested = c.points_tested;
  stats.candidates = c.candidates;
  stats.contacts = c.contacts;
  stats.left_out = c.left_out;
  return stats;
}

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
