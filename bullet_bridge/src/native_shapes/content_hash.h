// SPDX-License-Identifier: BSD-3-Clause
// Tells whether the corners of one of Bullet's shapes are still those that were read.
#pragma once

#include <cstdint>

class btCollisionShape;

namespace vps::bullet {

/// A hash of what a shape's triangles are made from: of a hull its points, of a triangle mesh its vertices
/// and indices, as they lie in memory (82,000 triangles: under a millisecond); of other shapes of
/// nativeShapeMesh(), whose exceptions it throws. Scales are not included: see ShapeKey.
std::uint64_t contentHash(const btCollisionShape& shape);

}  // namespace vps::bullet
