// SPDX-License-Identifier: BSD-3-Clause
#include "impact_world.h"

#include <algorithm>
#include <map>

#include "vps_bullet/convert.h"

namespace vps::families {
namespace {

using dynamics::Mode;
using dynamics::PartMesh;
using dynamics::Placed;

const dynamics::Engine& coarseEngine() {
  static const dynamics::Engine engine = dynamics::vpsEngine({0.5e-3, 1e-3});
  return engine;
}

}  // namespace

ImpactWorld::ImpactWorld(Mode mode) : world({mode, true, coarseEngine()}) {}

Placed ImpactWorld::add(const PartMesh& part, const Pose& X_WP, double restitution, double friction) {
  bodies.push_back(world.add(part, X_WP, false, friction));
  bodies.back().body->setRestitution(bullet::toBt(restitution));
  return bodies.back();
}

Placed ImpactWorld::addFixed(const PartMesh& part, const Pose& X_WP, double restitution, double friction) {
  const Placed placed = world.add(part, X_WP, true, friction);
  placed.body->setRestitution(bullet::toBt(restitution));
  return placed;
}

double ImpactWorld::energy_J(bool with_height) const {
  double sum = 0;
  for (const Placed& b : bodies)
    sum += dynamics::kineticEnergy_J(*b.body) + (with_height ? dynamics::heightEnergy_J(*b.body) : 0);
  return sum;
}

Momentum ImpactWorld::momentum() const {
  Momentum sum;
  for (const Placed& b : bodies) {
    const Vec3 p = velocityOf(b) / double(b.body->getInvMass());
    const Mat3 R = bullet::fromBt(b.body->getWorldTransform().getBasis());
    const Vec3 I = bullet::fromBt(b.body->getInvInertiaDiagLocal()).cwiseInverse();
    sum.linear += p;
    sum.angular += R * I.cwiseProduct(R.transpose() * bullet::fromBt(b.body->getAngularVelocity())) +
                   bullet::fromBt(b.body->getWorldTransform().getOrigin()).cross(p);
  }
  return sum;
}

double ImpactWorld::mass_kg() const {
  double sum = 0;
  for (const Placed& b : bodies) sum += 1 / double(b.body->getInvMass());
  return sum;
}

std::pair<double, double> ImpactWorld::momentumScale() const {
  std::pair<double, double> sum;
  for (const Placed& b : bodies) {
    btVector3 center;
    btScalar radius_m = 0;
    b.body->getCollisionShape()->getBoundingSphere(center, radius_m);
    const double p = b.speed_m_s() / double(b.body->getInvMass());
    sum.first += p;
    sum.second += p * std::max<double>(radius_m, b.body->getWorldTransform().getOrigin().length());
  }
  return sum;
}

double ImpactWorld::topSpeed_m_s() const {
  double top = 0;
  for (const Placed& b : bodies) top = std::max(top, b.speed_m_s());
  return top;
}

const PartMesh& boxPart(const Vec3& size_m) {
  static std::map<std::vector<double>, PartMesh> parts;
  return dynamics::keptPart(parts, {size_m.x(), size_m.y(), size_m.z()},
                            [&] { return dynamics::makePart(makeBox(size_m)); });
}

void setVelocity(const Placed& body, const Vec3& v_W, const Vec3& w_W) {
  body.body->setLinearVelocity(bullet::toBt(v_W));
  body.body->setAngularVelocity(bullet::toBt(w_W));
}

Vec3 velocityOf(const Placed& body) {
  return bullet::fromBt(body.body->getLinearVelocity());
}

}  // namespace vps::families
