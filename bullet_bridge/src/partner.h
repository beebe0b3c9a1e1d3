// SPDX-License-Identifier: BSD-3-Clause
// What stands in for one of Bullet's own shapes in a pair with a VpsShape, and where such are kept.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>

#include "vps_bullet/shape.h"

namespace vps {

/// A shape's surface as models without a map: its triangles' exact distance, and its corners as a shell, so
/// that both are looked up in each other: the VpsShape's points on the surface, the corners in the VpsShape's
/// map. Of a primitive with corners only the corners are used; its distance is the primitive's own.
/// Refers to the shape it stands for; holds its geometry as it was.
class PartnerShape : public VpsShape {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();
  /// Throws as partnerMesh().
  explicit PartnerShape(const btCollisionShape& shape);
  [[nodiscard]] const btCollisionShape* primitive() const { return primitive_; }

 private:
  const btCollisionShape* primitive_ = nullptr;
};

/// The primitive that `shape` stands in for, or nullptr.
const btCollisionShape* primitiveBehind(const btCollisionShape& shape);
/// That primitive, or else `shape` itself.
const btCollisionShape& withoutStandIn(const btCollisionShape& shape);

/// Outward normal of a sheet's foot as seen by a point at from_q from it that faces along -inward. A sheet
/// has two sides; the point comes from the one it faces. Beside the border it is a rim, met from without.
/// @param normal  the pseudonormal at the foot
/// @param is_edge set if the foot is on the border
Vec3 sheetNormal(const Vec3& from_q, const Vec3& normal, const Vec3& inward, bool& is_edge);

/// A few numbers that change when a shape is scaled, resized or refitted.
struct ShapeKey {
  int type = -1;
  double numbers[9] = {};
  bool operator==(const ShapeKey&) const = default;
};
ShapeKey keyOf(const btCollisionShape& shape);

/// The stand-ins of an installation: built when a shape first meets a VpsShape, shared by its pairs.
/// A shape is known by its address, and checked: by its key always, and by a hash of its triangles' corners
/// when no pair uses it any more, since another shape may have come to lie there. Thread-safe.
class PartnerCache {
 public:
  /// Throws as partnerMesh(). O(triangles log triangles) the first time.
  std::shared_ptr<const PartnerShape> get(const btCollisionShape& shape);

 private:
  struct Entry {
    ShapeKey key;
    std::uint64_t hash = 0;
    std::shared_ptr<const PartnerShape> stand_in;
  };
  std::mutex mutex_;
  std::map<const btCollisionShape*, Entry> entries_;
};

}  // namespace vps
