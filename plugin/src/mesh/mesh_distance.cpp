// SPDX-License-Identifier: BSD-3-Clause
#include "vps/mesh_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include "mesh/directions.h"
#include "mesh/mesh_edges.h"
#include "mesh/triangle_distance.h"
#include "mesh/vertex_normals.h"

namespace vps::inline v0 {
namespace {

/// The distance that counts as contact, relative to the size of the mesh: more than the height of a thin
/// triangle.
constexpr double kTouch = 1e-9;
/// Four children by count limit the depth to log4(2^31), with three waiting children on each level.
constexpr int kStack = 64;

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

namespace {

using Range = std::span<std::uint32_t>;

/// Splits a range of triangles at the median of the boxes' longest side.
std::pair<Range, Range> halved(Range range, const std::vector<Box>& boxes) {
  if (range.size() < 2) return {range, {}};
  Box centers;
  for (const std::uint32_t i : range) centers.add(boxes[i].center());
  int axis = 0;
  centers.size().maxCoeff(&axis);
  const std::size_t half = range.size() / 2;
  const auto at = [&](std::uint32_t i) { return boxes[i].min[axis] + boxes[i].max[axis]; };
  std::nth_element(range.begin(), range.begin() + static_cast<std::ptrdiff_t>(half), range.end(),
                   [&](std::uint32_t a, std::uint32_t b) {  // a strict order: the same tree everywhere
                     return at(a) != at(b) ? at(a) < at(b) : a < b;
                   });
  return {range.first(half), range.subspan(half)};
}

}  // namespace

void MeshDistance::buildTree() {
  const auto count = static_cast<std::uint32_t>(mesh_.triangles.size());
  if (count == 0) return;
  std::vector<Box> boxes(count);
  Box all;
  for (std::uint32_t i = 0; i < count; ++i)
    for (const std::uint32_t v : mesh_.triangles[i]) {
      boxes[i].add(mesh_.vertices[v]);
      all.add(mesh_.vertices[v]);
    }
  center_ = all.center();
  // Boxes and points are rounded to floats relative to the centre: a point as far away as the mesh is large
  // has an error of 2^-24 of that, a corner of a box half as much.
  constexpr double kRounding = 2.5e-7;
  const double margin_m = kRounding * 0.5 * all.size().norm();
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);

  struct Open {
    std::uint32_t node;
    Range range;
  };
  std::vector<Open> open{{0, order}};
  nodes_.reserve(count / 2 + 1);
  nodes_.emplace_back();
  while (!open.empty()) {
    const Open next = open.back();
    open.pop_back();
    const auto [low, high] = halved(next.range, boxes);
    const auto [a, b] = halved(low, boxes);
    const auto [c, d] = halved(high, boxes);
    int lane = 0;
    for (const Range& part : {a, b, c, d}) {
      if (part.empty()) continue;
      Box box;
      for (const std::uint32_t i : part) {
        box.add(boxes[i].min);
        box.add(boxes[i].max);
      }
      std::uint32_t child = kTriangle | part.front();
      if (part.size() > 1) {
        child = static_cast<std::uint32_t>(nodes_.size());
        nodes_.emplace_back();
        open.push_back({child, part});
      }
      nodes_[next.node].set(lane++, (box.min - center_).array() - margin_m,
                            (box.max - center_).array() + margin_m, child);
    }
  }
}

MeshDistance::Node::Node() {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  for (int k = 0; k < 3; ++k) {
    min[k] = Eigen::Array4f::Constant(kFar);
    max[k] = Eigen::Array4f::Constant(-kFar);
  }
}

void MeshDistance::Node::set(int lane, const Vec3& min_m, const Vec3& max_m, std::uint32_t to) {
  for (int k = 0; k < 3; ++k) {
    min[k][lane] = static_cast<float>(min_m[k]);
    max[k][lane] = static_cast<float>(max_m[k]);
  }
  child[lane] = to;
}

/// Squared distances from a point to the four boxes, rounded down.
[[gnu::always_inline]] inline Eigen::Array4f MeshDistance::Node::distance2(const Eigen::Vector3f& p) const {
  // A point far from the mesh, rounded to floats, has an error proportional to its distance.
  constexpr float kRounding = 1 - 2e-6f;
  Eigen::Array4f sum = Eigen::Array4f::Zero();
  for (int k = 0; k < 3; ++k) sum += (min[k] - p[k]).max(p[k] - max[k]).max(0.0f).square();
  return kRounding * sum;
}

[[gnu::always_inline]] inline Eigen::Array<bool, 4, 1> MeshDistance::Node::overlaps(
    const Eigen::Vector3f& low, const Eigen::Vector3f& high) const {
  return min[0] <= high[0] && low[0] <= max[0] && min[1] <= high[1] && low[1] <= max[1] &&
         min[2] <= high[2] && low[2] <= max[2];
}

/// True where the segment middle +- half may meet a box: their shadows overlap along the axes and along the
/// products of the axes with the segment (separating axes).
[[gnu::always_inline]] inline Eigen::Array<bool, 4, 1> MeshDistance::Node::meets(
    const Eigen::Vector3f& middle, const Eigen::Vector3f& half) const {
  // Each product below has a few roundings of floats, relative to the size of its terms.
  constexpr float kRounding = 2e-6f;
  Eigen::Array4f off[3], size[3];
  Eigen::Array<bool, 4, 1> is_met = Eigen::Array<bool, 4, 1>::Constant(true);
  for (int k = 0; k < 3; ++k) {
    off[k] = 0.5f * (min[k] + max[k]) - middle[k];
    size[k] = 0.5f * (max[k] - min[k]) + kRounding * off[k].abs();
    is_met = is_met && off[k].abs() <= size[k] + std::abs(half[k]) * (1 + kRounding);
  }
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const float half_i = std::abs(half[i]), half_j = std::abs(half[j]);
    const Eigen::Array4f reach = size[i] * half_j + size[j] * half_i;
    const Eigen::Array4f rounding = kRounding * (off[i].abs() * half_j + off[j].abs() * half_i + reach);
    is_met = is_met && (off[i] * half[j] - off[j] * half[i]).abs() <= reach + rounding;
  }
  return is_met;
}

namespace {

/// Visits the triangles in those boxes of a tree that are near, in no particular order, until visit(triangle)
/// returns false. Returns true if it never did.
/// @param isNear  of the four boxes of a node
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
    const Eigen::Array<bool, 4, 1> is_near = isNear(node);
    for (int lane = 0; lane < 4; ++lane)
      if (is_near[lane]) stack[waiting++] = node.child[lane];
  }
  return true;
}

}  // namespace

void MeshDistance::appendCrossings(const Vec3& a, const Vec3& b, std::vector<double>& out) const {
  // Barycentric coordinates round by 1e-11 where a facet is long and thin and the segment grazes it. A
  // crossing at a shared border must not fall between both; one too many only divides a segment once more.
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

/// Visits triangles in order of distance and calls onNearer(triangle, point) for each that is nearer than all
/// before and than max_m; returns the least squared distance. Skips boxes whose squared distance times
/// box_weight is not less.
template <typename Visit>
double MeshDistance::search(const Vec3& p, double max_m, double box_weight, Visit onNearer) const noexcept {
  double best2 = max_m * max_m;
  if (nodes_.empty()) return best2;
  struct Waiting {
    std::uint32_t child;
    float distance2;
  };
  const Eigen::Vector3f from_center = (p - center_).cast<float>();
  Waiting stack[kStack];
  int waiting = 0;
  stack[waiting++] = {0, 0};
  while (waiting > 0) {
    const Waiting next = stack[--waiting];
    if (box_weight * static_cast<double>(next.distance2) >= best2) continue;
    if ((next.child & kTriangle) != 0) {
      const std::uint32_t triangle = next.child & ~kTriangle;
      const auto& t = mesh_.triangles[triangle];
      const TrianglePoint at =
          closestOnTriangleInline(p, mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
      const double distance2 = (p - at.q).squaredNorm();
      if (distance2 >= best2) continue;
      best2 = distance2;
      onNearer(triangle, at);
      continue;
    }
    const Node& node = nodes_[next.child];
    const Eigen::Array4f distance2 = node.distance2(from_center);
    const int first = waiting;
    for (int lane = 0; lane < 4; ++lane) {
      const Waiting child{node.child[lane], distance2[lane]};
      if (!(box_weight * static_cast<double>(child.distance2) < best2)) continue;
      int at = waiting++;  // the nearest is on top
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

/// The pseudonormal at a point of the surface from all facets that touch it, each weighted by the angle that
/// it covers around the point.
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

}  // namespace vps::inline v0
