// SPDX-License-Identifier: BSD-3-Clause
#include "penalty_newton.h"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "cross_matrix.h"
#include "vps_bullet/convert.h"

namespace vps {
namespace {

/// A twist about `from` as one about `to`.
Mat6 twistShift(const Vec3& from, const Vec3& to) {
  Mat6 X = Mat6::Identity();
  X.bottomLeftCorner<3, 3>() = -crossMatrix(to - from);
  return X;
}

Vec3 toVec(const double (&v)[3]) {
  return {v[0], v[1], v[2]};
}
void copy(const Vec3& v, double (&to)[3]) {
  for (int k = 0; k < 3; ++k) to[k] = v[k];
}

double sumOfProducts(const std::vector<Vec6>& a, const std::vector<Vec6>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

}  // namespace

void PenaltyNewton::add(PenaltyPair& pair) {
  if (pair.points.empty()) return;
  Patch patch;
  patch.pair = &pair;
  for (const PenaltyPoint& p : pair.points) patch.center += p.p_W / static_cast<double>(pair.points.size());
  for (int i = 0; i < 2; ++i) {
    patch.body[i] = island_.indexOf(pair.object[i]);
    const double sign = i == 0 ? 1 : -1;
    patch.X[i] = sign * twistShift(fromBt(pair.object[i]->getWorldTransform().getOrigin()), patch.center);
    if (patch.body[i] < 0) patch.fixed += patch.X[i] * Island::fixedVelocity(pair.object[i]);
  }
  if (patch.body[0] < 0 && patch.body[1] < 0) return;
  // A turning body's points go along a circle, off the tangent that a twist takes them along. Left out, a nut
  // ends each step a little off its thread, and the springs that put it back brake it.
  Vec3 turn[2], center[2];
  for (int i = 0; i < 2; ++i) {
    turn[i] = dt_s_ * Island::fixedVelocity(pair.object[i]).head<3>();
    center[i] = fromBt(pair.object[i]->getWorldTransform().getOrigin());
  }
  const Mat3 off_tangent[2] = {rotationFromVector(turn[0]) - Mat3::Identity() - crossMatrix(turn[0]),
                               rotationFromVector(turn[1]) - Mat3::Identity() - crossMatrix(turn[1])};
  patch.points.reserve(pair.points.size());
  for (const PenaltyPoint& p : pair.points) {
    patch.radius_m = std::max(patch.radius_m, (p.p_W - patch.center).norm());
    Point point{};
    copy(p.p_W - patch.center, point.r);
    copy(p.n_W, point.n);
    copy(p.bend_W, point.bend);
    point.gap_m =
        p.gap_m + p.n_W.dot(off_tangent[0] * (p.p_W - center[0]) - off_tangent[1] * (p.p_W - center[1]));
    point.k = p.k_N_per_m;
    point.limit_N = pair.mu * p.f_n_N;
    patch.points.push_back(point);
  }
  patches_.push_back(std::move(patch));
}

PenaltyNewton::Push PenaltyNewton::pushOf(const Point& point, const Vec6& twist) const {
  const Vec3 n = toVec(point.n);
  const Vec3 way = dt_s_ * (twist.tail<3>() + twist.head<3>().cross(toVec(point.r)));
  Push push;
  const double along_n = n.dot(way);
  push.f_n_N = point.k * std::max(0.0, -(point.gap_m + along_n));
  const Vec3 x = toVec(point.bend) + (way - along_n * n);
  const double length = x.norm();
  if (!(length > 0) || !(point.limit_N > 0)) return push;
  if (point.k * length <= point.limit_N) {
    push.f_t_N = point.k * x;
  } else {
    push.slip_m = length;
    push.along = x / length;
    push.f_t_N = point.limit_N * push.along;
  }
  return push;
}

void PenaltyNewton::evaluate(Patch& patch, const Vec6& twist, bool with_hessian) const {
  patch.gradient.setZero();
  if (with_hessian) patch.hessian.setZero();
  const double dt2 = dt_s_ * dt_s_;
  for (const Point& point : patch.points) {
    const Push push = pushOf(point, twist);
    const bool holds = push.slip_m == 0 && point.limit_N > 0;
    if (push.f_n_N == 0 && !(point.limit_N > 0)) continue;
    const Vec3 n = toVec(point.n), r = toVec(point.r);
    const Vec3 a = dt_s_ * (push.f_t_N - push.f_n_N * n);
    patch.gradient.head<3>() += r.cross(a);
    patch.gradient.tail<3>() += a;
    if (!with_hessian) continue;
    const double k_n = push.f_n_N > 0 ? dt2 * point.k : 0;
    const double k_t = holds ? dt2 * point.k : push.slip_m > 0 ? dt2 * point.limit_N / push.slip_m : 0;
    Mat3 K = k_t * Mat3::Identity() + (k_n - k_t) * n * n.transpose();
    if (push.slip_m > 0) K -= k_t * push.along * push.along.transpose();
    // v = v_c - [r] w, so K becomes [-[r] K [r], [r] K; -K [r], K], lower halves by symmetry.
    const Mat3 rx = crossMatrix(r), rxK = rx * K;
    patch.hessian.topLeftCorner<3, 3>() -= rxK * rx;
    patch.hessian.topRightCorner<3, 3>() += rxK;
    patch.hessian.bottomRightCorner<3, 3>() += K;
  }
  if (with_hessian) patch.hessian.bottomLeftCorner<3, 3>() = patch.hessian.topRightCorner<3, 3>().transpose();
}

Vec6 PenaltyNewton::twistOf(const Patch& patch, const std::vector<Vec6>& u) const {
  Vec6 twist = patch.fixed;
  for (int i = 0; i < 2; ++i)
    if (patch.body[i] >= 0) twist += patch.X[i] * u[static_cast<std::size_t>(patch.body[i])];
  return twist;
}

void PenaltyNewton::evaluateAll(const std::vector<Vec6>& u, bool with_hessian, std::vector<Vec6>& gradient) {
  for (std::size_t i = 0; i < u.size(); ++i) {
    const IslandBody& b = island_.bodies[i];
    gradient[i] = b.held * u[i] - b.momentum - b.drive;
  }
  for (std::size_t j = 0; j < joint_kg_.size(); ++j) {
    const JointRow& row = joints_.rows[j];
    const double impulse_Ns = jointImpulse(row, joint_kg_[j], u);
    is_free_[j] = impulse_Ns > row.lower_Ns && impulse_Ns < row.upper_Ns;
    for (int i = 0; i < 2; ++i)
      if (row.body[i] >= 0) gradient[static_cast<std::size_t>(row.body[i])] -= impulse_Ns * row.J[i];
  }
  for (Patch& patch : patches_) {
    evaluate(patch, twistOf(patch, u), with_hessian);
    for (int i = 0; i < 2; ++i)
      if (patch.body[i] >= 0)
        gradient[static_cast<std::size_t>(patch.body[i])] += patch.X[i].transpose() * patch.gradient;
  }
}

void PenaltyNewton::prepareJoints() {
  constexpr double kStiffer = 1e6;  // than the bodies are heavy
  joint_kg_.clear();
  for (const JointRow& row : joints_.rows) {
    double W = 0;
    for (int i = 0; i < 2; ++i)
      if (row.body[i] >= 0)
        W += row.J[i].dot(island_.bodies[static_cast<std::size_t>(row.body[i])].held.llt().solve(row.J[i]));
    joint_kg_.push_back(W > 0 ? 1 / (W * std::max(row.softness, 1 / kStiffer)) : 0);
  }
  is_free_.assign(joints_.rows.size(), 0);
}

double PenaltyNewton::jointImpulse(const JointRow& row, double stiffness_kg,
                                   const std::vector<Vec6>& u) const {
  double velocity = row.fixed_velocity;
  for (int i = 0; i < 2; ++i)
    if (row.body[i] >= 0) velocity += row.J[i].dot(u[static_cast<std::size_t>(row.body[i])]);
  return std::clamp(stiffness_kg * (row.target - velocity), row.lower_Ns, row.upper_Ns);
}

void PenaltyNewton::newtonStep(const std::vector<Vec6>& gradient, std::vector<Vec6>& step) const {
  const auto count = static_cast<Eigen::Index>(6 * gradient.size());
  Eigen::VectorXd rhs(count);
  for (std::size_t i = 0; i < gradient.size(); ++i)
    rhs.segment<6>(static_cast<Eigen::Index>(6 * i)) = -gradient[i];
  // Lower blocks only: that is what the factorisations read.
  const auto forEachBlock = [&](const auto& add) {
    for (std::size_t i = 0; i < gradient.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(6 * i);
      add(at, at, island_.bodies[i].held);
    }
    for (const Patch& patch : patches_)
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j)
          if (patch.body[i] >= patch.body[j] && patch.body[j] >= 0)
            add(Eigen::Index{6} * patch.body[i], Eigen::Index{6} * patch.body[j],
                Mat6(patch.X[i].transpose() * patch.hessian * patch.X[j]));
    for (std::size_t r = 0; r < joint_kg_.size(); ++r)
      for (int i = 0; i < 2 && is_free_[r]; ++i)
        for (int j = 0; j < 2; ++j)
          if (const JointRow& row = joints_.rows[r]; row.body[i] >= row.body[j] && row.body[j] >= 0)
            add(Eigen::Index{6} * row.body[i], Eigen::Index{6} * row.body[j],
                Mat6(joint_kg_[r] * row.J[i] * row.J[j].transpose()));
  };
  constexpr std::size_t kDense = 12;  // assumed: bodies up to which a dense matrix is quicker
  Eigen::VectorXd answer;
  if (gradient.size() <= kDense) {
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(count, count);
    forEachBlock([&](Eigen::Index row, Eigen::Index column, const Mat6& block) {
      H.block<6, 6>(row, column) += block;
    });
    answer = Eigen::LLT<Eigen::MatrixXd>(H).solve(rhs);
  } else {
    std::vector<Eigen::Triplet<double>> entries;
    forEachBlock([&](Eigen::Index row, Eigen::Index column, const Mat6& block) {
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
          entries.emplace_back(static_cast<int>(row) + i, static_cast<int>(column) + j, block(i, j));
    });
    Eigen::SparseMatrix<double> H(count, count);
    H.setFromTriplets(entries.begin(), entries.end());
    answer = Eigen::SimplicialLLT<Eigen::SparseMatrix<double>>(H).solve(rhs);
  }
  for (std::size_t i = 0; i < step.size(); ++i) step[i] = answer.segment<6>(static_cast<Eigen::Index>(6 * i));
}

// The potential is convex, so its slope along the step grows: the least is where that is zero.
double PenaltyNewton::shareOf(const std::vector<Vec6>& u, const std::vector<Vec6>& step, double slope) {
  constexpr double kFlat = 0.1;  // of the slope at the start: a better share would not save an iteration
  std::vector<Vec6> trial(u.size()), gradient(u.size());
  const auto slopeAt = [&](double share) {
    for (std::size_t i = 0; i < u.size(); ++i) trial[i] = u[i] + share * step[i];
    evaluateAll(trial, false, gradient);
    return sumOfProducts(gradient, step);
  };
  double low = 0, low_slope = slope, high = 1, high_slope = slopeAt(1);
  if (high_slope <= -kFlat * slope) return 1;
  double share = 1;
  for (int k = 0; k < 20; ++k) {
    const double room = high - low;
    share =
        std::clamp(low - low_slope * room / (high_slope - low_slope), low + 0.05 * room, high - 0.05 * room);
    const double here = slopeAt(share);
    if (std::abs(here) <= -kFlat * slope) break;
    (here < 0 ? low : high) = share;
    (here < 0 ? low_slope : high_slope) = here;
  }
  return share;
}

double PenaltyNewton::greatestSpeed(const std::vector<Vec6>& step) const {
  double speed_m_s = 0;
  for (const Patch& patch : patches_) {
    const Vec6 twist = twistOf(patch, step) - patch.fixed;
    speed_m_s = std::max(speed_m_s, twist.tail<3>().norm() + twist.head<3>().norm() * patch.radius_m);
  }
  return speed_m_s;
}

int PenaltyNewton::solve(double residual_m_s, int iteration_limit) {
  prepareJoints();
  std::vector<Vec6> u = velocities(), gradient(u.size()), step(u.size());
  int used = 0;
  while (used++ < iteration_limit) {
    evaluateAll(u, true, gradient);
    newtonStep(gradient, step);
    const double slope = sumOfProducts(gradient, step);
    if (!(slope < 0)) break;
    const double share = shareOf(u, step, slope);
    for (std::size_t i = 0; i < u.size(); ++i) u[i] += share * step[i];
    if (greatestSpeed(step) < residual_m_s) break;
  }
  for (std::size_t i = 0; i < u.size(); ++i) island_.bodies[i].u = u[i];
  return used;
}

std::vector<Vec6> PenaltyNewton::velocities() const {
  std::vector<Vec6> u;
  for (const IslandBody& b : island_.bodies) u.push_back(b.u);
  return u;
}

double PenaltyNewton::renewLimits() {
  const std::vector<Vec6> u = velocities();
  double change = 0, greatest = 0;
  for (Patch& patch : patches_) {
    const Vec6 twist = twistOf(patch, u);
    for (Point& point : patch.points) {
      const double limit_N = patch.pair->mu * pushOf(point, twist).f_n_N;
      change = std::max(change, std::abs(limit_N - point.limit_N));
      greatest = std::max(greatest, limit_N);
      point.limit_N = limit_N;
    }
  }
  return greatest > 0 ? change / greatest : change;
}

void PenaltyNewton::finish() {
  const std::vector<Vec6> u = velocities();
  for (std::size_t j = 0; j < joint_kg_.size(); ++j)
    joints_.rows[j].impulse_Ns = jointImpulse(joints_.rows[j], joint_kg_[j], u);
  for (Patch& patch : patches_) {
    const Vec6 twist = twistOf(patch, u);
    patch.pair->all_N = 0;
    for (std::size_t i = 0; i < patch.points.size(); ++i) {
      const Push push = pushOf(patch.points[i], twist);
      PenaltyPoint& out = patch.pair->points[i];
      out.f_n_N = push.f_n_N;
      out.bend_W = push.f_t_N / patch.points[i].k;
      patch.pair->all_N += push.f_n_N;
    }
  }
}

}  // namespace vps
