// SPDX-License-Identifier: BSD-3-Clause
#include "watch.h"

#include <algorithm>
#include <cmath>

#include "vps_bullet/convert.h"

namespace vps::stability {

namespace {

bool moves(const Placed& part) {
  return part.body->getInvMass() > 0;
}

bool isFinite(const Placed& part) {
  return part.pose().isFinite() && bullet::fromBt(part.body->getLinearVelocity()).allFinite() &&
         bullet::fromBt(part.body->getAngularVelocity()).allFinite();
}

double overlap_m(const std::vector<Placed>& parts) {
  double worst_m = -1e300;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (moves(parts[i]) || moves(parts[j]))
        worst_m = std::max(
            worst_m, dynamics::penetration_m(parts[i].part, parts[i].pose(), parts[j].part, parts[j].pose()));
  return worst_m;
}

double fastest_m_s(const std::vector<Placed>& parts) {
  double speed_m_s = 0;
  for (const Placed& part : parts)
    if (moves(part)) speed_m_s = std::max(speed_m_s, part.speed_m_s());
  return speed_m_s;
}

}  // namespace

double energy_J(dynamics::World& world, const std::vector<Placed>& parts) {
  const Vec3 g_W = bullet::fromBt(world.bullet().getGravity());
  double sum_J = 0;
  for (const Placed& part : parts) {
    if (!moves(part)) continue;
    const Vec3 p = bullet::fromBt(part.body->getWorldTransform().getOrigin());
    sum_J += dynamics::kineticEnergy_J(*part.body) - g_W.dot(p) / part.body->getInvMass();
  }
  return sum_J;
}

Vec3 momentum_Ns(const std::vector<Placed>& parts) {
  Vec3 sum = Vec3::Zero();
  for (const Placed& part : parts)
    if (moves(part)) sum += bullet::fromBt(part.body->getLinearVelocity()) / part.body->getInvMass();
  return sum;
}

Vec3 angularMomentum_Nms(const std::vector<Placed>& parts) {
  Vec3 sum = Vec3::Zero();
  for (const Placed& part : parts) {
    if (!moves(part)) continue;
    const btTransform& X = part.body->getWorldTransform();
    const Mat3 R = bullet::fromBt(X.getBasis());
    const Vec3 I = bullet::fromBt(part.body->getInvInertiaDiagLocal()).cwiseInverse();
    const Vec3 spin = R * I.cwiseProduct(R.transpose() * bullet::fromBt(part.body->getAngularVelocity()));
    const Vec3 p = bullet::fromBt(X.getOrigin());
    sum += spin + p.cross(bullet::fromBt(part.body->getLinearVelocity())) / part.body->getInvMass();
  }
  return sum;
}

Watched watch(dynamics::World& world, const std::vector<Placed>& parts, const Watching& watching) {
  Watched result;
  result.start_J = energy_J(world, parts);
  const int last_fifth = watching.steps - watching.steps / 5;
  std::vector<Vec3> rest;
  for (int i = 0; i < watching.steps; ++i) {
    if (watching.before_step) watching.before_step(i);
    world.step(1, watching.step_s ? watching.step_s(i) : watching.dt_s);
    result.is_finite = std::all_of(parts.begin(), parts.end(), isFinite);
    if (!result.is_finite) return result;
    result.gained_J = std::max(result.gained_J, energy_J(world, parts) - result.start_J);
    result.fastest_m_s = std::max(result.fastest_m_s, fastest_m_s(parts));
    const bool is_end = i == watching.steps - 1;
    if (is_end || i % watching.measure_every == 0) result.final_m = overlap_m(parts);
    result.deepest_m = std::max(result.deepest_m, result.final_m);
    if (i < last_fifth) continue;
    result.speed_m_s = std::max(result.speed_m_s, fastest_m_s(parts));
    if (rest.empty())
      for (const Placed& part : parts) rest.push_back(part.pose().p);
    for (std::size_t k = 0; k < parts.size(); ++k)
      result.drift_m = std::max(result.drift_m, (parts[k].pose().p - rest[k]).norm());
  }
  result.end_J = energy_J(world, parts);
  return result;
}

void judgeRun(Judgement& judgement, const Watched& watched, double weight_N, double deep_m, double dt_s) {
  judgement.require(watched.is_finite, "a pose or velocity is not a number");
  if (!watched.is_finite) return;
  const double rounding_J = 1e-12 * std::abs(watched.start_J);
  judgement.atMost("energy gained", watched.gained_J,
                   weight_N * (deep_m + watched.fastest_m_s * dt_s / 2) + rounding_J + 1e-300, "J");
  judgement.atMost("overlap", watched.deepest_m, deep_m, "m");
}

void judgeRest(Judgement& judgement, const Watched& watched, double dt_s) {
  judgement.atMost("speed at rest", watched.speed_m_s, 1e-3 * dynamics::World::kGravity_m_s2 * dt_s, "m/s");
}

}  // namespace vps::stability
