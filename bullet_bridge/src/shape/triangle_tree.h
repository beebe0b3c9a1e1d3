// SPDX-License-Identifier: BSD-3-Clause
// Boxes over a Shape's triangles, for rays, sweeps and debug drawing.
#pragma once

#include <cstdint>
#include <vector>

#include "vps/mesh.h"
#include "vps_bullet/shape.h"

class btTriangleCallback;

namespace vps::bullet {

/// Box tree in the shape's frame, split at the median of the longest axis, with up to four triangles per
/// leaf.
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
  struct Node {
    Box box;
    std::uint32_t first = 0, count = 0;  // count 0: inner node
    std::uint32_t skip = 0;              // next node in depth-first order if this node is skipped
  };
  struct Path;

  [[nodiscard]] Box boxOf(std::uint32_t triangle) const;
  void build(std::size_t begin, std::size_t end);
  void report(std::uint32_t triangle, btTriangleCallback& callback) const;
  void visitPath(const Path& path, const btScalar& share, btTriangleCallback& callback) const;

  std::vector<Vec3> vertices_;  // in S
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace vps::bullet
