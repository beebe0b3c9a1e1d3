// SPDX-License-Identifier: BSD-3-Clause
// What stands in for one of Bullet's own shapes in a pair with a Shape, and where such are kept.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "vps_bullet/shape.h"

namespace vps::bullet {

/// A shape's surface as models without a map: its triangles' exact distance, and its corners as a shell, so
/// that both are looked up in each other: the Shape's points on the surface, the corners in the Shape's
/// map. Of a primitive with corners only the corners are used; its distance is the primitive's own.
/// Refers to the shape it stands for; holds its geometry as it was.
class NativeShape : public Shape {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();
  /// Throws as partnerMesh().
  explicit NativeShape(const btCollisionShape& shape);
  [[nodiscard]] const btCollisionShape* primitive() const { return primitive_; }

 private:
  const btCollisionShape* primitive_ = nullptr;
};

/// The primitive that `shape` stands in for, or nullptr.
const btCollisionShape* primitiveBehind(const btCollisionShape& shape);
/// That primitive, or else `shape` itself.
const btCollisionShape& withoutStandIn(const btCollisionShape& shape);

/// Outward normal at a point's foot on a sheet, as the point sees it.
struct SheetFoot {
  Vec3 normal = Vec3::Zero();
  bool is_rim = false;  ///< the foot is on the border, and the point beside it
};

/// Where a sheet ends: the edges that only one of its triangles has.
class SheetBorder {
 public:
  explicit SheetBorder(const Mesh& mesh);
  /// A sheet has two sides; the point comes from the one it faces, against its `inward` normal. Beside the
  /// border it has not come through: the sheet is a rim there, met from without. All in the mesh's frame.
  [[nodiscard]] SheetFoot seenFrom(const Vec3& p, const Vec3& inward,
                                   const MeshDistance::Closest& foot) const;

 private:
  struct Edge {
    Vec3 a, b;
  };
  [[nodiscard]] bool isOnBorder(std::uint32_t triangle, const Vec3& q) const;
  /// By triangle: the first of its entries in edges_, and of the next triangle's. Those are the border's
  /// edges that share a corner with it.
  std::vector<std::uint32_t> first_;
  std::vector<Edge> edges_;
  double touch_m_ = 0;
};

/// A few numbers that change when a shape is scaled, resized or refitted.
struct ShapeKey {
  int type = -1;
  double numbers[9] = {};
  bool operator==(const ShapeKey&) const = default;
};
ShapeKey keyOf(const btCollisionShape& shape);

/// The stand-ins of an installation: built when a shape first meets a Shape, shared by its pairs.
/// A shape is known by its address, and checked: by its key always, and by a hash of its triangles' corners
/// when no pair uses it any more, since another shape may have come to lie there. Thread-safe.
class NativeShapeCache {
 public:
  /// Throws as partnerMesh(). O(triangles log triangles) the first time.
  std::shared_ptr<const NativeShape> get(const btCollisionShape& shape);

 private:
  struct Entry {
    ShapeKey key;
    std::uint64_t hash = 0;
    std::shared_ptr<const NativeShape> adapter;
  };
  std::mutex mutex_;
  std::map<const btCollisionShape*, Entry> entries_;
};

}  // namespace vps::bullet
