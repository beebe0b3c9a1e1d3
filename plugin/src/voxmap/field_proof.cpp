// SPDX-License-Identifier: BSD-3-Clause
#include "voxmap/field_bounds.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace vps {
namespace {

/// The length of the longest path over grid cells between points at distance 1: |(1, sqrt 2 - 1, sqrt 3 -
/// sqrt 2)|.
constexpr double kLattice = 1.1281;

/// Measurements over bricks. The measurements are minima and maxima only, so that their order does not
/// matter.
struct Measure {
  int along = 0, across = 0, diagonal = 0;  ///< differences on a cell's edges, faces, and diagonals [quanta]
  Box surface;                              ///< box of the field's zeros on edges [voxels]

  void add(const Measure& other) {
    along = std::max(along, other.along);
    across = std::max(across, other.across);
    diagonal = std::max(diagonal, other.diagonal);
    if (other.surface.isEmpty()) return;
    surface.add(other.surface.min);
    surface.add(other.surface.max);
  }
  void addSteps(const NodeValue* n) {
    along = std::max(along, mostAlongAxes(n));
    across =
        std::max({across, mostDifference<0, 1, 1>(n), mostDifference<0, 1, -1>(n), mostDifference<1, 0, 1>(n),
                  mostDifference<1, 0, -1>(n), mostDifference<1, 1, 0>(n), mostDifference<1, -1, 0>(n)});
    diagonal = std::max({diagonal, mostDifference<1, 1, 1>(n), mostDifference<1, 1, -1>(n),
                         mostDifference<1, -1, 1>(n), mostDifference<1, -1, -1>(n)});
  }
  /// Adds the zeros between a node and the next node along an axis.
  void addZeros(const NodeValue* nodes, const Index3& first) {
    for (int i = 0; i < kBrickNodes; ++i) {
      const Index3 at = nodeAt(i);
      for (int axis = 0; axis < 3; ++axis) {
        if (at[axis] == kBrick) continue;
        const int a = nodes[i], b = nodes[i + nodeIndex(axis == 0, axis == 1, axis == 2)];
        if ((a < 0) == (b < 0)) continue;
        Vec3 zero = (first + at).cast<double>();
        zero[axis] += static_cast<double>(a) / (a - b);
        surface.add(zero);
      }
    }
  }
};

/// Signed distance to a box, negative inside.
double signedDistance(const Box& box, const Vec3& p) {
  const Vec3 past = (box.min - p).cwiseMax(p - box.max);
  return past.cwiseMax(0.0).norm() + std::min(past.maxCoeff(), 0.0);
}

class Proof {
 public:
  Proof(VoxLayout& layout, double voxel_m, double quantum_m)
      : layout_(layout), voxel_m_(voxel_m), quantum_(quantum_m / voxel_m), band_(kFullBand * quantum_) {}

  Box run() {
    const Measure measure = measureAll();
    Box surface_m;
    if (measure.surface.isEmpty()) return surface_m;
    surface_m.add(voxel_m_ * measure.surface.min);
    surface_m.add(voxel_m_ * measure.surface.max);
    layout_.steepest = static_cast<float>(measure.along * quantum_ * (1 + 1e-6));
    const double s = quantum_ * std::max({measure.along / 1.0, measure.across / std::sqrt(2.0),
                                          measure.diagonal / std::sqrt(3.0)});
    // A small margin covers the rounding errors of this computation.
    error_ = std::max({1e-6, band_ * (1 - 1 / (kLattice * s)), shortfall(measure.surface)}) * (1 + 1e-6);
    layout_.node_error = static_cast<float>(error_ * (1 + 1e-6));
    layout_.is_metric = true;
    layout_.parts = {{surface_m, layout_.low, layout_.low + layout_.size}};
    boundCenters();
    return surface_m;
  }

 private:
  template <typename Part, typename Visit, typename Join>
  Part overCells(Visit visit, Join join) const {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, layout_.bricks.size()), Part(),
        [&](const tbb::blocked_range<std::size_t>& range, Part part) {
          for (std::size_t i = range.begin(); i < range.end(); ++i) visit(i, part);
          return part;
        },
        join);
  }

  [[nodiscard]] Measure measureAll() const {
    return overCells<Measure>(
        [&](std::size_t cell, Measure& measure) {
          if (isConstant(layout_.bricks[cell])) return;
          measure.addSteps(layout_.nodesOf(cell));
          measure.addZeros(layout_.nodesOf(cell), kBrick * layout_.cellAt(cell));
        },
        [](Measure a, const Measure& b) {
          a.add(b);
          return a;
        });
  }

  /// The largest amount by which a node below the band is less than its signed distance to the box [voxels].
  [[nodiscard]] double shortfall(const Box& box) const {
    return overCells<double>(
        [&](std::size_t cell, double& most) {
          const std::uint32_t brick = layout_.bricks[cell];
          if (brick == kOutside) return;
          // The distance to a box is convex, so over a constant brick it is greatest at a corner.
          const int step = brick == kInside ? kBrick : 1;
          const NodeValue* nodes = layout_.nodesOf(cell);
          const Index3 first = kBrick * layout_.cellAt(cell);
          for (int x = 0; x < kNodes; x += step)
            for (int y = 0; y < kNodes; y += step)
              for (int z = 0; z < kNodes; z += step) {
                const int node = nodes[nodeIndex(x, y, z)];
                if (node < kFullBand)
                  most = std::max(
                      most, signedDistance(box, (first + Index3(x, y, z)).cast<double>()) - quantum_ * node);
              }
        },
        [](double a, double b) { return std::max(a, b); });
  }

  /// A lower bound of the distance from each cell's centre to the nearest cell that is not `kind` [voxels].
  [[nodiscard]] std::vector<float> wayOutOf(std::uint32_t kind) const {
    std::vector<std::int32_t> is_other(layout_.bricks.size());
    std::transform(layout_.bricks.begin(), layout_.bricks.end(), is_other.begin(),
                   [&](std::uint32_t brick) { return brick == kind ? -1 : 0; });
    SurfaceBits all;
    all.rows.fill(0xFF);
    return boundCellCenters(layout_.size, is_other, {all});
  }

  /// Within a constant region, nodes below the band are at least as far as the region's border. A saturated
  /// node lies within sqrt(1/2) of any point on the region's faces, and from there f falls by at most the
  /// distance. boundCellCenters() measures to cubes around nodes, which may be sqrt(3)/2 farther than the
  /// cell that contains the nodes.
  void boundCenters() {
    constexpr double kMargin = 0.7072 + 0.8661;
    const std::vector<float> outside = wayOutOf(kOutside), inside = wayOutOf(kInside);
    tbb::parallel_for(std::size_t{0}, layout_.bricks.size(), [&](std::size_t i) {
      const int center = layout_.nodesOf(i)[nodeIndex(kBrick / 2, kBrick / 2, kBrick / 2)];
      double least = quantum_ * std::abs(center);
      if (isConstant(layout_.bricks[i]))
        least =
            std::max(least, band_ - kMargin +
                                static_cast<double>(layout_.bricks[i] == kOutside ? outside[i] : inside[i]));
      // The bound is rounded down, so that it stays a bound.
      const double least_m = std::max(0.0, least - error_) * voxel_m_ * (1 - 1e-6);
      layout_.centers_m[i] = static_cast<float>(center < 0 ? -least_m : least_m);
    });
  }

  VoxLayout& layout_;
  const double voxel_m_, quantum_, band_;  // quantum_ and band_ in voxels
  double error_ = 0;                       // e of the header's comment [voxels]
};

}  // namespace

Box proveField(VoxLayout& layout, double voxel_m, double quantum_m) {
  return Proof(layout, voxel_m, quantum_m).run();
}

}  // namespace vps
