// SPDX-License-Identifier: BSD-3-Clause
#include "native_shapes/native_shape_adapter.h"

#include <span>

#include "native_shapes/native_shape.h"
#include "shape/sheet_border.h"
#include "vps/bounding_volume_hierarchy.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {

namespace {

// Area of a corner, which penalty contact needs: a square of half a millimetre. Assumed: a corner represents
// as much area as a shell point.
constexpr double kCornerArea_m2 = 0.25e-6;

struct Corners {
  std::vector<Vec3> points, inward;
};

// Each vertex that a triangle uses; for a sheet once for each side.
Corners cornersOf(const Solid& surface, bool is_sheet) {
  const Mesh& mesh = surface.mesh();
  std::vector<std::uint8_t> is_taken(mesh.vertices.size(), 0);
  Corners corners;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[t][k];
      const Vec3 outward = surface.featureNormal(t, 4 + k);
      if (is_taken[v] || outward.isZero(0)) continue;
      is_taken[v] = 1;
      corners.points.push_back(mesh.vertices[v]);
      corners.inward.push_back(-outward);
      if (!is_sheet) continue;
      corners.points.push_back(mesh.vertices[v]);
      corners.inward.push_back(outward);
    }
  return corners;
}

/// Shell node over these points, of which the first one has index `first` in the shell.
ShellNode nodeOver(std::span<const Vec3> points, std::uint32_t first) {
  Box box;
  for (const Vec3& p : points) box.add(p);
  ShellNode node;
  node.center = box.center();
  node.radius_m = 0.5 * box.size().norm() * (1 + 1e-12);
  node.first = first;
  node.count = static_cast<std::uint32_t>(points.size());
  return node;
}

PointShell leafOf(const Corners& corners, std::span<const std::uint32_t> ids) {
  PointShell leaf;
  for (const std::uint32_t id : ids) {
    leaf.points.push_back(corners.points[id]);
    leaf.inward.push_back(corners.inward[id]);
    leaf.area_m2.push_back(kCornerArea_m2);
  }
  ShellNode node = nodeOver(leaf.points, 0);
  node.skip = 1;
  node.is_leaf = true;
  leaf.nodes = {node};
  return leaf;
}

/// Leaves of sixteen corners that are near each other, and a hierarchy over them, so that a walk leaves out
/// many of them at once.
PointShell shellOf(const Corners& corners) {
  const Hierarchy tree =
      buildHierarchy(corners.points.size(), [&](std::span<std::uint32_t> items) -> std::size_t {
        if (items.size() <= kLanes) return 0;
        const std::size_t leaves = (items.size() + kLanes - 1) / kLanes, left = leaves / 2 * kLanes;
        divideByPoint(items, left, corners.points);
        return left;
      });
  std::vector<PointShell> leaves;
  for (const HierarchyNode& node : tree.nodes)
    if (node.isLeaf())
      leaves.push_back(leafOf(corners, std::span(tree.order).subspan(node.first, node.end - node.first)));
  std::vector<const PointShell*> pointers;
  for (const PointShell& leaf : leaves) pointers.push_back(&leaf);
  PointShell shell = mergedShells(pointers, std::vector<Pose>(leaves.size()));
  std::vector<ShellNode> nodes;
  std::size_t leaf = 1;  // the merged shell has a root over all leaves
  for (const HierarchyNode& node : tree.nodes) {
    const auto points = std::span(shell.points).subspan(node.first, node.end - node.first);
    nodes.push_back(node.isLeaf() ? shell.nodes[leaf++] : nodeOver(points, node.first));
    nodes.back().skip = node.skip;
  }
  shell.nodes = std::move(nodes);
  return shell;
}

ShapeModels modelsOf(const NativeShapeMesh& native) {
  ShapeModels models;
  const auto surface = std::make_shared<const Solid>(native.is_sheet ? Solid::sheet(native.mesh)
                                                                     : Solid(native.mesh, "native shape"));
  models.shell = std::make_shared<const PointShell>(shellOf(cornersOf(*surface, native.is_sheet)));
  models.surfaces = {
      {surface, Pose(), native.is_sheet ? std::make_shared<const SheetBorder>(native.mesh) : nullptr}};
  return models;
}

}  // namespace

NativeShapeAdapter::NativeShapeAdapter(const btCollisionShape& shape)
    : Shape(modelsOf(nativeShapeMesh(shape))), primitive_(isPrimitive(shape) ? &shape : nullptr) {}

const btCollisionShape* primitiveOf(const btCollisionShape& shape) {
  const auto* adapter = dynamic_cast<const NativeShapeAdapter*>(&shape);
  return adapter ? adapter->primitive() : nullptr;
}

const btCollisionShape& unwrapped(const btCollisionShape& shape) {
  const btCollisionShape* primitive = primitiveOf(shape);
  return primitive ? *primitive : shape;
}

std::shared_ptr<const NativeShapeAdapter> NativeShapeCache::get(const btCollisionShape& shape) {
  const std::lock_guard lock(mutex_);
  const ShapeKey key = keyOf(shape);
  const auto it = entries_.find(&shape);
  const bool is_known = it != entries_.end() && it->second.key == key;
  if (is_known && it->second.adapter.use_count() > 1) return it->second.adapter;
  const std::uint64_t hash = contentHash(shape);
  if (is_known && it->second.hash == hash) return it->second.adapter;
  // Bullet does not report deleted shapes, so adapters without pairs are dropped when there are many.
  constexpr std::size_t kMaxKept = 64;
  if (entries_.size() >= kMaxKept)
    std::erase_if(entries_, [](const auto& entry) { return entry.second.adapter.use_count() == 1; });
  const auto adapter = std::make_shared<const NativeShapeAdapter>(shape);
  entries_[&shape] = {key, hash, adapter};
  return adapter;
}

}  // namespace vps::bullet
