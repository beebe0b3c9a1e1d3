// SPDX-License-Identifier: BSD-3-Clause
#include "vps/mesh_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "mesh/mesh_edges.h"
#include "mesh/normals.h"
#include "mesh/triangle_distance.h"

namespace vps {
namespace {

/// The distance that counts as contact, relative to the size of the mesh; greater than the height of a thin
/// triangle.
constexpr double kTouch = 1e-9;
/// Size of the stack of a search: on each level of the tree seven children may wait while the eighth is
/// visited.
constexpr int kStack = 256;

Vec3 normalOrZero(const Vec3& a, const Vec3& b, const Vec3& c) {
  return hasArea(a, b, c) ? unitOrZero((b - a).cross(c - a)) : Vec3(Vec3::Zero());
}

}  // namespace

TrianglePoint closestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  return closestOnTriangleInline(p, a, b, c);
}

MeshDistance::MeshDistance(const Mesh& mesh) : mesh_(mesh) {
  computeNormals();
  computeSmoothCorners();
  buildTree();
}

void MeshDistance::computeNormals() {
  const std::size_t count = mesh_.triangles.size();
  face_normals_.resize(count);
  edge_normals_.assign(count, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()});
  is_thin_.assign(count, 0);
  is_edge_of_thin_.assign(count, 0);
  is_corner_of_thin_.assign(mesh_.vertices.size(), 0);
  if (count > 0) touch_m_ = kTouch * bounds(mesh_).size().norm();
  for (std::size_t i = 0; i < count; ++i) {
    const auto& t = mesh_.triangles[i];
    const Vec3 corner[3] = {mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]};
    face_normals_[i] = normalOrZero(corner[0], corner[1], corner[2]);
    is_thin_[i] = face_normals_[i].isZero(0);
    for (int k = 0; k < 3 && is_thin_[i] != 0; ++k) is_corner_of_thin_[t[k]] = 1;
  }
  vertex_normals_ = angleWeightedNormals(mesh_, face_normals_);
  forEachEdge(sortedHalfEdges(mesh_), [&](std::span<const HalfEdge> same) {
    Vec3 sum = Vec3::Zero();
    for (const HalfEdge& e : same) sum += face_normals_[e.triangle];
    const bool is_beside_thin =
        std::any_of(same.begin(), same.end(), [&](const HalfEdge& e) { return is_thin_[e.triangle] != 0; });
    for (const HalfEdge& e : same) {
      edge_normals_[e.triangle][e.side] = unitOrZero(sum);
      if (is_beside_thin) is_edge_of_thin_[e.triangle] |= static_cast<std::uint8_t>(1 << e.side);
    }
  });
  for (Vec3& n : vertex_normals_) n = unitOrZero(n);
}

/// Squared distances from a point to the boxes, rounded down.
[[gnu::always_inline]] inline MeshDistance::Lanes MeshDistance::Node::distance2(
    const Eigen::Vector3f& p) const {
  // A point far from the mesh, rounded to floats, has an error proportional to its distance.
  constexpr float kRounding = 1 - 2e-6f;
  Lanes sum = Lanes::Zero();
  for (int k = 0; k < 3; ++k) sum += (lowest(k) - p[k]).max(p[k] - highest(k)).max(0.0f).square();
  return kRounding * sum;
}

[[gnu::always_inline]] inline MeshDistance::IsLane MeshDistance::Node::overlaps(
    const Eigen::Vector3f& low, const Eigen::Vector3f& high) const {
  IsLane is_met = IsLane::Constant(true);
  for (int k = 0; k < 3; ++k) is_met = is_met && lowest(k) <= high[k] && low[k] <= highest(k);
  return is_met;
}

/// True where the segment middle +- half may meet a box: their projections overlap on the axes and on the
/// cross products of the axes with the segment (separating axes).
[[gnu::always_inline]] inline MeshDistance::IsLane MeshDistance::Node::meets(
    const Eigen::Vector3f& middle, const Eigen::Vector3f& half) const {
  // Each product below has a few roundings of floats, relative to the size of its terms.
  constexpr float kRounding = 2e-6f;
  Lanes off[3], size[3];
  IsLane is_met = IsLane::Constant(true);
  for (int k = 0; k < 3; ++k) {
    off[k] = 0.5f * (lowest(k) + highest(k)) - middle[k];
    size[k] = 0.5f * (highest(k) - lowest(k)) + kRounding * off[k].abs();
    is_met = is_met && off[k].abs() <= size[k] + std::abs(half[k]) * (1 + kRounding);
  }
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const float half_i = std::abs(half[i]), half_j = std::abs(half[j]);
    const Lanes reach = size[i] * half_j + size[j] * half_i;
    const Lanes rounding = kRounding * (off[i].abs() * half_j + off[j].abs() * half_i + reach);
    is_met = is_met && (off[i] * half[j] - off[j] * half[i]).abs() <= reach + rounding;
  }
  return is_met;
}

namespace {

/// Visits the triangles in the near boxes of a tree, in no particular order, until visit(triangle) returns
/// false. Returns true if visit() never returned false.
/// @param isNear  returns for each box of a node whether it is near
template <typename Nodes, typename IsNear, typename Visit>
bool descend(const Nodes& nodes, std::uint32_t triangle_bit, IsNear isNear, Visit visit) {
  std::uint32_t stack[kStack];
  int waiting = 0;
  if (!nodes.empty()) stack[waiting++] = 0;
  while (waiting > 0) {
    const std::uint32_t next = stack[--waiting];
    if ((next & triangle_bit) != 0) {
      if (!visit(next & ~triangle_bit)) return false;
      continue;
    }
    const auto& node = nodes[next];
    const auto is_near = isNear(node);
    for (int lane = 0; lane < is_near.size(); ++lane)
      if (is_near[lane] && node.child[lane] != 0) stack[waiting++] = node.child[lane];  // 0: unused
  }
  return true;
}

}  // namespace

void MeshDistance::appendCrossings(const Vec3& a, const Vec3& b, std::vector<double>& out) const {
  // Barycentric coordinates have an error of 1e-11 where a facet is long and thin and the segment grazes it.
  // A crossing at a border shared by two facets must not be missed; a crossing counted twice only divides a
  // segment once more.
  constexpr double kBorder = -1e-9;
  const Eigen::Vector3f middle = (0.5 * (a + b) - center_).cast<float>(),
                        half = (0.5 * (b - a)).cast<float>();
  descend(
      nodes_, kTriangle, [&](const Node& node) { return node.meets(middle, half); },
      [&](std::uint32_t triangle) {
        const auto& t = mesh_.triangles[triangle];
        const Vec3& corner = mesh_.vertices[t[0]];
        const Vec3 u = mesh_.vertices[t[1]] - corner, v = mesh_.vertices[t[2]] - corner, n = u.cross(v);
        const double above_a = n.dot(a - corner), above_b = n.dot(b - corner);
        if ((above_a > 0) == (above_b > 0)) return true;
        const double fraction = above_a / (above_a - above_b);
        const Vec3 q = a + fraction * (b - a) - corner;
        const double n2 = n.squaredNorm();
        const double along_u = q.cross(v).dot(n) / n2, along_v = u.cross(q).dot(n) / n2;
        if (along_u >= kBorder && along_v >= kBorder && along_u + along_v <= 1 - kBorder)
          out.push_back(fraction);
        return true;
      });
}

bool MeshDistance::overlapping(const Box& box, std::size_t most,
                               std::vector<std::uint32_t>& triangles) const {
  triangles.clear();
  // The nodes' boxes have a margin for the rounding of points inside the mesh's box.
  const Eigen::Vector3f low = (box.min - center_).cast<float>(), high = (box.max - center_).cast<float>();
  return descend(
      nodes_, kTriangle, [&](const Node& node) { return node.overlaps(low, high); },
      [&](std::uint32_t triangle) {
        if (triangles.size() == most) return false;
        triangles.push_back(triangle);
        return true;
      });
}

/// Visits triangles in order of distance. Calls onNearer(triangle, point) for each triangle that is nearer
/// than max_m and than all triangles before (or as near, with a lower number, so that the tree's order does
/// not matter). Returns the least squared distance. Skips boxes whose squared distance times box_weight is
/// greater.
template <typename Visit>
double MeshDistance::search(const Vec3& p, double max_m, double box_weight, Visit onNearer) const noexcept {
  double best2 = max_m * max_m;
  if (nodes_.empty()) return best2;
  std::uint32_t best_triangle = 0;  // no triangle has a lower number
  // The limit is rounded up to a float, and finite: unused lanes are infinitely far.
  const auto limitOf = [box_weight](double squared) {
    constexpr float kRoundingUp = 1 + 4e-7f, kMost = std::numeric_limits<float>::max() / 2;
    return kRoundingUp * static_cast<float>(std::min(squared / box_weight, static_cast<double>(kMost)));
  };
  float limit2 = limitOf(best2);
  struct Waiting {
    std::uint32_t child;
    float distance2;
  };
  const Eigen::Vector3f from_center = (p - center_).cast<float>();
  static_assert(7 * kMostLevels + 1 <= kStack);
  Waiting stack[kStack];
  int waiting = 0;
  stack[waiting++] = {0, 0};
  while (waiting > 0) {
    const Waiting next = stack[--waiting];
    if (next.distance2 > limit2) continue;
    if ((next.child & kTriangle) != 0) {
      const std::uint32_t triangle = next.child & ~kTriangle;
      const auto& t = mesh_.triangles[triangle];
      const TrianglePoint at =
          closestOnTriangleInline(p, mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
      const double distance2 = (p - at.q).squaredNorm();
      if (!(distance2 < best2 || (distance2 == best2 && triangle < best_triangle))) continue;
      best2 = distance2;
      limit2 = limitOf(best2);
      best_triangle = triangle;
      onNearer(triangle, at);
      continue;
    }
    const Node& node = nodes_[next.child];
    float distance2[kLanes];
    Eigen::Map<Lanes>{distance2} = node.distance2(from_center);
    // Collect all near lanes without a branch that could be mispredicted, then sort the nearest to the top.
    int near[kLanes], count = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
      near[count] = lane;
      count += static_cast<int>(distance2[lane] <= limit2);
    }
    const int first = waiting;
    for (int i = 0; i < count; ++i) {
      const Waiting child{node.child[near[i]], distance2[near[i]]};
      int at = waiting++;
      for (; at > first && stack[at - 1].distance2 < child.distance2; --at) stack[at] = stack[at - 1];
      stack[at] = child;
    }
  }
  return best2;
}

MeshDistance::Closest MeshDistance::closest(const Vec3& p, double max_m) const noexcept {
  Closest best;
  int feature = 0;
  const double best2 = search(p, max_m, 1, [&](std::uint32_t triangle, const TrianglePoint& at) {
    best.q = at.q;
    best.triangle = triangle;
    best.found = true;
    feature = at.feature;
    __builtin_prefetch(&is_thin_[triangle]);
    __builtin_prefetch(&face_normals_[triangle]);
  });
  best.distance_m = best.found ? std::sqrt(best2) : max_m;
  if (best.found)
    best.normal =
        isNextToThin(best.triangle, feature) ? normalThrough(best.q) : featureNormal(best.triangle, feature);
  return best;
}

double MeshDistance::lowerBound(const Vec3& p, double slack, double max_m) const noexcept {
  // Skipped triangles are at least best / (1 + slack) away.
  const double weight = (1 + slack) * (1 + slack);
  return std::sqrt(search(p, max_m, weight, [](std::uint32_t, const TrianglePoint&) {})) / (1 + slack);
}

double MeshDistance::signedDistance(const Vec3& p, double max_m) const noexcept {
  const Closest nearest = closest(p, max_m);
  const bool is_inside = nearest.found && nearest.normal.dot(p - nearest.q) < 0;
  return is_inside ? -nearest.distance_m : nearest.distance_m;
}

bool MeshDistance::isNextToThin(std::uint32_t triangle, int feature) const noexcept {
  if (is_thin_[triangle] != 0) return true;
  if (feature == 0) return false;
  if (feature <= 3) return (is_edge_of_thin_[triangle] >> (feature - 1) & 1) != 0;
  return is_corner_of_thin_[mesh_.triangles[triangle][feature - 4]] != 0;
}

/// The pseudonormal at a point of the surface, from all facets that touch the point. Each facet is weighted
/// by the angle that it covers around the point.
Vec3 MeshDistance::normalThrough(const Vec3& q) const noexcept {
  Vec3 sum = Vec3::Zero();
  const Eigen::Vector3f from_center = (q - center_).cast<float>();
  descend(
      nodes_, kTriangle,
      [&](const Node& node) {
        return (node.distance2(from_center).cast<double>() <= touch_m_ * touch_m_).eval();
      },
      [&](std::uint32_t triangle) {
        const auto& t = mesh_.triangles[triangle];
        const Vec3 corner[3] = {mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]};
        if ((closestOnTriangleInline(q, corner[0], corner[1], corner[2]).q - q).norm() > touch_m_)
          return true;
        double angle_rad = std::numbers::pi;
        for (int k = 0; k < 3; ++k)
          if ((corner[k] - q).norm() <= touch_m_)
            angle_rad = angleBetween(corner[(k + 1) % 3] - corner[k], corner[(k + 2) % 3] - corner[k]);
        sum += angle_rad * face_normals_[triangle];
        return true;
      });
  return unitOrZero(sum);
}

Vec3 MeshDistance::featureNormal(std::uint32_t triangle, int feature) const noexcept {
  if (feature == 0) return face_normals_[triangle];
  if (feature <= 3) return edge_normals_[triangle][feature - 1];
  return vertex_normals_[mesh_.triangles[triangle][feature - 4]];
}

}  // namespace vps
