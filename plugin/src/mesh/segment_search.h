// SPDX-License-Identifier: BSD-3-Clause
// The search for the deepest point of a piece of an edge that does not cross the surface.
#pragma once

#include "vps/solid.h"

namespace vps {

/// Searches segment ab for points deeper than depth_m by more than certain_m; sets depth_m and p_S to the
/// deepest point found. The segment must lie wholly inside or wholly outside, except where it passes a crack
/// of the mesh. The distance changes its sign at a crack, so depths there are accurate to the crack's width.
/// Returns false if the segment is outside and farther than certain_m from the surface.
bool searchUncrossed(const Solid& solid, const Vec3& a, const Vec3& b, double certain_m, double& depth_m,
                     Vec3& p_S);

/// The distance to one triangle, which is at least the distance to the surface.
double distanceToTriangle(const Solid& solid, std::uint32_t triangle, const Vec3& p);

}  // namespace vps
