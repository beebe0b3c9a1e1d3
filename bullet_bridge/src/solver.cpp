// SPDX-License-Identifier: BSD-3-Clause
// One step's velocities u of an island satisfy
//
//     (M + J' D J) u = M u0 + J' c + sum of contact impulses        (J, c, D: the couplings' linear laws)
//
// so a coupling is nothing but more effective mass and a constant push: M_eff = M + J' D J, a 6x6 matrix for
// each body. Contacts are then solved by projected Gauss-Seidel with M_eff. Solved beside them as one more
// row block, a stiff coupling on a light part converges like (1 - 1 / (1 + A D)): 20 kN/m on 1 g at 1 kHz
// needs hundreds of iterations.
//
// Contacts: Signorini in the normal direction (gap at the end of the step >= 0), Coulomb's cone (not a
// pyramid) in the tangent plane. Overlap is pushed out afterwards in a second, frictionless solve whose
// velocities move the bodies once and are forgotten, so that no energy enters (split impulse). Sources: Catto
// 2005 (sequential impulses); Jourdan, Alart and Jean 1998 (Gauss-Seidel for frictional contact); Todorov
// 2014 and Castro et al. 2021 for implicit springs as effective mass.
#include "vps_bullet/solver.h"

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "cross_matrix.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/coupling.h"

namespace vps {

namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;  // angular, then linear, at the body's centre, in W
using Mat6 = Eigen::Matrix<double, 6, 6>;

Vec6 stacked(const Vec3& w, const Vec3& v) {
  Vec6 u;
  u << w, v;
  return u;
}

struct Body {
  btRigidBody* body = nullptr;
  Mat6 mass = Mat6::Zero();      // M, then M_eff
  Mat6 inverse = Mat6::Zero();   // of M_eff
  Vec6 momentum = Vec6::Zero();  // M u0 with external forces
  Vec6 drive = Vec6::Zero();     // J' c of its couplings
  Vec6 u = Vec6::Zero();         // velocity
  Vec6 push = Vec6::Zero();      // velocity that only moves it, for one step
};

struct Side {
  int body = -1;          // -1: not moved by contact
  Vec6 J = Vec6::Zero();  // so that J . u is the velocity along the row's direction
  Vec6 MinvJ = Vec6::Zero();
};

struct Row {
  Side side[2];
  double fixed_velocity = 0;  // of a kinematic partner, along the direction
  double W = 0;               // J M_eff^-1 J'
};

struct ContactRows {
  btManifoldPoint* point = nullptr;
  Row normal, tangent[2];
  double target_m_s = 0;  // least normal velocity
  double gap_m = 0;
  double mu = 0;
  double p_n = 0, p_t[2] = {0, 0}, p_push = 0;
  double W_t_inverse[3] = {0, 0, 0};  // of the 2x2 tangent block: 11, 12, 22
  double W_t = 0;                     // its greatest eigenvalue
};

}  // namespace

struct VpsSolver::Work {
  std::vector<Body> bodies;
  std::vector<ContactRows> contacts;
  std::vector<VpsCoupling*> couplings;

  int indexOf(const btCollisionObject* object) const {
    for (std::size_t i = 0; i < bodies.size(); ++i)
      if (bodies[i].body == object) return static_cast<int>(i);
    return -1;
  }

  void addBody(btRigidBody& rigid, double dt_s);
  void addContact(btPersistentManifold& manifold, btManifoldPoint& point, const btContactSolverInfo& info);
  Row makeRow(const btCollisionObject* a, const btCollisionObject* b, const btManifoldPoint& point,
              const Vec3& d) const;
  void prepareRow(Row& row) const;
  void prepareMass();
  void startVelocities();
  double iterate();
  void solvePush(const btContactSolverInfo& info, const VpsSolverSettings& settings);
  void finish(double dt_s);

  double velocity(const Row& row) const {
    double v = row.fixed_velocity;
    for (const Side& side : row.side)
      if (side.body >= 0) v += side.J.dot(bodies[static_cast<std::size_t>(side.body)].u);
    return v;
  }
  void apply(const Row& row, double impulse) {
    for (const Side& side : row.side)
      if (side.body >= 0) bodies[static_cast<std::size_t>(side.body)].u += impulse * side.MinvJ;
  }
};

namespace {

// What initSolverBody and convertBodies of the stock solver take as external: forces, torques, gyroscopic
// terms.
Vec6 externalVelocity(const btRigidBody& b, double dt_s) {
  Vec3 w = fromBt(b.getInvInertiaTensorWorld() * b.getTotalTorque()) * dt_s;
  const Vec3 v = fromBt(b.getTotalForce()) * b.getInvMass() * dt_s;
  const int flags = b.getFlags();
  const btScalar dt = toBt(dt_s);
  if (flags & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY)
    w += fromBt(b.computeGyroscopicImpulseImplicit_Body(dt));
  else if (flags & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD)
    w += fromBt(b.computeGyroscopicImpulseImplicit_World(dt));
  else if (flags & BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT)
    w -= fromBt(b.getInvInertiaTensorWorld() * b.computeGyroscopicForceExplicit(100)) * dt_s;
  return stacked(w, v);
}

bool hasUnitFactors(const btRigidBody& b) {
  const btVector3 one(1, 1, 1);
  return b.getLinearFactor() == one && b.getAngularFactor() == one;
}

// No point of the body is farther than this from its origin.
double reach_m(const btRigidBody& b) {
  btVector3 center;
  btScalar radius_m = 0;
  b.getCollisionShape()->getBoundingSphere(center, radius_m);
  return center.length() + radius_m;
}

bool isPlain(const btManifoldPoint& point) {
  constexpr int kSoft = BT_CONTACT_FLAG_HAS_CONTACT_CFM | BT_CONTACT_FLAG_HAS_CONTACT_ERP |
                        BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING | BT_CONTACT_FLAG_FRICTION_ANCHOR;
  return !(point.m_contactPointFlags & kSoft) && !(point.m_combinedRollingFriction > 0) &&
         !(point.m_combinedSpinningFriction > 0);
}

}  // namespace

void VpsSolver::Work::addBody(btRigidBody& rigid, double dt_s) {
  Body b;
  b.body = &rigid;
  const Mat3 I_inv = fromBt(rigid.getInvInertiaTensorWorld());
  b.mass.topLeftCorner<3, 3>() = I_inv.inverse();
  b.mass.bottomRightCorner<3, 3>() = Mat3::Identity() / rigid.getInvMass();
  const Vec6 u0 = stacked(fromBt(rigid.getAngularVelocity()), fromBt(rigid.getLinearVelocity())) +
                  externalVelocity(rigid, dt_s);
  b.momentum = b.mass * u0;
  bodies.push_back(b);
}

Row VpsSolver::Work::makeRow(const btCollisionObject* a, const btCollisionObject* b,
                             const btManifoldPoint& point, const Vec3& d) const {
  Row row;
  const btCollisionObject* objects[2] = {a, b};
  // Both at the middle of the gap: two forces in one line keep the angular momentum.
  const btVector3 at = (point.getPositionWorldOnA() + point.getPositionWorldOnB()) * btScalar(0.5);
  for (int i = 0; i < 2; ++i) {
    const Vec3 r = fromBt(at - objects[i]->getWorldTransform().getOrigin());
    const Vec3 direction = i == 0 ? d : Vec3(-d);
    row.side[i].body = indexOf(objects[i]);
    row.side[i].J = stacked(r.cross(direction), direction);
    const btRigidBody* rigid = btRigidBody::upcast(objects[i]);
    if (row.side[i].body < 0 && rigid)
      row.fixed_velocity +=
          row.side[i].J.dot(stacked(fromBt(rigid->getAngularVelocity()), fromBt(rigid->getLinearVelocity())));
  }
  return row;
}

void VpsSolver::Work::prepareRow(Row& row) const {
  row.W = 0;
  for (Side& side : row.side) {
    if (side.body < 0) continue;
    side.MinvJ = bodies[static_cast<std::size_t>(side.body)].inverse * side.J;
    row.W += side.J.dot(side.MinvJ);
  }
}

void VpsSolver::Work::addContact(btPersistentManifold& manifold, btManifoldPoint& point,
                                 const btContactSolverInfo& info) {
  const btCollisionObject *a = manifold.getBody0(), *b = manifold.getBody1();
  ContactRows c;
  c.point = &point;
  c.mu = point.m_combinedFriction;
  c.gap_m = point.getDistance() + info.m_linearSlop;
  const Vec3 n = fromBt(point.m_normalWorldOnB);
  if (n.isZero(0)) return;  // a contact without a direction has nothing to act along
  if (!(point.m_contactPointFlags & BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED)) {
    btPlaneSpace1(point.m_normalWorldOnB, point.m_lateralFrictionDir1, point.m_lateralFrictionDir2);
    point.m_appliedImpulseLateral1 = point.m_appliedImpulseLateral2 = 0;
  }
  c.normal = makeRow(a, b, point, n);
  c.tangent[0] = makeRow(a, b, point, fromBt(point.m_lateralFrictionDir1));
  c.tangent[1] = makeRow(a, b, point, fromBt(point.m_lateralFrictionDir2));
  if (c.normal.side[0].body < 0 && c.normal.side[1].body < 0) return;

  if (c.gap_m > 0) {
    c.target_m_s = -c.gap_m / info.m_timeStep;
  } else {
    double approach_m_s = -c.normal.fixed_velocity;
    for (const Side& side : c.normal.side) {
      if (side.body < 0) continue;
      const btRigidBody& rigid = *bodies[static_cast<std::size_t>(side.body)].body;
      approach_m_s -=
          side.J.dot(stacked(fromBt(rigid.getAngularVelocity()), fromBt(rigid.getLinearVelocity())));
    }
    if (approach_m_s > info.m_restitutionVelocityThreshold)
      c.target_m_s = point.m_combinedRestitution * approach_m_s;
  }
  if (info.m_solverMode & SOLVER_USE_WARMSTARTING) {
    c.p_n = std::max<double>(0, point.m_appliedImpulse);
    c.p_t[0] = point.m_appliedImpulseLateral1;
    c.p_t[1] = point.m_appliedImpulseLateral2;
  }
  contacts.push_back(c);
}

// Puts the couplings' laws, as they stand, into the bodies' effective mass and drive.
void VpsSolver::Work::prepareMass() {
  for (Body& b : bodies) b.inverse = b.mass.llt().solve(Mat6::Identity());
  for (ContactRows& c : contacts) {
    prepareRow(c.normal);
    prepareRow(c.tangent[0]);
    prepareRow(c.tangent[1]);
    double w12 = 0;
    for (int i = 0; i < 2; ++i)
      if (c.tangent[0].side[i].body >= 0) w12 += c.tangent[0].side[i].J.dot(c.tangent[1].side[i].MinvJ);
    const double w11 = c.tangent[0].W, w22 = c.tangent[1].W, det = w11 * w22 - w12 * w12;
    c.W_t = 0.5 * (w11 + w22) + std::hypot(0.5 * (w11 - w22), w12);
    c.W_t_inverse[0] = w22 / det;
    c.W_t_inverse[1] = -w12 / det;
    c.W_t_inverse[2] = w11 / det;
  }
}

void VpsSolver::Work::startVelocities() {
  for (Body& b : bodies) b.u = b.inverse * (b.momentum + b.drive);
  for (const ContactRows& c : contacts) {
    if (c.p_n != 0) apply(c.normal, c.p_n);
    for (int t = 0; t < 2; ++t)
      if (c.p_t[t] != 0) apply(c.tangent[t], c.p_t[t]);
  }
}

// One sweep. Returns the greatest change of a contact's velocity.
double VpsSolver::Work::iterate() {
  double residual_m_s = 0;
  for (ContactRows& c : contacts) {
    const double p_n = std::max(0.0, c.p_n + (c.target_m_s - velocity(c.normal)) / c.normal.W);
    if (p_n != c.p_n) {
      apply(c.normal, p_n - c.p_n);
      residual_m_s = std::max(residual_m_s, std::abs(p_n - c.p_n) * c.normal.W);
      c.p_n = p_n;
    }
    if (p_n == 0 && c.p_t[0] == 0 && c.p_t[1] == 0) continue;
    const double v1 = velocity(c.tangent[0]), v2 = velocity(c.tangent[1]);
    const double limit = c.mu * p_n;
    double p1 = c.p_t[0] - (c.W_t_inverse[0] * v1 + c.W_t_inverse[1] * v2);
    double p2 = c.p_t[1] - (c.W_t_inverse[1] * v1 + c.W_t_inverse[2] * v2);
    if (std::hypot(p1, p2) > limit) {
      // It slides. The step must be along the slip itself: stepping by the block's inverse and scaling back
      // would settle on friction along W^-1 v, off the slip, and 1 % too weak.
      p1 = c.p_t[0] - v1 / c.W_t;
      p2 = c.p_t[1] - v2 / c.W_t;
      const double size = std::hypot(p1, p2);
      if (size > limit) {
        p1 *= limit / size;
        p2 *= limit / size;
      }
    }
    const double d1 = p1 - c.p_t[0], d2 = p2 - c.p_t[1];
    if (d1 != 0) apply(c.tangent[0], d1);
    if (d2 != 0) apply(c.tangent[1], d2);
    c.p_t[0] = p1;
    c.p_t[1] = p2;
    residual_m_s =
        std::max(residual_m_s, std::max(std::abs(d1) * c.tangent[0].W, std::abs(d2) * c.tangent[1].W));
  }
  return residual_m_s;
}

// The overlap that is left at the end of the step is pushed out by a share, without leaving velocity behind.
void VpsSolver::Work::solvePush(const btContactSolverInfo& info, const VpsSolverSettings& settings) {
  constexpr double kMostPush_m_s = 0.05;  // assumed: parts that start inside each other separate gently
  constexpr double kNothing_m = 1e-9;
  const double dt = info.m_timeStep;
  bool is_needed = false;
  for (ContactRows& c : contacts) {
    const double left_m = c.gap_m + velocity(c.normal) * dt;
    is_needed |= left_m < -kNothing_m;
    c.target_m_s = left_m < 0 ? std::min(-info.m_erp2 * left_m / dt, kMostPush_m_s) : -left_m / dt;
    c.p_push = 0;
  }
  if (!is_needed) return;
  for (Body& b : bodies) std::swap(b.u, b.push);
  for (int i = 0; i < settings.iteration_limit; ++i) {
    double residual_m_s = 0;
    for (ContactRows& c : contacts) {
      double v = 0;  // the partner's own motion is no part of the push
      for (const Side& side : c.normal.side)
        if (side.body >= 0) v += side.J.dot(bodies[static_cast<std::size_t>(side.body)].u);
      const double p = std::max(0.0, c.p_push + (c.target_m_s - v) / c.normal.W);
      if (p == c.p_push) continue;
      apply(c.normal, p - c.p_push);
      residual_m_s = std::max(residual_m_s, std::abs(p - c.p_push) * c.normal.W);
      c.p_push = p;
    }
    // 1e-5 m/s for a step of 1 ms is 10 nm.
    if (residual_m_s < 1e-5) break;
  }
  for (Body& b : bodies) {
    std::swap(b.u, b.push);
    // Each row's push is limited already, but rows that contradict each other add up.
    const double fastest_m_s = b.push.tail<3>().norm() + b.push.head<3>().norm() * reach_m(*b.body);
    if (fastest_m_s > kMostPush_m_s) b.push *= kMostPush_m_s / fastest_m_s;
  }
}

void VpsSolver::Work::finish(double dt_s) {
  for (const ContactRows& c : contacts) {
    c.point->m_appliedImpulse = toBt(c.p_n);
    c.point->m_appliedImpulseLateral1 = toBt(c.p_t[0]);
    c.point->m_appliedImpulseLateral2 = toBt(c.p_t[1]);
  }
  for (Body& b : bodies) {
    b.body->setAngularVelocity(toBt(Vec3(b.u.head<3>())));
    b.body->setLinearVelocity(toBt(Vec3(b.u.tail<3>())));
    if (b.push.isZero(0)) continue;
    btTransform moved;
    btTransformUtil::integrateTransform(b.body->getWorldTransform(), toBt(Vec3(b.push.tail<3>())),
                                        toBt(Vec3(b.push.head<3>())), toBt(dt_s), moved);
    b.body->setWorldTransform(moved);
  }
}

VpsSolver::VpsSolver(const VpsSolverSettings& settings)
    : settings_(settings), work_(std::make_unique<Work>()) {}
VpsSolver::~VpsSolver() = default;

bool VpsSolver::gather(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                       int manifold_count, btTypedConstraint** constraints, int constraint_count,
                       const btContactSolverInfo& info) {
  work_->bodies.clear();
  work_->contacts.clear();
  work_->couplings.clear();
  for (int i = 0; i < constraint_count; ++i) {
    if (!constraints[i]->isEnabled()) continue;
    auto* coupling = dynamic_cast<VpsCoupling*>(constraints[i]);
    if (!coupling) return false;
    work_->couplings.push_back(coupling);
  }
  for (int i = 0; i < body_count; ++i) {
    btRigidBody* rigid = btRigidBody::upcast(bodies[i]);
    if (!rigid || !hasUnitFactors(*rigid)) return false;
    if (rigid->getInvMass() > 0 && !rigid->isKinematicObject()) work_->addBody(*rigid, info.m_timeStep);
  }
  for (int m = 0; m < manifold_count; ++m)
    for (int i = 0; i < manifolds[m]->getNumContacts(); ++i) {
      btManifoldPoint& point = manifolds[m]->getContactPoint(i);
      if (!isPlain(point)) return false;
      if (point.getDistance() <= manifolds[m]->getContactProcessingThreshold())
        work_->addContact(*manifolds[m], point, info);
    }
  return true;
}

btScalar VpsSolver::solveGroup(btCollisionObject** bodies, int body_count, btPersistentManifold** manifolds,
                               int manifold_count, btTypedConstraint** constraints, int constraint_count,
                               const btContactSolverInfo& info, btIDebugDraw* draw,
                               btDispatcher* dispatcher) {
  if (!gather(bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info))
    return btSequentialImpulseConstraintSolver::solveGroup(
        bodies, body_count, manifolds, manifold_count, constraints, constraint_count, info, draw, dispatcher);
  Work& work = *work_;
  if (work.bodies.empty()) return 0;  // Bullet ends each step with a call for nothing
  const double dt_s = info.m_timeStep;

  struct Held {
    VpsCoupling* coupling;
    Body* body;
    Mat6 J;  // body's twist -> grasp point's
    VpsCoupling::Law law;
  };
  std::vector<Held> held;
  for (VpsCoupling* coupling : work.couplings) {
    coupling->buildJacobian();
    coupling->step_ = coupling->makeStep(dt_s);
    const int index = work.indexOf(&coupling->part_);
    if (coupling->step_.is_open || index < 0) continue;
    Held h{coupling, &work.bodies[static_cast<std::size_t>(index)], Mat6::Identity(), {}};
    h.J.bottomLeftCorner<3, 3>() = -crossMatrix(coupling->step_.r_W);
    h.law = coupling->lawAt(coupling->step_, Vec6::Zero(), true);
    held.push_back(h);
  }

  // A spring at its limit makes its law depend on the answer: solve, look, and solve again where it changed.
  constexpr int kRounds = 6;  // assumed; the limit's direction settles in two or three
  iterations_used_ = 0;
  std::vector<Mat6> plain;
  for (const Body& b : work.bodies) plain.push_back(b.mass);
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < work.bodies.size(); ++i) {
      work.bodies[i].mass = plain[i];
      work.bodies[i].drive.setZero();
    }
    for (const Held& h : held) {
      h.body->mass += h.J.transpose() * h.law.D.asDiagonal() * h.J;
      h.body->drive += h.J.transpose() * h.law.c;
    }
    work.prepareMass();
    work.startVelocities();
    int used = 0;
    while (used < settings_.iteration_limit && work.iterate() > settings_.residual_m_s) ++used;
    iterations_used_ = std::max(iterations_used_, used);

    if (round == kRounds - 1) break;  // unsettled: the laws stay those that u was solved with
    bool is_settled = true;
    for (Held& h : held) {
      const VpsCoupling::Law law = h.coupling->lawAt(h.coupling->step_, h.J * h.body->u);
      const double change = (law.c - h.law.c).norm();
      if (law.limited != h.law.limited || change > 1e-6 * law.c.norm()) is_settled = false;
      if (!is_settled) h.law = law;
    }
    if (is_settled) break;
  }
  for (const Held& h : held) h.coupling->setImpulse(h.law.c - h.law.D.cwiseProduct(h.J * h.body->u), dt_s);
  work.solvePush(info, settings_);
  work.finish(dt_s);
  return 0;
}

}  // namespace vps
