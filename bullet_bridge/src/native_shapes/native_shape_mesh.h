// SPDX-License-Identifier: BSD-3-Clause
// The surface of one of Bullet's shapes as triangles.
#pragma once

#include "vps/mesh.h"

class btCollisionShape;

namespace vps::bullet {

/// Triangles in the shape's frame, as large as the shape is scaled, without Bullet's collision margin.
struct NativeShapeMesh {
  Mesh mesh;
  /// It has no inside: met on the side that a point faces. Else it is closed and faces out.
  bool is_sheet = false;
};

/// More would take over a gigabyte, and a stall of seconds in the middle of a step. Assumed.
inline constexpr std::size_t kMaxNativeTriangles = 4'000'000;

/// How each type's triangles come about, and how far they are from the shape: README.md, "With whom".
/// Deterministic. O(triangles). Throws std::invalid_argument for a shape without a surface that we can learn:
/// says which and what would do.
NativeShapeMesh partnerMesh(const btCollisionShape& shape);

}  // namespace vps::bullet
