// SPDX-License-Identifier: BSD-3-Clause
#include "native_shapes/native_shape_adapter.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <span>

#include "native_shapes/content_hash.h"
#include "native_shapes/native_shape_mesh.h"
#include "native_shapes/primitive.h"
#include "shape/sheet_border.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {

namespace {

/// Sorts points so that each sixteen in a row are near each other.
void sortInSpace(std::vector<std::uint32_t>& order, std::size_t begin, std::size_t end,
                 const std::vector<Vec3>& points) {
  if (end - begin <= static_cast<std::size_t>(kLanes)) return;
  Box box;
  for (std::size_t i = begin; i < end; ++i) box.add(points[order[i]]);
  int axis = 0;
  box.size().maxCoeff(&axis);
  const std::size_t leaves = (end - begin + kLanes - 1) / kLanes;
  const std::size_t middle = begin + leaves / 2 * kLanes;
  const auto at = [&](std::size_t k) { return order.begin() + static_cast<std::ptrdiff_t>(k); };
  std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
    return points[a][axis] != points[b][axis] ? points[a][axis] < points[b][axis] : a < b;
  });
  sortInSpace(order, begin, middle, points);
  sortInSpace(order, middle, end, points);
}

// Area of a corner, which penalty contact needs: a square of half a millimetre. Assumed: as much as a shell
// point represents.
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

PointShell leafOf(const Corners& corners, const std::uint32_t* ids, std::size_t count) {
  PointShell leaf;
  Box box;
  for (std::size_t i = 0; i < count; ++i) {
    leaf.points.push_back(corners.points[ids[i]]);
    leaf.inward.push_back(corners.inward[ids[i]]);
    leaf.area_m2.push_back(kCornerArea_m2);
    box.add(leaf.points.back());
  }
  ShellNode node;
  node.center = box.center();
  node.radius_m = 0.5 * box.size().norm() * (1 + 1e-12);
  node.count = static_cast<std::uint32_t>(count);
  node.skip = 1;
  node.is_leaf = true;
  leaf.nodes = {node};
  return leaf;
}

/// A hierarchy over leaves in a row, so that a walk leaves out many of them at once.
void addHalves(std::span<const ShellNode> leaves, const std::vector<Vec3>& points,
               std::vector<ShellNode>& nodes) {
  const std::size_t index = nodes.size();
  ShellNode& node = nodes.emplace_back(leaves.front());
  if (leaves.size() > 1) {
    node.is_leaf = false;
    node.count = leaves.back().first + leaves.back().count - node.first;
    Box box;
    for (const Vec3& p : std::span(points).subspan(node.first, node.count)) box.add(p);
    node.center = box.center();
    node.radius_m = 0.5 * box.size().norm() * (1 + 1e-12);
    const std::size_t half = leaves.size() / 2;  // as sortInSpace()
    addHalves(leaves.first(half), points, nodes);
    addHalves(leaves.subspan(half), points, nodes);
  }
  nodes[index].skip = static_cast<std::uint32_t>(nodes.size());
}

PointShell shellOf(const Corners& corners) {
  const std::size_t count = corners.points.size();
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  sortInSpace(order, 0, count, corners.points);
  std::vector<PointShell> leaves;
  for (std::size_t first = 0; first < count; first += kLanes)
    leaves.push_back(leafOf(corners, &order[first], std::min<std::size_t>(kLanes, count - first)));
  std::vector<const PointShell*> pointers;
  for (const PointShell& leaf : leaves) pointers.push_back(&leaf);
  PointShell shell = mergedShells(pointers, std::vector<Pose>(leaves.size()));
  std::vector<ShellNode> last;
  std::copy_if(shell.nodes.begin(), shell.nodes.end(), std::back_inserter(last),
               [](const ShellNode& node) { return node.is_leaf; });
  shell.nodes.clear();
  if (!last.empty()) addHalves(last, shell.points, shell.nodes);
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
