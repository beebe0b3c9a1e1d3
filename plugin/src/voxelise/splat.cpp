// SPDX-License-Identifier: BSD-3-Clause
#include "voxelise/splat.h"

#include <algorithm>
#include <cmath>

namespace vps {
namespace {

/// Margin around a region in which its feature is still used. The margin is more than rounding moves a
/// border, so that no node falls between two regions, and less than a float distance can resolve.
constexpr double kBorder = 1e-7;
/// If the faces at an edge turn by less than this, the edge has no region: within the band the region is
/// narrower than kBorder.
constexpr double kFlat = 1e-9;

double taxicab(const Vec3& v) {
  return v.cwiseAbs().sum();
}

void widen(Box& box, const Vec3& by) {
  box.min -= by;
  box.max += by;
}

void put(float* node, double distance) {
  const auto d = static_cast<float>(distance);
  *node = std::abs(d) < std::abs(*node) ? d : *node;
}

}  // namespace

/// The region of a face: the prism above and below a triangle.
struct Splatter::Face {
  Vec3 n, side[3];
  double n_at, side_at[3], border[3];
  double band;
  Box box;

  Face(const SurfaceFeatures& features, std::uint32_t i, const Vec3& origin, double band_voxels)
      : band(band_voxels) {
    const auto& t = features.triangle(i);
    n = features.normal(i);
    if (n.isZero()) return;
    const Vec3 p[3] = {features.point(t[0]) - origin, features.point(t[1]) - origin,
                       features.point(t[2]) - origin};
    n_at = -n.dot(p[0]);
    for (int k = 0; k < 3; ++k) {
      const Vec3 along = p[(k + 1) % 3] - p[k];
      side[k] = n.cross(along);
      side_at[k] = -side[k].dot(p[k]);
      border[k] = taxicab(along);
      box.add(p[k]);
    }
    widen(box, band * n.cwiseAbs());
  }

  void planes(SplatRegion& region) const {
    for (int k = 0; k < 3; ++k) region.add(side[k].x(), side[k].y(), side[k].z(), side_at[k], border[k]);
    region.add(n.x(), n.y(), n.z(), n_at + band, 1);
    region.add(-n.x(), -n.y(), -n.z(), band - n_at, 1);
  }

  void write(const SplatRow& row, float* tile) const {
    const Vec3 p(row.x, row.y, 0);
    const double at = n.dot(p) + n_at;
    const double s0 = side[0].dot(p) + side_at[0] + kBorder * border[0];
    const double s1 = side[1].dot(p) + side_at[1] + kBorder * border[1];
    const double s2 = side[2].dot(p) + side_at[2] + kBorder * border[2];
    float* nodes = tile + tileIndex(row.x, row.y, 0);
    for (int z = row.low; z <= row.high; ++z) {
      const double d = at + n.z() * z;
      const double within = std::min({s0 + side[0].z() * z, s1 + side[1].z() * z, s2 + side[2].z() * z});
      if (within >= 0 && std::abs(d) < band) put(nodes + z, d);
    }
  }
};

/// The region of an edge: the wedge about it.
struct Splatter::Edge {
  Vec3 a, along, pseudonormal = Vec3::Zero();
  double length, band;
  Box box;
  std::span<const TriangleSide> sides;
  const SurfaceFeatures& features;
  const Vec3 from;  // the tile's origin
  bool is_by_thin;

  Edge(const SurfaceFeatures& surface, std::uint32_t i, const Vec3& origin, double band_voxels)
      : band(band_voxels), features(surface), from(origin) {
    const SurfaceFeatures::Edge& edge = features.edge(i);
    a = features.point(edge.a) - origin;
    const Vec3 b = features.point(edge.b) - origin;
    along = b - a;
    length = along.norm();
    along /= length;
    sides = features.sidesOf(i);
    is_by_thin = features.hasThin(sides);
    for (const TriangleSide side : sides) pseudonormal += features.normal(side.triangle);
    box.add(a);
    box.add(b);
    bound();
  }

  /// The pseudonormal if a triangle at the edge has no normal. The foot of the perpendicular counts as within
  /// the edge even if t is at its end, or past it by rounding, because only facets along the edge matter.
  [[nodiscard]] Vec3 normalAt(double t) const {
    const double margin = std::min(2 * SurfaceFeatures::kTouch, 0.5 * length);
    const double within = std::clamp(t, margin, length - margin);
    return features.pseudonormalThrough(from + a + within * along, sides);
  }

  /// The direction into a face, at a right angle to the edge; zero for a face without a normal.
  [[nodiscard]] Vec3 into(TriangleSide side) const {
    const auto& t = features.triangle(side.triangle);
    const Vec3 m = features.normal(side.triangle).cross(along);
    return t[side.side] < t[(side.side + 1) % 3] ? m : Vec3(-m);
  }

  void bound() {
    if (sides.size() == 2) {
      const Vec3 &n1 = features.normal(sides[0].triangle), &n2 = features.normal(sides[1].triangle);
      const double cosine = n1.dot(n2), rise = into(sides[0]).dot(n2);
      if (cosine > 0) {
        if (std::abs(rise) < kFlat) {
          box = Box();
          return;
        }
        // The body is below both faces at a convex edge: only the outer side can be nearest to the edge, and
        // only the inner side at a concave edge. The arc between the normals lies within its two tangents.
        const double tangent = (rise < 0 ? band : -band) * std::sqrt(2 / (1 + cosine));
        const Vec3 low = (tangent * n1).cwiseMin(tangent * n2).cwiseMin(0.0);
        const Vec3 high = (tangent * n1).cwiseMax(tangent * n2).cwiseMax(0.0);
        box.min += low;
        box.max += high;
        return;
      }
    }
    widen(box, Vec3::Constant(band));
  }

  void planes(SplatRegion& region) const {
    const double at = along.dot(a);
    region.add(along.x(), along.y(), along.z(), -at, 1);
    region.add(-along.x(), -along.y(), -along.z(), at + length, 1);
    for (std::size_t k = 0; k < std::min<std::size_t>(sides.size(), 4); ++k) {
      const Vec3 m = into(sides[k]);
      region.add(-m.x(), -m.y(), -m.z(), m.dot(a), 1);
    }
  }

  void write(const SplatRow& row, float* tile) const {
    for (int z = row.low; z <= row.high; ++z) {
      const Vec3 r = Vec3(row.x, row.y, z) - a;
      const double t = along.dot(r);
      if (t < -kBorder || t > length + kBorder) continue;
      bool is_beyond = true;
      for (const TriangleSide side : sides) is_beyond = is_beyond && into(side).dot(r) <= kBorder;
      if (!is_beyond) continue;
      const double d = (r - t * along).norm();
      if (d >= band) continue;
      const Vec3 n = is_by_thin ? normalAt(t) : pseudonormal;
      put(tile + tileIndex(row.x, row.y, z), n.dot(r) < 0 ? -d : d);
    }
  }
};

/// The region of a vertex: the cone about it.
struct Splatter::Corner {
  Vec3 v, pseudonormal;
  double band;
  Box box;
  std::span<const Vec3> spokes;  // vectors along the edges
  const SurfaceFeatures& features;
  std::uint32_t vertex;
  bool has_normal = false;

  Corner(const SurfaceFeatures& surface, std::uint32_t i, const Vec3& origin, double band_voxels,
         std::vector<Vec3>& work)
      : band(band_voxels), features(surface), vertex(i) {
    v = features.point(i) - origin;
    work.clear();
    const bool is_regular = features.isRegular(i);
    for (const TriangleSide corner : features.sidesFrom(i)) {
      const auto& t = features.triangle(corner.triangle);
      work.push_back(features.point(t[(corner.side + 1) % 3]) - features.point(i));
      // If two triangles share each edge, every edge is the first side of one of them.
      if (!is_regular) work.push_back(features.point(t[(corner.side + 2) % 3]) - features.point(i));
    }
    spokes = work;
    if (spokes.empty()) return;
    box.add(v);
    widen(box, Vec3::Constant(band));
  }

  void planes(SplatRegion& region) const {
    constexpr std::size_t kMaxSpokes = 6;
    const std::size_t count = std::min(spokes.size(), kMaxSpokes);
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3& s = spokes[k * spokes.size() / count];
      region.add(-s.x(), -s.y(), -s.z(), s.dot(v), taxicab(s));
    }
  }

  [[nodiscard]] Vec3 normal() const {
    const std::span<const TriangleSide> around = features.sidesFrom(vertex);
    return features.hasThin(around) ? features.pseudonormalThrough(features.point(vertex), around)
                                    : features.pseudonormal(vertex);
  }

  void write(const SplatRow& row, float* tile) {
    for (int z = row.low; z <= row.high; ++z) {
      const Vec3 r = Vec3(row.x, row.y, z) - v;
      const double d = r.norm();
      if (d >= band) continue;
      if (std::any_of(spokes.begin(), spokes.end(),
                      [&](const Vec3& s) { return s.dot(r) > kBorder * taxicab(s); }))
        continue;
      if (!has_normal) pseudonormal = normal();
      has_normal = true;
      put(tile + tileIndex(row.x, row.y, z), pseudonormal.dot(r) < 0 ? -d : d);
    }
  }
};

template <typename Visit>
auto Splatter::withFeature(std::uint32_t feature, const Vec3& origin, Visit visit) {
  if (feature < features_.faceCount()) {
    Face face(features_, feature, origin, band_);
    return visit(face);
  }
  feature -= features_.faceCount();
  if (feature < features_.edgeCount()) {
    Edge edge(features_, feature, origin, band_);
    return visit(edge);
  }
  Corner corner(features_, feature - features_.edgeCount(), origin, band_, spokes_);
  return visit(corner);
}

Box Splatter::reach(std::uint32_t feature) {
  if (feature < features_.faceCount()) return Face(features_, feature, Vec3::Zero(), band_).box;
  // Most edges and vertices of a smooth surface have a region that is too thin to contain a node.
  return withFeature(feature, Vec3::Zero(), [&](const auto& f) {
    const Vec3 low = (f.box.min.array() - kBorder).ceil();
    const Vec3 size = (f.box.max.array() + kBorder).floor() - low.array();
    if (!(size.minCoeff() >= 0)) return Box();
    if (size.maxCoeff() > kTile) return f.box;
    SplatRegion region;
    for (int axis = 0; axis < 3; ++axis) {
      region.low[axis] = 0;
      region.high[axis] = static_cast<int>(size[axis]);
      region.origin[axis] = low[axis];
    }
    f.planes(region);
    return findRows(region, rows_.data()) > 0 ? f.box : Box();
  });
}

bool Splatter::reaches(std::uint32_t feature, const Vec3& center, double radius) const {
  const double reach = radius + band_;
  if (feature < features_.faceCount()) {
    const auto& t = features_.triangle(feature);
    const Vec3& n = features_.normal(feature);
    const Vec3 p[3] = {features_.point(t[0]) - center, features_.point(t[1]) - center,
                       features_.point(t[2]) - center};
    if (std::abs(n.dot(p[0])) > reach) return false;
    for (int k = 0; k < 3; ++k) {
      const Vec3 along = p[(k + 1) % 3] - p[k];
      if (n.cross(along).dot(p[k]) > reach * along.norm()) return false;
    }
    return true;
  }
  feature -= features_.faceCount();
  if (feature >= features_.edgeCount()) return true;
  const SurfaceFeatures::Edge& edge = features_.edge(feature);
  const Vec3 a = features_.point(edge.a) - center, along = features_.point(edge.b) - center - a;
  const double t = std::clamp(-a.dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (a + t * along).squaredNorm() <= reach * reach;
}

void Splatter::splat(std::uint32_t feature, const Vec3& origin, float* tile) {
  withFeature(feature, origin, [&](auto& f) {
    if (f.box.isEmpty()) return;
    SplatRegion region;
    for (int axis = 0; axis < 3; ++axis) {
      region.low[axis] = static_cast<int>(std::ceil(std::max(f.box.min[axis] - kBorder, 0.0)));
      region.high[axis] = static_cast<int>(std::floor(std::min<double>(f.box.max[axis] + kBorder, kTile)));
      if (region.low[axis] > region.high[axis]) return;
    }
    f.planes(region);
    const int count = findRows(region, rows_.data());
    for (int i = 0; i < count; ++i) f.write(rows_[i], tile);
  });
}

}  // namespace vps
