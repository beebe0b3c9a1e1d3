// SPDX-License-Identifier: BSD-3-Clause
#include "vps/mesh_distance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh_edges.h"
#include "triangle_distance.h"

namespace vps {
namespace {

constexpr std::uint32_t kLeafTriangles = 4;
/// Halving by count makes the depth log2(2^32 / kLeafTriangles) at most; one waiting child a level.
constexpr int kStack = 64;

double boxDistance2(const Vec3& p, const Vec3& min, const Vec3& max) {
  return (min - p).cwiseMax(p - max).cwiseMax(0.0).squaredNorm();
}

/// Unit v, or zero where v is too short to have a direction.
Vec3 unitOrZero(const Vec3& v) {
  const double length = v.norm();
  return length > 0 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

/// The angle between u and v; atan2 keeps its accuracy near 0 and pi, where acos loses half the digits.
double angleBetween(const Vec3& u, const Vec3& v) {
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

}  // namespace

TrianglePoint closestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  return closestOnTriangleInline(p, a, b, c);
}

MeshDistance::MeshDistance(const Mesh& mesh) : mesh_(mesh) {
  computeNormals();
  buildTree();
}

void MeshDistance::computeNormals() {
  const std::size_t count = mesh_.triangles.size();
  face_normals_.resize(count);
  edge_normals_.assign(count, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()});
  vertex_normals_.assign(mesh_.vertices.size(), Vec3::Zero());
  for (std::size_t i = 0; i < count; ++i) {
    const auto& t = mesh_.triangles[i];
    const Vec3 corner[3] = {mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]};
    face_normals_[i] = unitOrZero((corner[1] - corner[0]).cross(corner[2] - corner[0]));
    for (int k = 0; k < 3; ++k) {
      const double angle_rad = angleBetween(corner[(k + 1) % 3] - corner[k], corner[(k + 2) % 3] - corner[k]);
      vertex_normals_[t[k]] += angle_rad * face_normals_[i];
    }
  }
  forEachEdge(sortedHalfEdges(mesh_), [&](std::span<const HalfEdge> same) {
    Vec3 sum = Vec3::Zero();
    for (const HalfEdge& e : same) sum += face_normals_[e.triangle];
    for (const HalfEdge& e : same) edge_normals_[e.triangle][e.side] = unitOrZero(sum);
  });
  for (Vec3& n : vertex_normals_) n = unitOrZero(n);
}

void MeshDistance::buildTree() {
  const auto count = static_cast<std::uint32_t>(mesh_.triangles.size());
  std::vector<Box> boxes(count);
  for (std::uint32_t i = 0; i < count; ++i)
    for (const std::uint32_t v : mesh_.triangles[i]) boxes[i].add(mesh_.vertices[v]);
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0u);
  if (count == 0) return;

  // Each node is first a leaf over its range, then split at the median of its longest side until small
  // enough.
  nodes_.reserve(2 * (count / 2 + 1));
  nodes_.push_back({Vec3::Zero(), Vec3::Zero(), 0, count});
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const std::uint32_t first = nodes_[n].first, size = nodes_[n].count;
    Box box, centers;
    for (std::uint32_t i = first; i < first + size; ++i) {
      box.add(boxes[order_[i]].min);
      box.add(boxes[order_[i]].max);
      centers.add(boxes[order_[i]].center());
    }
    nodes_[n].min = box.min;
    nodes_[n].max = box.max;
    if (size <= kLeafTriangles) continue;
    int axis = 0;
    centers.size().maxCoeff(&axis);
    const std::uint32_t half = size / 2;
    const auto range = order_.begin() + first;
    std::nth_element(range, range + half, range + size, [&](std::uint32_t a, std::uint32_t b) {
      const double at_a = boxes[a].min[axis] + boxes[a].max[axis],
                   at_b = boxes[b].min[axis] + boxes[b].max[axis];
      return at_a != at_b ? at_a < at_b : a < b;  // a strict order, so that the tree is the same everywhere
    });
    nodes_[n].first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[n].count = 0;
    nodes_.push_back({Vec3::Zero(), Vec3::Zero(), first, half});
    nodes_.push_back({Vec3::Zero(), Vec3::Zero(), first + half, size - half});
  }
}

MeshDistance::Closest MeshDistance::closest(const Vec3& p, double max_m) const noexcept {
  Closest best;
  best.distance_m = max_m;
  if (nodes_.empty()) return best;
  double best2 = max_m * max_m;
  int feature = 0;

  struct Waiting {
    std::uint32_t node;
    double distance2;
  };
  Waiting stack[kStack];
  int waiting = 0;
  stack[waiting++] = {0, boxDistance2(p, nodes_[0].min, nodes_[0].max)};
  while (waiting > 0) {
    const Waiting next = stack[--waiting];
    if (next.distance2 >= best2) continue;
    const Node& node = nodes_[next.node];
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const auto& t = mesh_.triangles[order_[i]];
        const TrianglePoint at =
            closestOnTriangleInline(p, mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
        const double distance2 = (p - at.q).squaredNorm();
        if (distance2 < best2) {
          best2 = distance2;
          best.q = at.q;
          best.triangle = order_[i];
          best.found = true;
          feature = at.feature;
        }
      }
      continue;
    }
    const Node &left = nodes_[node.first], &right = nodes_[node.first + 1];
    Waiting near = {node.first, boxDistance2(p, left.min, left.max)};
    Waiting far = {node.first + 1, boxDistance2(p, right.min, right.max)};
    if (far.distance2 < near.distance2) std::swap(near, far);
    if (far.distance2 < best2) stack[waiting++] = far;
    if (near.distance2 < best2) stack[waiting++] = near;
  }
  if (best.found) {
    best.distance_m = std::sqrt(best2);
    best.normal = featureNormal(best.triangle, feature);
  }
  return best;
}

double MeshDistance::signedDistance(const Vec3& p, double max_m) const noexcept {
  const Closest nearest = closest(p, max_m);
  const bool is_inside = nearest.found && nearest.normal.dot(p - nearest.q) < 0;
  return is_inside ? -nearest.distance_m : nearest.distance_m;
}

Vec3 MeshDistance::featureNormal(std::uint32_t triangle, int feature) const noexcept {
  if (feature == 0) return face_normals_[triangle];
  if (feature <= 3) return edge_normals_[triangle][feature - 1];
  return vertex_normals_[mesh_.triangles[triangle][feature - 4]];
}

}  // namespace vps
