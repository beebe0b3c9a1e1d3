// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact_key.h"

#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>

namespace vps::bullet {

namespace {

// Bits of m_contactPointFlags above Bullet's own.
constexpr int kHasRestGap = 1 << 24, kBounces = 1 << 28, kHasArea = 1 << 29;
constexpr int kIsSoft = BT_CONTACT_FLAG_HAS_CONTACT_CFM | BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING;

}  // namespace

void setRestGap(btManifoldPoint& point, double rest_m) {
  if ((point.m_contactPointFlags & kIsSoft) != 0) return;
  point.m_contactPointFlags |= kHasRestGap;
  point.m_contactCFM = static_cast<btScalar>(rest_m);
}

double restGap_m(const btManifoldPoint& point) {
  return (point.m_contactPointFlags & kHasRestGap) != 0 ? point.m_contactCFM : 0;
}

void setArea(btManifoldPoint& point, double area_m2) {
  constexpr int kOwn = BT_CONTACT_FLAG_HAS_CONTACT_ERP | BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING;
  if ((point.m_contactPointFlags & kOwn) != 0) return;
  point.m_contactPointFlags |= kHasArea;
  point.m_contactERP = static_cast<btScalar>(area_m2);
}

double area_m2(const btManifoldPoint& point) {
  return (point.m_contactPointFlags & kHasArea) != 0 ? point.m_contactERP : 0;
}

void setBounces(btManifoldPoint& point) {
  point.m_contactPointFlags |= kBounces;
  point.m_distance1 = 0;
}

bool bounces(const btManifoldPoint& point) {
  return (point.m_contactPointFlags & kBounces) != 0;
}

double solvedDistance_m(const btManifoldPoint& point) {
  if (!bounces(point)) return point.getDistance();
  return point.m_normalWorldOnB.dot(point.getPositionWorldOnA() - point.getPositionWorldOnB());
}

std::uint64_t keyOf(const btManifoldPoint& point) {
  const std::uint8_t side = point.m_index0 >= 0 ? 0 : 1;
  const bool is_crossing = point.m_index0 >= 0 && point.m_index1 >= 0;
  const std::uint32_t crossed = is_crossing ? static_cast<std::uint32_t>(point.m_index1) + 1 : 0;
  return contactKey(side, crossed, static_cast<std::uint32_t>(side == 0 ? point.m_index0 : point.m_index1));
}

}  // namespace vps::bullet
