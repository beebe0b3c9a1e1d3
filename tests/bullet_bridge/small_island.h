// SPDX-License-Identifier: BSD-3-Clause
// A few bodies with given contacts, as input of a solver, and the laws that the solver's result must obey.
#pragma once

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "solver/rigid/contact_sweeps.h"
#include "support/random_draw.h"
#include "vps_bullet/convert.h"

namespace vps::bullet::test_island {

/// Greatest relative rounding error of a number in Bullet's precision.
constexpr double kRounding = std::numeric_limits<btScalar>::epsilon() / 2;
constexpr double kDt_s = btScalar(1e-3);  // rounded as the engine stores it

/// A contact as given to the solver, rounded to Bullet's precision. Solvers compute with doubles, so they
/// must solve the rounded problem accurately.
struct GivenContact {
  const btRigidBody* body[2];
  Vec3 p_W, n_W;  ///< n from body 1 to body 0
  double gap_m = 0, mu = 0;
};

class SmallIsland {
 public:
  SmallIsland() {
    info.m_timeStep = toBt(kDt_s);
    info.m_linearSlop = 0;
  }
  SmallIsland(const SmallIsland&) = delete;
  SmallIsland& operator=(const SmallIsland&) = delete;

  btRigidBody& add(double mass_kg, const Vec3& center_W, const Vec3& v_W, const Vec3& w_W = Vec3::Zero(),
                   const Mat3& R = Mat3::Identity()) {
    btVector3 inertia;
    shape.calculateLocalInertia(toBt(mass_kg), inertia);
    btRigidBody& body = bodies.emplace_back(
        btRigidBody::btRigidBodyConstructionInfo(toBt(mass_kg), nullptr, &shape, inertia));
    body.setWorldTransform(toBt(Pose(R, center_W)));
    body.updateInertiaTensor();
    body.setLinearVelocity(toBt(v_W));
    body.setAngularVelocity(toBt(w_W));
    return body;
  }
  /// A contact pushes body 0 along n.
  void touch(btRigidBody& body0, btRigidBody& body1, const Vec3& p_W, const Vec3& n_W, double gap_m,
             double mu) {
    btPersistentManifold& manifold = manifolds.emplace_back(&body0, &body1, 0, 1e-3, 1e-3);
    btManifoldPoint point(btVector3(0, 0, 0), btVector3(0, 0, 0), toBt(n_W), toBt(gap_m));
    point.m_positionWorldOnA = point.m_positionWorldOnB = toBt(p_W);
    point.m_combinedFriction = toBt(mu);
    manifold.addManifoldPoint(point);
    given.push_back({{&body0, &body1},
                     fromBt(point.m_positionWorldOnA),
                     fromBt(point.m_normalWorldOnB),
                     point.getDistance(),
                     point.m_combinedFriction});
  }
  void start() {
    for (btRigidBody& body : bodies) island.add(body, kDt_s);
    for (IslandBody& b : island.bodies) {
      b.effective_mass = b.mass;
      b.effective_inverse = b.mass.inverse();
      b.u = b.effective_inverse * b.momentum;
      free.push_back(b.u);
    }
    for (btPersistentManifold& manifold : manifolds) sweeps.add(manifold, manifold.getContactPoint(0), info);
    sweeps.start();
  }

  /// Twist of a body about its centre; zero for a fixed one.
  [[nodiscard]] Vec6 twistOf(const btRigidBody* body, const std::vector<Vec6>& u) const {
    for (std::size_t i = 0; i < island.bodies.size(); ++i)
      if (island.bodies[i].rigid == body) return u[i];
    return Vec6::Zero();
  }
  [[nodiscard]] std::vector<Vec6> solved() const {
    std::vector<Vec6> u;
    for (const IslandBody& b : island.bodies) u.push_back(b.u);
    return u;
  }
  /// Velocity of body 0 relative to body 1 at the contact.
  [[nodiscard]] Vec3 velocityAt(const GivenContact& c, const std::vector<Vec6>& u) const {
    Vec3 v = Vec3::Zero();
    for (int i = 0; i < 2; ++i) {
      const Vec6 V = twistOf(c.body[i], u);
      const Vec3 r = c.p_W - fromBt(c.body[i]->getWorldTransform().getOrigin());
      v += (i == 0 ? 1 : -1) * (V.tail<3>() + Vec3(V.head<3>()).cross(r));
    }
    return v;
  }
  /// The gap at the end of the step must not be negative, and must not shrink for bodies that overlap.
  [[nodiscard]] static double leastNormalVelocity(const GivenContact& c) {
    return c.gap_m > 0 ? -c.gap_m / kDt_s : 0;
  }
  [[nodiscard]] double energy_J(const std::vector<Vec6>& u) const {
    double sum = 0;
    for (std::size_t i = 0; i < u.size(); ++i) sum += 0.5 * u[i].dot(island.bodies[i].mass * u[i]);
    return sum;
  }
  /// Linear momentum, and angular momentum about the world's origin.
  [[nodiscard]] Vec6 momentum(const std::vector<Vec6>& u) const {
    Vec6 sum = Vec6::Zero();
    for (std::size_t i = 0; i < u.size(); ++i) {
      Vec6 own = island.bodies[i].mass * u[i];
      own.head<3>() +=
          fromBt(island.bodies[i].rigid->getWorldTransform().getOrigin()).cross(Vec3(own.tail<3>()));
      sum += own;
    }
    return sum;
  }

  /// Signorini's condition, Coulomb's cone with friction against the slip, and that the velocities follow
  /// from the impulses, all within `near_m_s`.
  void expectLaws(double near_m_s) {
    const std::vector<Vec6> u = solved();
    std::vector<Vec6> owed;
    for (std::size_t i = 0; i < u.size(); ++i) owed.push_back(island.bodies[i].mass * (u[i] - free[i]));
    ASSERT_EQ(sweeps.contacts().size(), given.size());
    for (std::size_t k = 0; k < given.size(); ++k) {
      const GivenContact& c = given[k];
      const RigidContact& solved_c = sweeps.contacts()[k];
      const Vec3 p_t = solved_c.p_t[0] * solved_c.tangent_W(0) + solved_c.p_t[1] * solved_c.tangent_W(1);
      const Vec3 v = velocityAt(c, u);
      const double excess_m_s = v.dot(c.n_W) - leastNormalVelocity(c);
      EXPECT_GE(solved_c.p_n, 0) << k;
      EXPECT_GE(excess_m_s, -near_m_s) << k;
      // The excess is zero if the contact pushes; the impulse counts as the velocity that it causes.
      EXPECT_LE(std::min(excess_m_s, solved_c.p_n * solved_c.normal.W), near_m_s) << k;
      EXPECT_LE(p_t.norm(), c.mu * solved_c.p_n * (1 + 1e-6) + 1e-15) << k;
      // btPlaneSpace1() computes the tangents in Bullet's precision, with at most six rounding operations.
      EXPECT_NEAR(p_t.dot(c.n_W), 0, std::max(1e-12, 8 * kRounding * p_t.norm())) << k;
      const Vec3 slip = v - v.dot(c.n_W) * c.n_W;
      const Vec3 wanted = -c.mu * solved_c.p_n * slip.normalized();
      if (slip.norm() > 100 * near_m_s) {
        EXPECT_LE((p_t - wanted).norm(), 0.02 * c.mu * solved_c.p_n + near_m_s / solved_c.normal.W)
            << k << " slips by " << slip.norm();
      }
      for (int i = 0; i < 2; ++i)
        for (std::size_t b = 0; b < u.size(); ++b) {
          if (island.bodies[b].rigid != c.body[i]) continue;
          const Vec3 p = (i == 0 ? 1 : -1) * (solved_c.p_n * c.n_W + p_t);
          const Vec3 r = c.p_W - fromBt(c.body[i]->getWorldTransform().getOrigin());
          owed[b] -= stacked(r.cross(p), p);
        }
    }
    for (std::size_t b = 0; b < u.size(); ++b)
      EXPECT_LE((island.bodies[b].effective_inverse * owed[b]).norm(), 1e3 * near_m_s) << "body " << b;
  }

  btBoxShape shape{btVector3(toBt(5e-3), toBt(5e-3), toBt(5e-3))};
  std::deque<btRigidBody> bodies;
  std::deque<btPersistentManifold> manifolds;
  btRigidBody floor{btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &shape, btVector3(0, 0, 0))};
  Island island;
  JointRows joints;
  ContactSweeps sweeps{island, joints};
  btContactSolverInfo info;
  std::vector<GivenContact> given;
  std::vector<Vec6> free;  ///< velocities without contact
};

/// Three bodies of different masses with two contacts each, the first with the floor, normals in any
/// direction. The state of rest obeys all contacts, so a solution exists.
inline void makeRandom(SmallIsland& made, std::uint64_t seed, double mu) {
  test::Random random(seed);
  for (int k = 0; k < 3; ++k)
    made.add(random.logUniform(0.005, 0.5), random.inBox(Vec3::Constant(0.02)),
             random.inBox(Vec3::Constant(1)), random.inBox(Vec3::Constant(50)), random.rotation());
  for (std::size_t k = 0; k < 3; ++k)
    for (int i = 0; i < 2; ++i) {
      btRigidBody& own = made.bodies[k];
      btRigidBody& other = k == 0 ? made.floor : made.bodies[k - 1];
      const Vec3 at = fromBt(own.getWorldTransform().getOrigin()) + 5e-3 * random.direction();
      const double gap_m = random.chance(0.5) ? 0 : random.uniform(-1e-6, 200e-6);
      if (random.chance(0.5))
        made.touch(own, other, at, random.direction(), gap_m, mu);
      else
        made.touch(other, own, at, random.direction(), gap_m, mu);
    }
  made.start();
}

/// The velocities nearest to the free ones, by kinetic energy, that obey all contacts without friction: tries
/// each set of contacts that may push.
inline std::vector<Vec6> bruteForce(const SmallIsland& made) {
  const auto n = static_cast<Eigen::Index>(made.given.size()),
             m = 6 * static_cast<Eigen::Index>(made.free.size());
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(n, m), Minv = Eigen::MatrixXd::Zero(m, m);
  Eigen::VectorXd u0(m), least(n);
  for (std::size_t b = 0; b < made.free.size(); ++b) {
    const auto at = 6 * static_cast<Eigen::Index>(b);
    Minv.block<6, 6>(at, at) = made.island.bodies[b].mass.inverse();
    u0.segment<6>(at) = made.free[b];
    for (Eigen::Index c = 0; c < n; ++c) {
      const GivenContact& contact = made.given[static_cast<std::size_t>(c)];
      for (int i = 0; i < 2; ++i) {
        if (contact.body[i] != made.island.bodies[b].rigid) continue;
        const Vec3 r = contact.p_W - fromBt(contact.body[i]->getWorldTransform().getOrigin());
        const Vec3 d = (i == 0 ? 1 : -1) * contact.n_W;
        J.block<1, 6>(c, at) += stacked(r.cross(d), d).transpose();
      }
    }
  }
  for (Eigen::Index c = 0; c < n; ++c)
    least[c] = SmallIsland::leastNormalVelocity(made.given[static_cast<std::size_t>(c)]);
  for (unsigned set = 0; set < (1u << n); ++set) {
    std::vector<Eigen::Index> rows;
    for (Eigen::Index c = 0; c < n; ++c)
      if (set >> c & 1) rows.push_back(c);
    Eigen::VectorXd u = u0;
    if (!rows.empty()) {
      const Eigen::MatrixXd Js = J(rows, Eigen::all);
      const Eigen::VectorXd p =
          (Js * Minv * Js.transpose()).ldlt().solve(Eigen::VectorXd(least(rows)) - Js * u0);
      if ((p.array() < 0).any() || !p.allFinite()) continue;
      u += Minv * Js.transpose() * p;
    }
    if (((J * u - least).array() < -1e-9).any()) continue;
    std::vector<Vec6> twists;
    for (Eigen::Index b = 0; b < m; b += 6) twists.emplace_back(u.segment<6>(b));
    return twists;
  }
  return {};
}

/// Greatest difference of the velocity of any point of the bodies [m/s].
inline double difference_m_s(const std::vector<Vec6>& a, const std::vector<Vec6>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = std::max(most, (a[i] - b[i]).tail<3>().norm() + 5e-3 * (a[i] - b[i]).head<3>().norm());
  return most;
}

}  // namespace vps::bullet::test_island
