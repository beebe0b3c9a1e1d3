// SPDX-License-Identifier: BSD-3-Clause
// Bullet's own shapes: exact distance to analytic shapes, the triangles of all shapes, and keys that detect
// changes.
#pragma once

#include <cstdint>

#include "vps/mesh.h"
#include "vps/pose.h"

class btCollisionShape;

namespace vps::bullet {

/// Signed distance [m], negative inside, and the outward unit normal of the surface.
struct SurfaceDistance {
  double distance_m = 0;
  Vec3 n = Vec3::Zero();
  bool is_edge = false;       ///< the nearest point lies on a sharp edge or corner
  std::uint16_t surface = 0;  ///< for a Shape: index of the surface that was measured
};

/// True for plane, box, sphere, capsule, cylinder, cone, multi-sphere (of up to 12 spheres, scaled evenly),
/// and for a btUniformScalingShape (by a positive factor) or a NativeShapeAdapter of these shapes.
bool isPrimitive(const btCollisionShape& shape);

/// True for the primitives with corners or rims, which can lie between the points of a shell: box, cylinder,
/// cone.
bool hasCorners(const btCollisionShape& shape);

/// Distance from p (in the shape's frame) to the shape's solid. Requires isPrimitive(shape). The size of
/// Bullet's box and cylinder includes their margin; that of the cone does not, and the rounding that Bullet
/// adds to it is ignored. O(1); for n spheres O(n^4).
SurfaceDistance primitiveDistance(const btCollisionShape& shape, const Vec3& p);

/// Triangles in the shape's frame, with its scale applied, without Bullet's collision margin.
struct NativeShapeMesh {
  Mesh mesh;
  /// True if the mesh has no inside, so that a point meets the side that it faces. Otherwise the mesh is
  /// closed and faces outward.
  bool is_sheet = false;
};

/// Greatest number of triangles of a native shape. More triangles would take over a gigabyte and stall a step
/// for seconds. Assumed.
inline constexpr std::size_t kMaxNativeTriangles = 4'000'000;

/// Makes the triangles of a shape. native_shapes.md lists, for each type, how they are made and their
/// distance from the shape. Deterministic. O(triangles). Throws std::invalid_argument for a shape whose
/// surface cannot be obtained: the message names the shape and a remedy.
NativeShapeMesh nativeShapeMesh(const btCollisionShape& shape);

/// A few numbers that change when a shape is scaled, resized, refitted or replaced by another.
struct ShapeKey {
  int type = -1;
  const void* shape = nullptr;
  const void* vertices = nullptr;  ///< points of a hull, or mesh interface of a mesh shape
  double numbers[9] = {};
  bool operator==(const ShapeKey&) const = default;
};
ShapeKey keyOf(const btCollisionShape& shape);

/// Hash of the data from which a shape's triangles are made: the points of a hull; the vertices and indices
/// of a triangle mesh, as they lie in memory (82,000 triangles: under a millisecond); the result of
/// nativeShapeMesh() for other shapes, with its exceptions. Scales are not included: see ShapeKey.
std::uint64_t contentHash(const btCollisionShape& shape);

}  // namespace vps::bullet
