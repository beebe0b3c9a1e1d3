// SPDX-License-Identifier: BSD-3-Clause
// Boxes over a Shape's triangles, for rays, sweeps and debug drawing.
#pragma once

#include <cstdint>

#include "vps/bounding_volume_hierarchy.h"
#include "vps/mesh.h"
#include "vps_bullet/shape.h"

class btTriangleCallback;

namespace vps::bullet {

/// Tree of the triangles of a Shape, in the shape's frame.
class Shape::TriangleTree {
 public:
  TriangleTree(const Mesh& mesh, const Pose& X_SM);

  /// Reports the triangles whose boxes overlap `box`.
  void visit(const Box& box, btTriangleCallback& callback) const;
  /// Handles the callbacks of Bullet's ray and convex casts, which ask for all triangles in the box around
  /// the whole path: reports only the triangles near the path, up to the nearest hit so far. Returns false
  /// for any other callback.
  bool visitCast(const Box& box, btTriangleCallback& callback) const;

 private:
  struct Path;

  [[nodiscard]] Box boxOf(std::uint32_t triangle) const;
  void report(std::uint32_t triangle, btTriangleCallback& callback) const;
  void visitPath(const Path& path, const btScalar& share, btTriangleCallback& callback) const;

  Mesh mesh_;  // in S
  BoxTree tree_;
};

}  // namespace vps::bullet
