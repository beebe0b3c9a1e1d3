// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/check/pair_check.h"

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <algorithm>

#include "narrowphase/check/feature_check.h"
#include "narrowphase/selection/contact_selection.h"
#include "solver/contact_stores.h"
#include "solver/rigid/contact_loop.h"
#include "vps/contact_tolerances.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {

namespace {

bool isMoved(const btCollisionObject& object) {
  const btRigidBody* rigid = btRigidBody::upcast(&object);
  return rigid && rigid->getInvMass() > 0 && !rigid->isKinematicObject();
}

bool isTaken(const btCollisionObject& object) {
  return !isMoved(object) || Island::takes(*btRigidBody::upcast(&object));
}

// Mass matrix of a body whose linear and angular factors, or an inertia of zero, lock some directions. The
// mass in a locked direction is a million times as large.
Mat6 massWithFactors(const btRigidBody& body, double reach_m) {
  const Mat3 R = fromBt(body.getWorldTransform()).R;
  const Vec3 v_factor = fromBt(body.getLinearFactor()), w_factor = fromBt(body.getAngularFactor());
  const double light = 1 / (kRigidRatio * body.getMass());
  Mat6 inverse = Mat6::Zero();
  inverse.topLeftCorner<3, 3>() = w_factor.asDiagonal() * R *
                                  fromBt(body.getInvInertiaDiagLocal()).asDiagonal() * R.transpose() *
                                  w_factor.asDiagonal();
  inverse.topLeftCorner<3, 3>() += light / (reach_m * reach_m) * Mat3::Identity();
  inverse.bottomRightCorner<3, 3>() = (v_factor.cwiseAbs2() * body.getInvMass()).asDiagonal();
  inverse.bottomRightCorner<3, 3>() += light * Mat3::Identity();
  return inverse.inverse();
}

// Velocity about its centre that a body's couplings add in free motion.
Vec6 pullOf(const btCollisionObject& object, double dt_s) {
  const Twist with = predictedVelocity(object, dt_s), own = predictedVelocity(object, dt_s, false);
  const Vec3 w = with.w - own.w, center = fromBt(object.getWorldTransform().getOrigin());
  return stacked(w, with.v - own.v + w.cross(center));
}

// Change of a body's angular velocity by the gyroscopic terms of Bullet's solvers.
Vec3 gyroscopicChange(const btRigidBody& body, const btContactSolverInfo& info) {
  const btScalar dt = info.m_timeStep;
  btVector3 change(0, 0, 0);
  if (body.getFlags() & BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT)
    change -= body.computeGyroscopicForceExplicit(toBt(info.m_maxGyroscopicForce)) *
              body.getInvInertiaTensorWorld() * dt;
  if (body.getFlags() & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD)
    change += body.computeGyroscopicImpulseImplicit_World(dt);
  if (body.getFlags() & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY)
    change += body.computeGyroscopicImpulseImplicit_Body(dt);
  return fromBt(change);
}

void placeBodies(const PairView& pair, const btContactSolverInfo& info, Island& island) {
  const double dt_s = info.m_timeStep;
  island.clear();
  for (const btCollisionObjectWrapper* wrapper : pair.wrapper) {
    const btCollisionObject& object = *wrapper->getCollisionObject();
    if (!isMoved(object)) continue;
    island.add(*const_cast<btRigidBody*>(btRigidBody::upcast(&object)), dt_s);
    IslandBody& b = island.bodies.back();
    if (!Island::takes(*b.rigid)) b.mass = massWithFactors(*b.rigid, b.reach_m);
    b.momentum = b.mass * b.start + b.external_Ns;
    b.momentum.head<3>() += b.mass.topLeftCorner<3, 3>() * gyroscopicChange(*b.rigid, info);
    b.effective_mass = b.mass;
    b.effective_inverse = b.mass.llt().solve(Mat6::Identity());
    b.coupling_impulse = b.mass * pullOf(object, dt_s);
  }
}

/// Saves the impulses of a pair's contacts before the rounds, which change them, and restores them.
class Impulses {
 public:
  explicit Impulses(std::span<btPersistentManifold* const> manifolds) : manifolds_(manifolds) {
    for (const btPersistentManifold* manifold : manifolds) {
      counts_.push_back(manifold->getNumContacts());
      for (int i = 0; i < counts_.back(); ++i) points_.push_back(manifold->getContactPoint(i));
    }
  }
  /// A contact that existed before this step gets back the impulse that it had. Contacts that are new in this
  /// step start with impulses in proportion to their solved impulses. The sum of the new contacts' normal
  /// impulses is the load of the contacts that were dropped in this step, but at most the solved sum.
  ///
  /// Without these starting impulses a body would slide too slowly: while Bullet's solvers iterate, they load
  /// a new contact and unload it again, but keep the contact's friction.
  void restore(double lost_load_Ns) const {
    const double new_load_Ns = loadOfNew_Ns();
    const double share = new_load_Ns > 0 ? std::clamp(lost_load_Ns / new_load_Ns, 0.0, 1.0) : 0;
    std::size_t next = 0;
    for (std::size_t m = 0; m < manifolds_.size(); ++m)
      for (int i = 0; i < manifolds_[m]->getNumContacts(); ++i) {
        btManifoldPoint& point = manifolds_[m]->getContactPoint(i);
        const btManifoldPoint* had = i < counts_[m] ? &points_[next++] : nullptr;
        point.m_lifeTime = had ? had->m_lifeTime : 0;
        set(point, isNew(had) ? point : *had, isNew(had) ? toBt(share) : 1);
      }
  }

 private:
  static bool isNew(const btManifoldPoint* had) { return !had || had->m_lifeTime == 0; }
  [[nodiscard]] double loadOfNew_Ns() const {
    double sum_Ns = 0;
    std::size_t next = 0;
    for (std::size_t m = 0; m < manifolds_.size(); ++m)
      for (int i = 0; i < manifolds_[m]->getNumContacts(); ++i)
        if (isNew(i < counts_[m] ? &points_[next++] : nullptr))
          sum_Ns += manifolds_[m]->getContactPoint(i).m_appliedImpulse;
    return sum_Ns;
  }
  static void set(btManifoldPoint& point, const btManifoldPoint& from, btScalar share) {
    point.m_appliedImpulse = share * from.m_appliedImpulse;
    point.m_appliedImpulseLateral1 = share * from.m_appliedImpulseLateral1;
    point.m_appliedImpulseLateral2 = share * from.m_appliedImpulseLateral2;
  }

  std::span<btPersistentManifold* const> manifolds_;
  std::vector<int> counts_;
  std::vector<btManifoldPoint> points_;
};

// Writes the gaps of the solved contacts into their manifold points as distances, since Bullet's solvers know
// no rest gap and predict the end of the step to first order only.
void writeDistances(const RelativeMotion& motion, std::span<const RigidContact> contacts) {
  for (const RigidContact& c : contacts) {
    if (bounces(*c.point)) continue;
    const double approach_m = -c.normal_W().dot(motion.velocityAt(c.position_W())) * motion.dt_s;
    c.point->m_distance1 = toBt(c.gap_m);
    if (meetsWithBounce(c.restitution, c.gap_m, c.gap_m - approach_m, motion.dt_s)) setBounces(*c.point);
  }
}

}  // namespace

bool isCheckedBySolver(const PairView& pair, const PairState& state) {
  return state.context->penalty_contacts->hasSolver() &&
         std::all_of(pair.wrapper, pair.wrapper + 2,
                     [](const btCollisionObjectWrapper* w) { return isTaken(*w->getCollisionObject()); });
}

bool isSurelyChecked(const PairView& pair, const PairState& state) {
  return isCheckedBySolver(pair, state) && !state.context->penalty_contacts->hasLeftIslands() &&
         std::all_of(pair.wrapper, pair.wrapper + 2, [](const btCollisionObjectWrapper* w) {
           return w->getCollisionObject()->hasContactResponse() &&
                  !w->getCollisionObject()->hasAnisotropicFriction();
         });
}

bool checksAlone(const PairView& pair, const PairState& state) {
  const auto any = [&](auto&& is) {
    return std::any_of(pair.wrapper, pair.wrapper + 2,
                       [&](const btCollisionObjectWrapper* w) { return is(*w->getCollisionObject()); });
  };
  return !isCheckedBySolver(pair, state) && any(isMoved) && !any([](const btCollisionObject& object) {
    return btMultiBodyLinkCollider::upcast(&object) || object.hasAnisotropicFriction();
  });
}

void addMissedAlone(btDispatcher& dispatcher, const PairView& pair, PairState& state) {
  const double dt_s = state.motion.dt_s;
  if (!state.check || !(dt_s > 0) || !checksAlone(pair, state) ||
      !dispatcher.needsResponse(pair.wrapper[0]->getCollisionObject(), pair.wrapper[1]->getCollisionObject()))
    return;
  const double way_m = state.motion.contact_margin_m + state.motion.speed_m_s * dt_s;
  if (state.contacts.empty() && pair.leastDistance_m() > way_m) return;
  if (!state.loop) state.loop = std::make_unique<ContactLoop>();
  ContactLoop& loop = *state.loop;
  btContactSolverInfo info;
  info.m_timeStep = toBt(dt_s);
  info.m_linearSlop = 0;
  const Impulses before(state.writer->manifolds());
  placeBodies(pair, info, loop.island);
  loop.contacts.clear();
  for (btPersistentManifold* manifold : state.writer->manifolds())
    for (int i = 0; i < manifold->getNumContacts(); ++i)
      loop.contacts.add(*manifold, manifold->getContactPoint(i), info);
  loop.checks.assign(1, state.check.get());
  SolverSettings settings;  // end poses are accurate to a hundredth of the overlap that a check tolerates
  settings.residual_m_s = 0.01 * kToleratedShare * state.motion.contact_margin_m / dt_s;
  // Rows are not computed again (is_own is false), since the motion of the pair alone is not that of the
  // world.
  loop.run(info, settings.iteration_limit, false, [&] { return loop.solveContacts(settings); });
  loop.contacts.finish();
  before.restore(state.writer->lostLoad_Ns());
  writeDistances(state.motion, loop.contacts.contacts());
}

}  // namespace vps::bullet
