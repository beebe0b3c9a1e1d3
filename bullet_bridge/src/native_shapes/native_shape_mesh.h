// SPDX-License-Identifier: BSD-3-Clause
// The surface of one of Bullet's shapes as triangles.
#pragma once

#include "vps/mesh.h"

class btCollisionShape;

namespace vps::bullet {

/// Triangles in the shape's frame, with its scale applied, without Bullet's collision margin.
struct NativeShapeMesh {
  Mesh mesh;
  /// It has no inside: a point meets the side that it faces. Otherwise it is closed and faces outward.
  bool is_sheet = false;
};

/// More would take over a gigabyte and stall a step for seconds. Assumed.
inline constexpr std::size_t kMaxNativeTriangles = 4'000'000;

/// README.md, "Collides with", says how the triangles of each type are made and how far they are from the
/// shape. Deterministic. O(triangles). Throws std::invalid_argument for a shape whose surface cannot be
/// obtained: the message names the shape and a remedy.
NativeShapeMesh nativeShapeMesh(const btCollisionShape& shape);

}  // namespace vps::bullet
