// SPDX-License-Identifier: BSD-3-Clause
// Bullet's own shapes: exact distance to analytic ones, triangles of the others, and what tells that one has
// changed.
#pragma once

#include <cstdint>

#include "vps/mesh.h"
#include "vps/pose.h"

class btCollisionShape;

namespace vps::bullet {

/// Signed distance [m], negative inside, and the outward unit normal there.
struct SurfaceDistance {
  double distance_m = 0;
  Vec3 n = Vec3::Zero();
  bool is_edge = false;       ///< the nearest point is on a sharp edge or corner
  std::uint16_t surface = 0;  ///< of a Shape: index of the surface that it is from
};

/// True for plane, box, sphere, capsule, cylinder, cone, multi-sphere (of up to 12 spheres, scaled evenly), a
/// btUniformScalingShape of one of those by a positive factor, and a NativeShapeAdapter of one of those.
bool isPrimitive(const btCollisionShape& shape);

/// True for the primitives that have corners or rims: box, cylinder, cone. These can lie between the points
/// of a shell.
bool hasCorners(const btCollisionShape& shape);

/// Distance from p (in the shape's frame) to the shape's solid. Requires isPrimitive(shape). The size of
/// Bullet's box and cylinder includes their margin; that of the cone does not, and the rounding that Bullet
/// adds to it is ignored. O(1); for n spheres O(n^4).
SurfaceDistance primitiveDistance(const btCollisionShape& shape, const Vec3& p);

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

/// A few numbers that change when a shape is scaled, resized, refitted or replaced by another.
struct ShapeKey {
  int type = -1;
  const void* shape = nullptr;
  const void* vertices = nullptr;  ///< of a hull, or the mesh that a mesh shape reads
  double numbers[9] = {};
  bool operator==(const ShapeKey&) const = default;
};
ShapeKey keyOf(const btCollisionShape& shape);

/// A hash of what a shape's triangles are made from: of a hull its points, of a triangle mesh its vertices
/// and indices, as they lie in memory (82,000 triangles: under a millisecond); of other shapes of
/// nativeShapeMesh(), whose exceptions it throws. Scales are not included: see ShapeKey.
std::uint64_t contentHash(const btCollisionShape& shape);

}  // namespace vps::bullet
