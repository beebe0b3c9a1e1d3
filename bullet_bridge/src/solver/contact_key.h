// SPDX-License-Identifier: BSD-3-Clause
// The key that identifies a contact from step to step, and values that a contact point carries for the
// solver.
#pragma once

#include <cstdint>

class btManifoldPoint;

namespace vps::bullet {

/// @param side  0 or 1: the body whose shell the point belongs to
/// @param crossed  for an edge crossing: 1 + index of body 1's edge; 0 for a shell point
/// @param id  index of the point in its shell; for a crossing: index of body 0's edge
constexpr std::uint64_t contactKey(std::uint8_t side, std::uint32_t crossed, std::uint32_t id) {
  return (std::uint64_t(side) << 63) | (std::uint64_t(crossed) << 32) | id;
}

/// Sets the rest gap that bullet::Solver keeps at a contact of sharp features. The gap is stored in
/// m_contactCFM, since Bullet has no member for it; contacts with their own softness get no rest gap.
void setRestGap(btManifoldPoint& point, double rest_m);
/// Returns the rest gap of a contact; 0 if none was set.
double restGap_m(const btManifoldPoint& point);

/// Sets the area of a touching face that the contact represents. The area is stored in m_contactERP; contacts
/// with their own softness get none.
void setArea(btManifoldPoint& point, double area_m2);
/// Returns the area that a contact represents; 0 if none was set.
double area_m2(const btManifoldPoint& point);

/// Marks a contact at which the bodies will bounce within the step, and sets its distance to 0. Bullet's
/// solver subtracts the gap from the speed of the rebound, which would suppress the bounce. The two positions
/// still contain the gap.
void setBounces(btManifoldPoint& point);
bool bounces(const btManifoldPoint& point);
/// The distance for bullet::Solver: getDistance(), or, after setBounces(), the distance of the two positions.
double solvedDistance_m(const btManifoldPoint& point);

/// Key of a contact that ManifoldWriter wrote. The index of the side with the shell is the point's id, the
/// other index is -1; for a crossing both indices are edges.
std::uint64_t keyOf(const btManifoldPoint& point);

}  // namespace vps::bullet
