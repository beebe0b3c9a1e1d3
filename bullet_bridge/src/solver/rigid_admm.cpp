// SPDX-License-Identifier: BSD-3-Clause
#include "solver/rigid_admm.h"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/patch_math.h"
#include "vps_bullet/convert.h"

namespace vps::bullet::inline v0 {
namespace {

// The springs' velocity per impulse, as a share of the contact's inverse mass. Measured on 16 problems of a
// heap of 50 parts, after 80 iterations: 0.3 leaves 1.5 times the error, 0.03 nearly four times (medians).
constexpr double kSoftness = 0.1;
// Over-relaxation [Boyd et al. 2011, section 3.4.3]: between 1.5 and 1.8.
constexpr double kRelaxation = 1.6;

// The force that a contact can have: it only pushes, and Coulomb's limit is that of this push, as in sweeps.
Vec3 withinCone(const Vec3& p, const Vec3& n, double mu) {
  const double p_n = n.dot(p);
  if (!(p_n > 0)) return Vec3::Zero();
  const Vec3 p_t = p - p_n * n;
  const double length = p_t.norm(), limit = mu * p_n;
  return p_n * n + (length > limit ? limit / length : 1.0) * p_t;
}

// The vector with these parts along the contact's directions.
Vec3 inW(const RigidContact& c, double n, double t1, double t2) {
  return n * c.normal_W() + t1 * c.tangent_W(0) + t2 * c.tangent_W(1);
}

Vec3 velocityAt(const Vec6& twist, const Vec3& r) {
  return twist.tail<3>() + twist.head<3>().cross(r);
}

Eigen::Index rowOf(int body) {
  return 6 * static_cast<Eigen::Index>(body);
}

}  // namespace

void RigidAdmm::gather(std::span<const RigidContact> contacts) {
  points_.clear();
  patches_.clear();
  const RigidContact* last = nullptr;
  for (const RigidContact& c : contacts) {
    if (!last || !std::equal(c.object, c.object + 2, last->object)) {
      Patch& patch = patches_.emplace_back();
      patch.first = points_.size();
      patch.center = c.position_W();
      for (int i = 0; i < 2; ++i) {
        patch.body[i] = c.normal.side[i].body;
        const double sign = i == 0 ? 1 : -1;
        patch.X[i] = sign * twistShift(fromBt(c.object[i]->getWorldTransform().getOrigin()), patch.center);
      }
    }
    last = &c;
    Point p;
    p.r = c.position_W() - patches_.back().center;
    p.n = c.normal_W();
    p.W = (c.normal.W + c.tangent[0].W + c.tangent[1].W) / 3;
    p.mu = c.mu;
    p.softness = kSoftness * p.W;
    // A body that contact does not move, such as a kinematic one, moves the end of the spring.
    p.shift = -inW(c, c.normal.fixed_velocity - c.target_m_s, c.tangent[0].fixed_velocity,
                   c.tangent[1].fixed_velocity) /
              p.softness;
    p.impulse = inW(c, c.p_n, c.p_t[0], c.p_t[1]);
    points_.push_back(p);
    patches_.back().end = points_.size();
  }
}

// Of the bodies that contact moves.
Vec6 RigidAdmm::twistOf(const Patch& patch, const Eigen::VectorXd& u) const {
  Vec6 twist = Vec6::Zero();
  for (int i = 0; i < 2; ++i)
    if (patch.body[i] >= 0) twist += patch.X[i] * u.segment<6>(rowOf(patch.body[i]));
  return twist;
}

// At the solution, a contact's velocity is the one that the cone's cut and the spring's softness give.
void RigidAdmm::start() {
  const auto rows = rowOf(static_cast<int>(island_.bodies.size()));
  momentum_.resize(rows);
  u_.resize(rows);
  for (std::size_t i = 0; i < island_.bodies.size(); ++i) {
    const IslandBody& b = island_.bodies[i];
    momentum_.segment<6>(rowOf(static_cast<int>(i))) = b.momentum + b.coupling_impulse;
    u_.segment<6>(rowOf(static_cast<int>(i))) = b.u;
  }
  for (const Patch& patch : patches_) {
    const Vec6 twist = twistOf(patch, u_);
    for (std::size_t i = patch.first; i < patch.end; ++i) {
      Point& p = points_[i];
      p.pull = velocityAt(twist, p.r) / p.softness - p.shift;
    }
  }
}

bool RigidAdmm::factorise() {
  thread_local std::vector<std::pair<int, int>> touching;
  touching.clear();
  for (const Patch& patch : patches_)
    if (patch.body[0] >= 0 && patch.body[1] >= 0) touching.emplace_back(patch.body[0], patch.body[1]);
  matrix_.start(island_.bodies.size(), touching);
  for (std::size_t i = 0; i < island_.bodies.size(); ++i)
    matrix_.add(static_cast<int>(i), static_cast<int>(i), island_.bodies[i].effective_mass);
  for (const Patch& patch : patches_) {
    SymmetricSum springs;
    for (std::size_t i = patch.first; i < patch.end; ++i)
      springs.addEven(1 / points_[i].softness, points_[i].r);
    const Mat6 K = springs.total();
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        if (patch.body[i] >= patch.body[j] && patch.body[j] >= 0)
          matrix_.add(patch.body[i], patch.body[j], patch.X[i].transpose() * K * patch.X[j]);
  }
  return matrix_.factorise();
}

// The velocities with which springs and bodies are in balance.
void RigidAdmm::balance() {
  u_ = momentum_;
  for (const Patch& patch : patches_) {
    Vec6 wrench = Vec6::Zero();
    for (std::size_t i = patch.first; i < patch.end; ++i) {
      const Point& p = points_[i];
      wrench += wrenchOf(p.r, p.impulse + p.pull + p.shift);
    }
    for (int i = 0; i < 2; ++i)
      if (patch.body[i] >= 0) u_.segment<6>(rowOf(patch.body[i])) += patch.X[i].transpose() * wrench;
  }
  matrix_.solve(u_);
}

// Cuts the springs' impulses to the cones. Returns the greatest velocity by which impulses change or differ
// from their spring's.
double RigidAdmm::cut() {
  double change2 = 0;
  for (const Patch& patch : patches_) {
    const Vec6 twist = twistOf(patch, u_);
    for (std::size_t i = patch.first; i < patch.end; ++i) {
      Point& p = points_[i];
      const Vec3 spring = p.impulse + p.pull + p.shift - velocityAt(twist, p.r) / p.softness;
      const Vec3 wanted = kRelaxation * spring + (1 - kRelaxation) * p.impulse - p.pull;
      const Vec3 impulse = withinCone(wanted, p.n, p.mu);
      change2 = std::max({change2, p.W * p.W * (spring - impulse).squaredNorm(),
                          p.softness * p.softness * (impulse - p.impulse).squaredNorm()});
      p.pull = impulse - wanted;
      p.impulse = impulse;
    }
  }
  return std::sqrt(change2);
}

void RigidAdmm::writeImpulses(std::span<RigidContact> contacts) const {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    RigidContact& c = contacts[i];
    const Vec3& impulse = points_[i].impulse;
    c.p_n = points_[i].n.dot(impulse);
    for (int k = 0; k < 2; ++k) c.p_t[k] = c.tangent_W(k).dot(impulse);
  }
}

SolveOutcome RigidAdmm::solve(std::span<RigidContact> contacts, double residual_m_s, int limit) {
  SolveOutcome outcome;
  gather(contacts);
  start();
  if (!factorise()) return outcome;
  while (outcome.steps < limit && !outcome.is_converged) {
    balance();
    outcome.is_converged = cut() <= residual_m_s;
    ++outcome.steps;
  }
  if (!u_.allFinite()) return {outcome.steps, false};
  writeImpulses(contacts);
  return outcome;
}

}  // namespace vps::bullet::inline v0
