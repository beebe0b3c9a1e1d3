// SPDX-License-Identifier: BSD-3-Clause
// The number by which a contact is known from step to step.
#pragma once

#include <cstdint>

class btManifoldPoint;

namespace vps::bullet {

/// @param side     0 or 1: whose shell the point belongs to
/// @param crossed  at a crossing of edges 1 + body 1's edge; 0: a shell point
/// @param id       of the point in its shell; at a crossing body 0's edge
constexpr std::uint64_t contactKey(std::uint8_t side, std::uint32_t crossed, std::uint32_t id) {
  return (std::uint64_t(side) << 63) | (std::uint64_t(crossed) << 32) | id;
}

/// Sets the gap that bullet::Solver keeps at a contact of sharp features. Bullet has no member for it: it is
/// kept in that of a softness that the contact does not have. Contacts with a stiffness of their own have
/// none.
void setRestGap(btManifoldPoint& point, double rest_m);
/// 0: it has none.
double restGap_m(const btManifoldPoint& point);

/// Sets how much of a touching face the contact stands for; kept as the gap is.
void setArea(btManifoldPoint& point, double area_m2);
/// 0: it stands for none.
double area_m2(const btManifoldPoint& point);

/// Marks a contact at which the bodies will bounce within the step. Bullet's solver subtracts the gap from
/// the speed of the rebound, which would suppress a bounce within the step; so it is given no gap. The two
/// positions keep it.
void setBounces(btManifoldPoint& point);
bool bounces(const btManifoldPoint& point);
/// The distance that bullet::Solver solves for: getDistance(), except where setBounces() removed it.
double solvedDistance_m(const btManifoldPoint& point);

/// Key of a contact that ManifoldWriter wrote: the side with the shell has the point's id as its index, the
/// other -1; at a crossing each index is that body's edge.
std::uint64_t keyOf(const btManifoldPoint& point);

}  // namespace vps::bullet
