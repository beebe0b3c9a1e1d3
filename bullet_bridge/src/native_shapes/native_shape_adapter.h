// SPDX-License-Identifier: BSD-3-Clause
// Presents one of Bullet's own shapes as a Shape, for pairs with a Shape; and the cache of such adapters.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>

#include "native_shapes/native_shape.h"
#include "vps_bullet/shape.h"

namespace vps::bullet {

/// A native shape's surface as models without a map: the exact distance of its triangles, and its corners as
/// a shell. So each side's points are queried in the other: the Shape's on the surface, the corners in the
/// Shape's map. For a primitive with corners only the corners are used; the primitive has its own distance
/// function. Refers to the native shape, but keeps the geometry that it had at construction.
class NativeShapeAdapter : public Shape {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();
  /// Throws as nativeShapeMesh().
  explicit NativeShapeAdapter(const btCollisionShape& shape);
  [[nodiscard]] const btCollisionShape* primitive() const { return primitive_; }

 private:
  const btCollisionShape* primitive_ = nullptr;
};

/// The primitive that the adapter `shape` represents; nullptr if `shape` is no adapter of a primitive.
const btCollisionShape* primitiveOf(const btCollisionShape& shape);
/// That primitive, or else `shape` itself.
const btCollisionShape& unwrapped(const btCollisionShape& shape);

/// The adapters of an installation: built when a native shape first meets a Shape, shared by its pairs.
/// A shape is identified by its address. Another shape may later have the same address, so it is checked: by
/// its key always, and by a hash of its corners when no pair uses the adapter. Thread-safe.
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
