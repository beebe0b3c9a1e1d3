// SPDX-License-Identifier: BSD-3-Clause
#include "voxelise/surface_features.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mesh/normals.h"
#include "mesh/triangle_distance.h"

namespace vps {
namespace {

/// A triangle lower than this fraction of a voxel is replaced by its edges, which are as near.
constexpr double kMinHeight = 1e-7;
/// A triangle lower than this fraction of its longest side is replaced too, since its normal is rounding
/// noise.
constexpr double kMinSlimness = 1e-12;

std::uint32_t next(std::uint32_t side) {
  return side == 2 ? 0 : side + 1;
}

}  // namespace

SurfaceFeatures::SurfaceFeatures(const Mesh& mesh, double voxel_m, const Vec3& origin)
    : triangles_(mesh.triangles) {
  points_.reserve(mesh.vertices.size());
  for (const Vec3& p : mesh.vertices) points_.emplace_back(p / voxel_m - origin);
  computeNormals();
  collectCorners();
  collectEdges();
  if (has_thin_) nameSides();
}

void SurfaceFeatures::computeNormals() {
  normals_.reserve(triangles_.size());
  for (const auto& t : triangles_) {
    const Vec3 ab = points_[t[1]] - points_[t[0]], ac = points_[t[2]] - points_[t[0]];
    const Vec3 n = ab.cross(ac);
    const double twice_area = n.norm();
    const double longest = std::sqrt(std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()}));
    const bool is_thin = !(twice_area > longest * std::max(kMinHeight, kMinSlimness * longest));
    has_thin_ = has_thin_ || is_thin;
    normals_.emplace_back(is_thin ? Vec3(Vec3::Zero()) : Vec3(n / twice_area));
  }
}

void SurfaceFeatures::collectCorners() {
  first_corner_.assign(points_.size() + 1, 0);
  for (const auto& t : triangles_)
    for (const std::uint32_t v : t) ++first_corner_[v];
  std::uint32_t sum = 0;
  for (std::uint32_t& first : first_corner_) sum += std::exchange(first, sum);
  corners_.resize(sum);
  for (std::uint32_t i = 0; i < triangles_.size(); ++i)
    for (std::uint32_t k = 0; k < 3; ++k) corners_[first_corner_[triangles_[i][k]]++] = {i, k};
  // Filling has moved each start to the next start; move them back.
  for (std::size_t v = points_.size(); v > 0; --v) first_corner_[v] = first_corner_[v - 1];
  first_corner_[0] = 0;
}

void SurfaceFeatures::collectEdges() {
  struct Outgoing {
    std::uint32_t to;
    TriangleSide side;
    bool is_forward;
  };
  std::vector<Outgoing> at;
  edges_.reserve(triangles_.size() * 3 / 2 + 1);
  sides_.reserve(triangles_.size() * 3);
  is_regular_.assign(points_.size(), 1);
  for (std::uint32_t v = 0; v < points_.size(); ++v) {
    at.clear();
    for (const TriangleSide corner : sidesFrom(v)) {
      const auto& t = triangles_[corner.triangle];
      const std::uint32_t one = next(corner.side), two = next(one);
      if (t[one] > v) at.push_back({t[one], corner, true});
      if (t[two] > v) at.push_back({t[two], {corner.triangle, two}, false});
    }
    std::sort(at.begin(), at.end(), [](const Outgoing& x, const Outgoing& y) {
      return x.to != y.to ? x.to < y.to : x.side.triangle < y.side.triangle;
    });
    for (std::size_t i = 0; i < at.size();) {
      edges_.push_back({v, at[i].to, static_cast<std::uint32_t>(sides_.size())});
      const std::size_t begin = i;
      for (; i < at.size() && at[i].to == edges_.back().b; ++i) sides_.push_back(at[i].side);
      if (i - begin != 2 || at[begin].is_forward == at[begin + 1].is_forward)
        is_regular_[v] = is_regular_[edges_.back().b] = 0;
    }
  }
  edges_.push_back({0, 0, static_cast<std::uint32_t>(sides_.size())});
}

Vec3 SurfaceFeatures::pseudonormal(std::uint32_t vertex) const {
  Vec3 sum = Vec3::Zero();
  for (const TriangleSide corner : sidesFrom(vertex)) {
    const auto& t = triangles_[corner.triangle];
    const Vec3 u = points_[t[next(corner.side)]] - points_[vertex];
    const Vec3 v = points_[t[next(next(corner.side))]] - points_[vertex];
    sum += angleBetween(u, v) * normals_[corner.triangle];
  }
  return sum;
}

void SurfaceFeatures::nameSides() {
  edge_of_.assign(3 * triangles_.size(), 0);
  for (std::uint32_t edge = 0; edge < edgeCount(); ++edge)
    for (const TriangleSide side : sidesOf(edge)) edge_of_[3 * std::size_t{side.triangle} + side.side] = edge;
}

bool SurfaceFeatures::hasThin(std::span<const TriangleSide> sides) const {
  return has_thin_ && std::any_of(sides.begin(), sides.end(),
                                  [&](TriangleSide side) { return normals_[side.triangle].isZero(); });
}

/// The angle that a triangle covers at a point q of its boundary; 0 where it does not touch q.
double SurfaceFeatures::angleAt(const Vec3& q, std::uint32_t triangle) const {
  const auto& t = triangles_[triangle];
  const Vec3 p[3] = {points_[t[0]], points_[t[1]], points_[t[2]]};
  for (std::uint32_t k = 0; k < 3; ++k)
    if ((p[k] - q).norm() < kTouch) return angleBetween(p[next(k)] - p[k], p[next(next(k))] - p[k]);
  for (std::uint32_t k = 0; k < 3; ++k)
    if (distanceToSegment(q, p[k], p[next(k)]) < kTouch) return std::numbers::pi;
  return 0;
}

Vec3 SurfaceFeatures::pseudonormalThrough(const Vec3& q, std::span<const TriangleSide> around) const {
  Vec3 sum = Vec3::Zero();
  std::vector<std::uint32_t> seen;
  const auto see = [&](TriangleSide side) {
    if (std::find(seen.begin(), seen.end(), side.triangle) == seen.end()) seen.push_back(side.triangle);
  };
  for (const TriangleSide side : around) see(side);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const double angle_rad = angleAt(q, seen[i]);
    sum += angle_rad * normals_[seen[i]];
    if (angle_rad == 0 || !normals_[seen[i]].isZero()) continue;
    for (std::uint32_t k = 0; k < 3; ++k)
      for (const TriangleSide side : sidesOf(edge_of_[3 * std::size_t{seen[i]} + k])) see(side);
  }
  return sum;
}

}  // namespace vps
