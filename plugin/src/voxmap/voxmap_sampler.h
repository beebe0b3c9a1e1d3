// SPDX-License-Identifier: BSD-3-Clause
// Reads a VoxMap at one point, in double precision; read_kernel.h reads many points at once.
#pragma once

#include <limits>

#include "voxmap/voxmap_access.h"

namespace vps {

/// Reads one map. Cheap to construct (no reference count changes); the map must outlive it.
class VoxSampler {
 public:
  explicit VoxSampler(const VoxMap& map) noexcept
      : layout_(*VoxMapAccess::layout(map)),
        bricks_(layout_.bricks.data()),
        nodes_(layout_.pool->nodes(0)),
        voxel_m_(map.voxel_m()),
        band_m_(map.band_m()),
        quantum_m_(map.quantum_m()),
        bounds_(map.bounds()),
        per_voxel_(map.voxel_m() > 0 ? 1 / map.voxel_m() : 0),
        low_((VoxMap::kBrick * layout_.low).cast<double>()),
        size_((VoxMap::kBrick * layout_.size).cast<double>()) {}

  /// Position of a point: the directory's cell, the low node of its grid cell within the brick, and the
  /// fraction between nodes. is_within is false outside the directory.
  struct Place {
    bool is_within = false;
    std::uint32_t brick = kOutside;
    std::size_t cell = 0;
    Index3 node;
    Vec3 t;
  };

  [[nodiscard]] Place place(const Vec3& p_M) const noexcept { return placeInVoxels(p_M * per_voxel_ - low_); }

  /// The place of a position that is given from the directory's corner, in voxels.
  [[nodiscard]] Place placeInVoxels(const Vec3& x) const noexcept {
    Place at;
    // NaN fails this test. Within the directory x >= 0, so truncation is the floor.
    if (!((x.array() >= 0).all() && (x.array() < size_.array()).all())) return at;
    const Index3 whole = x.cast<int>();
    at.is_within = true;
    at.t = x - whole.cast<double>();
    at.node = Index3(whole.x() & 7, whole.y() & 7, whole.z() & 7);
    at.cell = (static_cast<std::size_t>(whole.x() >> 3) * static_cast<std::size_t>(layout_.size.y()) +
               static_cast<std::size_t>(whole.y() >> 3)) *
                  static_cast<std::size_t>(layout_.size.z()) +
              static_cast<std::size_t>(whole.z() >> 3);
    at.brick = bricks_[at.cell];
    return at;
  }

  /// Trilinear distance [m]; +band outside the directory.
  [[nodiscard]] double distance(const Place& at) const noexcept {
    // Returning the constant of a constant brick is exact, where interpolation could round, and fast where
    // most points are.
    if (at.brick == kOutside) return band_m_;
    if (at.brick == kInside) return -band_m_;
    const Corners d = corners(at);
    const double x0 = mix(mix(d[0], d[1], at.t.z()), mix(d[2], d[3], at.t.z()), at.t.y());
    const double x1 = mix(mix(d[4], d[5], at.t.z()), mix(d[6], d[7], at.t.z()), at.t.y());
    return quantum_m_ * mix(x0, x1, at.t.x());
  }

  /// Unit outward normal at a place; zero in constant bricks and outside the directory.
  [[nodiscard]] Vec3 normal(const Place& at, Gradient gradient) const noexcept {
    if (isConstant(at.brick)) return Vec3::Zero();
    const Vec3 g = gradient == Gradient::Trilinear ? trilinearGradient(at) : continuousGradient(at);
    const double length = g.norm();
    // Where opposite walls cancel there is no direction: a gradient below two quanta is rounding noise (a
    // true gradient has length 1, some thousand quanta per voxel).
    return length > 2 ? Vec3(g / length) : Vec3(Vec3::Zero());
  }

  /// A lower bound of the signed distance to the surface at p_M; -band_m where nothing better is known.
  [[nodiscard]] double leastDistance(const Vec3& p_M, const Place& at) const noexcept {
    if (!at.is_within) return leastDistanceOutside(p_M);
    double least_m = -band_m_;
    const double center_m = layout_.centers_m[at.cell];
    if (center_m > 0) least_m = std::max(least_m, center_m * kRoundDown - fromCenter(at));
    least_m = std::max(least_m, distance(at) - interpolationError(at));
    const double to_box_m = boxDistance(p_M);
    return to_box_m > 0 ? std::max(to_box_m, least_m) : least_m;
  }

  /// An upper bound of the signed distance to the surface at p_M; infinite where unknown.
  [[nodiscard]] double mostDistance(const Place& at) const noexcept {
    double most_m = std::numeric_limits<double>::infinity();
    if (at.brick == kOutside) return most_m;
    const double center_m = layout_.centers_m[at.cell];
    if (center_m < 0) most_m = center_m * kRoundDown + fromCenter(at);
    const double field_m = distance(at) + interpolationError(at);
    return field_m < band_m_ ? std::min(most_m, field_m) : most_m;
  }

  struct Range {
    double least_m = -std::numeric_limits<double>::infinity();
    double most_m = std::numeric_limits<double>::infinity();
  };
  /// Bounds of the signed distance at p_M from the centres of the eight cells around it; the cell in the
  /// direction away from the surface gives the best bound. Valid only for true distances.
  [[nodiscard]] Range rangeAround(const Vec3& p_M) const noexcept {
    const Vec3 x = (p_M * per_voxel_ - low_) / VoxMap::kBrick - Vec3::Constant(0.5);
    const Vec3 low = x.array().floor();
    Range range;
    for (int i = 0; i < 8; ++i) {
      const Vec3 cell = low + Vec3(i >> 2, i >> 1 & 1, i & 1);
      if (!((cell.array() >= 0).all() && (VoxMap::kBrick * cell.array() < size_.array()).all())) continue;
      const double way_m = (x - cell).norm() * (VoxMap::kBrick * voxel_m_);
      const double center_m = layout_.centers_m[layout_.cellIndex(layout_.low + cell.cast<int>())];
      if (center_m > 0) range.least_m = std::max(range.least_m, center_m * kRoundDown - way_m);
      if (center_m < 0) range.most_m = std::min(range.most_m, center_m * kRoundDown + way_m);
    }
    return range;
  }

  /// The constant brick of all cells that a box touches; kMixed if they are not one constant brick.
  static constexpr std::uint32_t kMixed = UINT32_MAX;
  [[nodiscard]] std::uint32_t constantIn(const Box& box_M) const noexcept {
    const Vec3 last = size_ / VoxMap::kBrick - Vec3::Ones();
    const Vec3 from = ((box_M.min * per_voxel_ - low_) / VoxMap::kBrick).array().floor();
    const Vec3 to = ((box_M.max * per_voxel_ - low_) / VoxMap::kBrick).array().floor();
    if ((to.array() < 0).any() || (from.array() > last.array()).any()) return kOutside;
    // The directory's rim, and all space beyond it, is outside.
    const Index3 low = from.cwiseMax(0).cast<int>(), high = to.cwiseMin(last).cast<int>();
    const std::uint32_t all = bricks_[layout_.cellIndex(layout_.low + low)];
    if (!isConstant(all)) return kMixed;
    for (int i = low.x(); i <= high.x(); ++i)
      for (int j = low.y(); j <= high.y(); ++j)
        for (int k = low.z(); k <= high.z(); ++k)
          if (bricks_[layout_.cellIndex(layout_.low + Index3(i, j, k))] != all) return kMixed;
    return all;
  }

  /// The largest error of a node [m].
  [[nodiscard]] double nodeError_m() const noexcept {
    return voxel_m_ * layout_.node_error + 0.51 * quantum_m_;
  }

  [[nodiscard]] bool isInside(const Place& at) const noexcept {
    return at.brick != kOutside && distance(at) < 0;
  }

  [[nodiscard]] std::uint16_t owner(const Place& at) const noexcept {
    if (isConstant(at.brick)) return 0;
    const auto nearest = [&](int axis) { return at.node[axis] + (at.t[axis] >= 0.5 ? 1 : 0); };
    return layout_.pool->ownerOf(at.brick, nodeIndex(nearest(0), nearest(1), nearest(2)));
  }

 private:
  using Corners = std::array<double, 8>;  // [quanta]; bits of the index: x y z
  /// Bounds are reduced by this factor, because centre distances were rounded to float.
  static constexpr double kRoundDown = 1 - 2e-7;

  static double mix(double a, double b, double t) noexcept { return a + t * (b - a); }

  [[nodiscard]] const NodeValue* lowNode(const Place& at) const noexcept {
    return nodes_ + at.brick + nodeIndex(at.node.x(), at.node.y(), at.node.z());
  }

  [[nodiscard]] Corners corners(const Place& at) const noexcept {
    const NodeValue* d = lowNode(at);
    constexpr int x = nodeIndex(1, 0, 0), y = nodeIndex(0, 1, 0);
    return {double(d[0]), double(d[1]),     double(d[y]),     double(d[y + 1]),
            double(d[x]), double(d[x + 1]), double(d[x + y]), double(d[x + y + 1])};
  }

  /// Derivative of the interpolant, times one voxel, in quanta.
  [[nodiscard]] Vec3 trilinearGradient(const Place& at) const noexcept {
    const Corners d = corners(at);
    const double x = at.t.x(), y = at.t.y(), z = at.t.z();
    return {mix(mix(d[4] - d[0], d[5] - d[1], z), mix(d[6] - d[2], d[7] - d[3], z), y),
            mix(mix(d[2] - d[0], d[3] - d[1], z), mix(d[6] - d[4], d[7] - d[5], z), x),
            mix(mix(d[1] - d[0], d[3] - d[2], y), mix(d[5] - d[4], d[7] - d[6], y), x)};
  }

  /// Trilinear interpolation of the nodes' central differences, times two voxels, in quanta. Along its own
  /// axis a component needs one more node on each side of the cell, which may lie in a neighbouring brick.
  [[nodiscard]] Vec3 continuousGradient(const Place& at) const noexcept {
    constexpr int kStride[3] = {nodeIndex(1, 0, 0), nodeIndex(0, 1, 0), nodeIndex(0, 0, 1)};
    const std::ptrdiff_t cell_stride[3] = {std::ptrdiff_t{layout_.size.y()} * layout_.size.z(),
                                           layout_.size.z(), 1};
    const NodeValue* low = lowNode(at);
    const std::ptrdiff_t index = low - (nodes_ + at.brick);
    // A brick with a band always has neighbours: the directory has one empty cell around all bricks.
    const std::uint32_t* cell = bricks_ + at.cell;
    Vec3 g;
    for (int axis = 0; axis < 3; ++axis) {
      const int stride = kStride[axis], node = at.node[axis];
      const NodeValue *before = low - stride, *high = low + stride, *after = high + stride;
      if (node == 0) before = nodes_ + cell[-cell_stride[axis]] + index + (VoxMap::kBrick - 1) * stride;
      if (node == VoxMap::kBrick - 1) after = nodes_ + cell[cell_stride[axis]] + index + (1 - node) * stride;
      const int b = kStride[(axis + 1) % 3], c = kStride[(axis + 2) % 3];
      const double t = at.t[axis], t_b = at.t[(axis + 1) % 3], t_c = at.t[(axis + 2) % 3];
      const auto slope = [&](int k) {
        return mix(double(high[k] - before[k]), double(after[k] - low[k]), t);
      };
      g[axis] = mix(mix(slope(0), slope(b), t_b), mix(slope(c), slope(b + c), t_b), t_c);
    }
    return g;
  }

  /// A bound of the difference between the interpolant and the distance. Distance is 1-Lipschitz, so |sum w_i
  /// d(x_i) - d(p)| <= sum w_i |x_i - p| <= sqrt(sum w_i |x_i - p|^2) = h sqrt(sum over axes of t (1 - t)).
  [[nodiscard]] double interpolationError(const Place& at) const noexcept {
    return voxel_m_ * (std::sqrt((at.t.array() * (1 - at.t.array())).sum()) + layout_.node_error) +
           0.51 * quantum_m_;  // half a quantum of storage, and rounding
  }

  /// A lower bound of the distance outside the directory, a box that contains the surface. Let c be the box's
  /// nearest point to p. The angle between cp and every point of the surface, as seen from c, is at least 90
  /// degrees: distance(p)^2 >= |p - c|^2 + distance(c)^2.
  [[nodiscard]] double leastDistanceOutside(const Vec3& p_M) const noexcept {
    if (layout_.bricks.empty()) return boxDistance(p_M);
    const Vec3 low = low_ * voxel_m_, high = (low_ + size_) * voxel_m_;
    // The point is kept slightly inside, so that rounding cannot move the point out of the directory.
    const Vec3 hair = Vec3::Constant(1e-6 * voxel_m_);
    const Vec3 c = p_M.cwiseMax(low + hair).cwiseMin(high - hair);
    const Place at = place(c);
    const double from_c_m = at.is_within ? std::max(0.0, leastDistance(c, at)) : boxDistance(c);
    return std::sqrt((p_M - c).squaredNorm() + from_c_m * from_c_m) - voxel_m_ * 1e-5;
  }
  /// Distance from the point to its directory cell's centre [m].
  [[nodiscard]] double fromCenter(const Place& at) const noexcept {
    return voxel_m_ * (at.node.cast<double>() + at.t - Vec3::Constant(VoxMap::kBrick / 2)).norm();
  }
  [[nodiscard]] double boxDistance(const Vec3& p_M) const noexcept {
    return (bounds_.min - p_M).cwiseMax(p_M - bounds_.max).cwiseMax(0.0).norm();
  }

  const VoxLayout& layout_;
  const std::uint32_t* bricks_;  // bricks_ and nodes_ are copies of the layout's pointers
  const NodeValue* nodes_;
  double voxel_m_, band_m_, quantum_m_;
  const Box& bounds_;
  double per_voxel_;
  Vec3 low_, size_;  // of the directory, in voxels
};

}  // namespace vps
