// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/pair/pair_view.h"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <algorithm>
#include <cmath>

#include "vps/contact_tolerances.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/coupling.h"

namespace vps::bullet {

namespace {

// Velocity of a multibody's link about its centre, in W. The joints' reaction to the link's own forces is
// ignored; the error is at most a step of gravity, so that a contact is found early.
Twist linkVelocity(const btMultiBodyLinkCollider& collider, double dt_s) {
  const btMultiBody& multi = *collider.m_multiBody;
  const int link = collider.m_link;
  Twist V;
  if (link < 0) {
    V.w = fromBt(multi.getBaseOmega());
    V.v = fromBt(multi.getBaseVel());
    if (!multi.hasFixedBase() && multi.getBaseMass() > 0)
      V.v += dt_s / multi.getBaseMass() * fromBt(multi.getBaseForce());
    return V;
  }
  thread_local btAlignedObjectArray<btVector3> w, v;  // velocities of base and links, each in its own frame
  w.resize(multi.getNumLinks() + 1);
  v.resize(multi.getNumLinks() + 1);
  multi.compTreeLinkVelocities(&w[0], &v[0]);
  V.w = fromBt(multi.localDirToWorld(link, w[link + 1]));
  V.v = fromBt(multi.localDirToWorld(link, v[link + 1]));
  if (multi.getLinkMass(link) > 0) V.v += dt_s / multi.getLinkMass(link) * fromBt(multi.getLinkForce(link));
  return V;
}

}  // namespace

Twist predictedVelocity(const btCollisionObject& object, double dt_s, bool with_couplings) {
  Twist V;
  if (const auto* link = btMultiBodyLinkCollider::upcast(&object); link && link->m_multiBody) {
    V = linkVelocity(*link, dt_s);
    V.v -= V.w.cross(fromBt(object.getWorldTransform().getOrigin()));
    return V;
  }
  const btRigidBody* body = btRigidBody::upcast(&object);
  if (!body || body->isStaticObject()) return V;
  V.w = fromBt(body->getAngularVelocity());
  V.v = fromBt(body->getLinearVelocity());
  if (!body->isKinematicObject()) {
    V.v += dt_s * fromBt(body->getTotalForce() * (body->getInvMass() * body->getLinearFactor()));
    V.w += dt_s * fromBt(body->getInvInertiaTensorWorld() * body->getTotalTorque());
    // A body's reference list holds the constraints added with world.addConstraint(coupling, true).
    for (int i = 0; with_couplings && i < const_cast<btRigidBody*>(body)->getNumConstraintRefs(); ++i) {
      const auto* coupling =
          dynamic_cast<const CouplingConstraint*>(const_cast<btRigidBody*>(body)->getConstraintRef(i));
      if (coupling && coupling->isEnabled()) {
        const Twist pull = coupling->freeVelocity(dt_s);
        V.w += pull.w;
        V.v += pull.v;
      }
    }
  }
  V.v -= V.w.cross(fromBt(object.getWorldTransform().getOrigin()));
  return V;
}

Pose displacement(const btCollisionObject& object, const Twist& V, double t_s) {
  const Vec3 center = fromBt(object.getWorldTransform().getOrigin());
  const Mat3 R = rotationFromVector(V.w * t_s);
  return {R, center + (V.v + V.w.cross(center)) * t_s - R * center};
}

Twist presentVelocity(const PairView& pair) {
  const Twist V0 = predictedVelocity(*pair.wrapper[0]->getCollisionObject(), 0, false);
  const Twist V1 = predictedVelocity(*pair.wrapper[1]->getCollisionObject(), 0, false);
  return {V0.w - V1.w, V0.v - V1.v};
}

RelativeMotion relativeMotion(const PairView& pair, double dt_s, double contact_margin_m, bool is_held) {
  RelativeMotion motion;
  motion.dt_s = dt_s;
  motion.contact_margin_m = contact_margin_m;
  if (!(dt_s > 0)) return motion;
  const auto relative = [&](bool with_couplings) {
    const Twist V0 = predictedVelocity(*pair.wrapper[0]->getCollisionObject(), dt_s, with_couplings);
    const Twist V1 = predictedVelocity(*pair.wrapper[1]->getCollisionObject(), dt_s, with_couplings);
    return Twist{V0.w - V1.w, V0.v - V1.v};
  };
  const auto greatestSpeed = [&](const Twist& V) {
    return (V.v + V.w.cross(pair.center_W())).norm() + V.w.norm() * pair.radius_m();
  };
  motion.V = relative(true);
  motion.speed_m_s = greatestSpeed(motion.V);
  const Twist own = relative(false);
  motion.own_speed_m_s = greatestSpeed(own);
  const double range_m_s = (queryRange_m(pair) - contact_margin_m) / dt_s;
  if (!is_held || motion.speed_m_s <= range_m_s || motion.own_speed_m_s >= range_m_s) return motion;
  // Contact resists the couplings' pull, so the search does not cover the whole free motion.
  const Twist pull{motion.V.w - own.w, motion.V.v - own.v};
  const double left_m_s = range_m_s - motion.own_speed_m_s;
  motion.pull_share = left_m_s / std::max(greatestSpeed(pull), left_m_s);
  motion.V = {own.w + motion.pull_share * pull.w, own.v + motion.pull_share * pull.v};
  motion.speed_m_s = greatestSpeed(motion.V);
  return motion;
}

double queryRange_m(const PairView& pair) {
  double range_m = 1e30;
  for (const Shape* shape : pair.shape)
    if (shape && shape->models().map) range_m = std::min(range_m, 0.95 * shape->models().map->band_m());
  return range_m;
}

double fieldError_m(const PairView& pair, const Candidate& c) {
  if (c.isCrossing()) return 0;
  return (pair.shape[c.side]->isEdgePoint(c.id) ? kEdgeError_voxels : kFaceError_voxels) *
         pair.voxel_m(1 - c.side);
}

double fieldError_m(const PairView& pair) {
  return kEdgeError_voxels * std::max(pair.voxel_m(0), pair.voxel_m(1));
}

bool queriesPoints(const PairView& pair, int i, Sides sides) {
  if (!pair.hasShell(i)) return false;
  if (sides == Sides::Both || !pair.isTwoSided()) return true;
  const bool is_first = pair.shape[0]->bounds().size().norm() <= pair.shape[1]->bounds().size().norm();
  return i == (is_first ? 0 : 1);
}

int sideCount(const PairView& pair, Sides sides) {
  return sides == Sides::Both && pair.isTwoSided() ? 2 : 1;
}

void advance(PairView& pair, const PairView& start, double dt_s, double t_s) {
  for (int i = 0; i < 2; ++i) {
    const btCollisionObject& object = *pair.wrapper[i]->getCollisionObject();
    pair.X_WS[i] = displacement(object, predictedVelocity(object, dt_s), t_s) * start.X_WS[i];
  }
}

void coast(const PairView& pair, double dt_s, Pose (&way)[2]) {
  for (int i = 0; i < 2; ++i) {
    const btCollisionObject& object = *pair.wrapper[i]->getCollisionObject();
    way[i] = displacement(object, predictedVelocity(object, 0, false), dt_s);
  }
}

namespace {

const Shape* shapeWithMaterials(const btCollisionObjectWrapper& wrapper) {
  const auto* shape = dynamic_cast<const Shape*>(wrapper.getCollisionShape());
  if (!shape) return nullptr;
  const bool is_any = std::ranges::any_of(shape->models().surfaces,
                                          [](const Surface& surface) { return !surface.material.isNone(); });
  return is_any ? shape : nullptr;
}

// Limits friction as btManifoldResult::calculateCombinedFriction() does.
constexpr double kMostFriction = 10;
double limitedFriction(double product) {
  return std::clamp(product, -kMostFriction, kMostFriction);
}
// install() asks a host's friction model for a few values only. The solver gets the coefficient at rest in
// place of a value that is not finite, and 0 in place of a negative value.
double usableFriction(double of_model, double at_rest) {
  return std::isfinite(of_model) ? std::clamp(of_model, 0.0, kMostFriction) : at_rest;
}

}  // namespace

PairMaterial::PairMaterial(const btCollisionObjectWrapper* const (&bodies)[2],
                           const FrictionModel& friction_model)
    : object_{bodies[0]->getCollisionObject(), bodies[1]->getCollisionObject()},
      shape_{shapeWithMaterials(*bodies[0]), shapeWithMaterials(*bodies[1])},
      friction_(gCalculateCombinedFrictionCallback(object_[0], object_[1])),
      restitution_(gCalculateCombinedRestitutionCallback(object_[0], object_[1])),
      coefficient_(friction_model.coefficient) {}

const SurfaceMaterial& PairMaterial::at(const Candidate& c, int i) const {
  static constexpr SurfaceMaterial kNone{};
  if (!shape_[i]) return kNone;
  const std::vector<Surface>& surfaces = shape_[i]->models().surfaces;
  return c.surface[i] < surfaces.size() ? surfaces[c.surface[i]].material : kNone;
}

double PairMaterial::friction(const Candidate& c, const RelativeMotion& motion) const {
  const double mu = frictionAtRest(c);
  if (!coefficient_) return mu;
  const Vec3 v = motion.V_start.v + motion.V_start.w.cross(c.p_W);
  return usableFriction(coefficient_(mu, (v - c.n_W.dot(v) * c.n_W).norm()), mu);
}

double PairMaterial::frictionAtRest(const Candidate& c) const {
  const SurfaceMaterial &a = at(c, 0), &b = at(c, 1);
  const bool is_hosts = gCalculateCombinedFrictionCallback != &btManifoldResult::calculateCombinedFriction;
  if (is_hosts || (!a.friction && !b.friction)) return friction_;
  return limitedFriction(a.friction.value_or(object_[0]->getFriction()) *
                         b.friction.value_or(object_[1]->getFriction()));
}

double PairMaterial::restitution(const Candidate& c) const {
  const SurfaceMaterial &a = at(c, 0), &b = at(c, 1);
  const bool is_hosts =
      gCalculateCombinedRestitutionCallback != &btManifoldResult::calculateCombinedRestitution;
  if (is_hosts || (!a.restitution && !b.restitution)) return restitution_;
  return a.restitution.value_or(object_[0]->getRestitution()) *
         b.restitution.value_or(object_[1]->getRestitution());
}

double PairMaterial::stiffness_N_per_m3(const Candidate& c, double usual_N_per_m3) const {
  return std::min(at(c, 0).stiffness_N_per_m3.value_or(usual_N_per_m3),
                  at(c, 1).stiffness_N_per_m3.value_or(usual_N_per_m3));
}

}  // namespace vps::bullet
