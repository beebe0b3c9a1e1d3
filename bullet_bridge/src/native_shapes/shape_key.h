// SPDX-License-Identifier: BSD-3-Clause
// Tells whether one of Bullet's shapes has changed its size.
#pragma once

class btCollisionShape;

namespace vps::bullet {

/// A few numbers that change when a shape is scaled, resized, refitted or replaced by another.
struct ShapeKey {
  int type = -1;
  const void* shape = nullptr;
  const void* vertices = nullptr;  ///< of a hull, or the mesh that a mesh shape reads
  double numbers[9] = {};
  bool operator==(const ShapeKey&) const = default;
};
ShapeKey keyOf(const btCollisionShape& shape);

}  // namespace vps::bullet
