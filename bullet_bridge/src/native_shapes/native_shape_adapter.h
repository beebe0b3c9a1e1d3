// SPDX-License-Identifier: BSD-3-Clause
// Adapters that present Bullet's own shapes as a Shape, for pairs with a Shape; and their cache.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>

#include "native_shapes/native_shape.h"
#include "vps_bullet/shape.h"

namespace vps::bullet {

/// A native shape's surface as models without a map: the exact distance of its triangles, and its corners as
/// a shell. The points of each side are queried in the other side: the Shape's points on the native
/// surface, the corners in the Shape's map. For a primitive with corners only the corners are used, since
/// primitiveDistance() measures the surface. Refers to the native shape, but keeps the geometry that it had
/// at construction.
class NativeShapeAdapter : public Shape {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();
  /// Throws as nativeShapeMesh().
  explicit NativeShapeAdapter(const btCollisionShape& shape);
  [[nodiscard]] const btCollisionShape* primitive() const { return primitive_; }

 private:
  const btCollisionShape* primitive_ = nullptr;
};

/// The primitive that the adapter `shape` represents; nullptr if `shape` is not an adapter of a primitive.
const btCollisionShape* primitiveOf(const btCollisionShape& shape);
/// The primitive that the adapter `shape` represents, or `shape` itself if it is not such an adapter.
const btCollisionShape& unwrapped(const btCollisionShape& shape);

/// The adapters of an installation. An adapter is built when a native shape first meets a Shape, and shared
/// by all pairs of the native shape. Shapes are identified by address. Since another shape may later have the
/// same address, the shape's key is compared in each call, and a hash of its corners too if no pair uses the
/// adapter. Thread-safe.
class NativeShapeCache {
 public:
  /// Throws as nativeShapeMesh(). O(triangles log triangles) the first time.
  std::shared_ptr<const NativeShapeAdapter> get(const btCollisionShape& shape);

 private:
  struct Entry {
    ShapeKey key;
    std::uint64_t hash = 0;
    std::shared_ptr<const NativeShapeAdapter> adapter;
  };
  std::mutex mutex_;
  std::map<const btCollisionShape*, Entry> entries_;
};

}  // namespace vps::bullet
