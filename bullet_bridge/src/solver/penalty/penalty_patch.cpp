// SPDX-License-Identifier: BSD-3-Clause
#include "solver/penalty/penalty_patch.h"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "solver/island/newton_math.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {

void PenaltyPatch::build(PenaltyPair& from, const Mat3 (&off_tangent)[2], double dt_s, int level) {
  pair = &from;
  dt_s_ = dt_s;
  groupPoints(from, level, groups_);
  const std::size_t count = groups_.size();
  points_.resize(count);
  for (auto& column : wrench_) column.resize(count);
  for (Columns* columns : {&r_m_, &bend_m_, &bent_m_})
    for (auto& column : *columns) column.resize(count);
  gap_m_.resize(count);
  limit_N_.resize(count);
  end_m_.resize(count);
  const Vec3 origin[2] = {fromBt(from.object[0]->getWorldTransform().getOrigin()),
                          fromBt(from.object[1]->getWorldTransform().getOrigin())};
  double radius2_m2 = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const PointGroup& group = groups_[i];
    const PenaltyPoint& p = from.points[group.leader];
    const Vec3 r = p.p_W - center;
    points_[i] = {r, p.n_W, group.k_N_per_m, p.mu};
    const Vec6 wrench = wrenchOf(r, p.n_W);
    for (int c = 0; c < 6; ++c) wrench_[static_cast<std::size_t>(c)][i] = wrench[c];
    for (int c = 0; c < 3; ++c) {
      r_m_[static_cast<std::size_t>(c)][i] = r[c];
      bend_m_[static_cast<std::size_t>(c)][i] = p.bend_W[c];
    }
    gap_m_[i] =
        p.gap_m + p.n_W.dot(off_tangent[0] * (p.p_W - origin[0]) - off_tangent[1] * (p.p_W - origin[1]));
    limit_N_[i] = p.mu * group.f_n_N;
    radius2_m2 = std::max(radius2_m2, r.squaredNorm());
  }
  radius_m = std::sqrt(radius2_m2);
}

void PenaltyPatch::findGaps(const Vec6& twist) const {
  const std::size_t count = points_.size();
  const Vec6 way = dt_s_ * twist;
  const double *a = wrench_[0].data(), *b = wrench_[1].data(), *c = wrench_[2].data(), *d = wrench_[3].data(),
               *e = wrench_[4].data(), *f = wrench_[5].data(), *gap = gap_m_.data();
  double* end = end_m_.data();
  for (std::size_t i = 0; i < count; ++i)
    end[i] = gap[i] + (((a[i] * way[0] + b[i] * way[1]) + (c[i] * way[2] + d[i] * way[3])) +
                       (e[i] * way[4] + f[i] * way[5]));
}

// Adds the tangential part of each point's displacement to its bend. __restrict lets the compiler vectorise.
void PenaltyPatch::findSlips(const Vec6& twist) const {
  const std::size_t count = points_.size();
  const Vec6 way = dt_s_ * twist;
  const double *rx = r_m_[0].data(), *ry = r_m_[1].data(), *rz = r_m_[2].data();
  const double *nx = wrench_[3].data(), *ny = wrench_[4].data(), *nz = wrench_[5].data();
  const double *bx = bend_m_[0].data(), *by = bend_m_[1].data(), *bz = bend_m_[2].data();
  double* __restrict x = bent_m_[0].data();
  double* __restrict y = bent_m_[1].data();
  double* __restrict z = bent_m_[2].data();
  for (std::size_t i = 0; i < count; ++i) {
    const double wx = way[3] + (way[1] * rz[i] - way[2] * ry[i]);
    const double wy = way[4] + (way[2] * rx[i] - way[0] * rz[i]);
    const double wz = way[5] + (way[0] * ry[i] - way[1] * rx[i]);
    const double along = nx[i] * wx + ny[i] * wy + nz[i] * wz;
    x[i] = bx[i] + (wx - along * nx[i]);
    y[i] = by[i] + (wy - along * ny[i]);
    z[i] = bz[i] + (wz - along * nz[i]);
  }
}

inline PenaltyPatch::PointForce PenaltyPatch::forceAt(std::size_t i) const {
  const double k = points_[i].k;
  return {k * std::max(0.0, -end_m_[i]),
          bristleForce({bent_m_[0][i], bent_m_[1][i], bent_m_[2][i]}, k, limit_N_[i])};
}

void PenaltyPatch::evaluate(const Vec6& twist, bool with_hessian) {
  findGaps(twist);
  findSlips(twist);
  gradient.setZero();
  SymmetricSum sum;
  const double dt2 = dt_s_ * dt_s_;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!isActive(i)) continue;
    const Point& point = points_[i];
    const PointForce force = forceAt(i);
    gradient += wrenchOf(point.r, dt_s_ * (force.friction.f_N - force.f_n_N * point.n));
    if (!with_hessian) continue;
    // K = k_t I + (k_n - k_t) n n' - k_slip a a'
    const double slip_m = force.friction.slip_m;
    const bool sticks = slip_m == 0 && limit_N_[i] > 0;
    const double k_n = force.f_n_N > 0 ? dt2 * point.k : 0;
    const double k_slip = slip_m > 0 ? dt2 * limit_N_[i] / slip_m : 0;
    const double k_t = sticks ? dt2 * point.k : k_slip;
    if (k_t > 0) sum.addEven(k_t, point.r);
    if (k_n != k_t) sum.add(k_n - k_t, wrenchOf(point.r, point.n));
    if (k_slip > 0) sum.add(-k_slip, wrenchOf(point.r, force.friction.direction));
  }
  if (with_hessian) hessian = sum.total();
}

void PenaltyPatch::updateLimits(const Vec6& twist, double& change, double& greatest) {
  findGaps(twist);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double limit_N = points_[i].mu * points_[i].k * std::max(0.0, -end_m_[i]);
    change = std::max(change, std::abs(limit_N - limit_N_[i]));
    greatest = std::max(greatest, limit_N);
    limit_N_[i] = limit_N;
  }
}

void PenaltyPatch::finish(const Vec6& twist) const {
  findGaps(twist);
  findSlips(twist);
  pair->total_N = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const PointGroup& group = groups_[i];
    for (std::uint32_t j = group.first; j < group.end; ++j) pair->points[j].is_leader = j == group.leader;
    const std::span<PenaltyPoint> all = std::span(pair->points).subspan(group.first, group.end - group.first);
    if (!isActive(i)) {
      for (PenaltyPoint& out : all) {
        out.f_n_N = 0;
        out.bend_W.setZero();
      }
      continue;
    }
    const PointForce force = forceAt(i);
    const double k = points_[i].k;
    for (PenaltyPoint& out : all) {
      out.f_n_N = k > 0 ? force.f_n_N * (out.k_N_per_m / k) : 0;
      out.bend_W = k > 0 ? Vec3(force.friction.f_N / k) : Vec3(Vec3::Zero());
    }
    pair->total_N += force.f_n_N;
  }
}

}  // namespace vps::bullet
