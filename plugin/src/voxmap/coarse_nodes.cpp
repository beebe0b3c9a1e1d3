// SPDX-License-Identifier: BSD-3-Clause
#include "voxmap/coarse_nodes.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "voxmap/node_steps.h"
#include "voxmap/voxmap_sampling.h"

namespace vps {
namespace {


float mix(float a, float b, float t) {
  return a + t * (b - a);
}

float valueOf(const NodeValue d[8], float tx, float ty, float tz) {
  const auto f = [&](int k) { return static_cast<float>(d[k]); };
  return mix(mix(mix(f(0), f(1), tz), mix(f(2), f(3), tz), ty),
             mix(mix(f(4), f(5), tz), mix(f(6), f(7), tz), ty), tx);
}

std::int32_t pairOf(NodeValue low, NodeValue high) {
  return static_cast<std::int32_t>(static_cast<std::uint16_t>(low) |
                                   static_cast<std::uint32_t>(static_cast<std::uint16_t>(high)) << 16);
}

/// Gives a brick the coarse part's nodes where it meets that; how steep it is then [quanta].
int joinBrick(VoxLayout& layout, const CoarseNodes& coarse, std::size_t index) {
  const Index3 cell = layout.cellAt(index);
  NodeValue* nodes = layout.pool->nodes(layout.bricks[index]);
  for (int part = 0; part < 27; ++part) {
    const Index3 step(part / 9 - 1, part / 3 % 3 - 1, part % 3 - 1);
    if (part == 13 || layout.hasOwnNodes(layout.bricks[layout.cellIndex(cell + step)])) continue;
    const Index3 from = (step.array() > 0).select(Index3::Constant(kBrick), Index3::Zero());
    const Index3 to = (step.array() < 0).select(Index3::Zero(), Index3::Constant(kBrick));
    for (int x = from.x(); x <= to.x(); ++x)
      for (int y = from.y(); y <= to.y(); ++y)
        for (int z = from.z(); z <= to.z(); ++z)
          nodes[nodeIndex(x, y, z)] = coarse.node(kBrick * cell + Index3(x, y, z));
  }
  return mostAlongAxes(nodes);
}

int joinBricks(VoxLayout& layout) {
  const CoarseNodes coarse(layout);
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, layout.bricks.size()), 0,
      [&](const tbb::blocked_range<std::size_t>& range, int most) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
          if (layout.hasOwnNodes(layout.bricks[i])) most = std::max(most, joinBrick(layout, coarse, i));
        return most;
      },
      [](int a, int b) { return std::max(a, b); });
}

void nameOtherCells(VoxLayout& layout) {
  const CoarseNodes coarse(layout);
  tbb::parallel_for(std::size_t{0}, layout.bricks.size(), [&](std::size_t i) {
    std::uint32_t& brick = layout.bricks[i];
    if (!isConstant(brick)) return;
    std::uint32_t kind = kOutside;
    brick = coarse.isConstant(layout.cellAt(i), kind) ? kind : layout.elsewhere;
  });
}

void boundCenters(VoxLayout& layout, const VoxMap& coarse, double voxel_m) {
  const VoxSampler sampler(coarse);
  tbb::parallel_for(std::size_t{0}, layout.bricks.size(), [&](std::size_t i) {
    const Vec3 p = voxel_m * (kBrick * layout.cellAt(i) + Index3::Constant(kBrick / 2)).cast<double>();
    const VoxSampler::Place place = sampler.place(p);
    const double bound_m = sampler.isInside(place) ? std::min(0.0, sampler.mostDistance(place))
                                                   : std::max(0.0, sampler.leastDistance(p, place));
    layout.centers_m[i] = static_cast<float>(bound_m * (1 - 2e-7));
  });
}

}  // namespace

bool CoarseNodes::isConstant(const Index3& cell, std::uint32_t& kind) const noexcept {
  // The coarse nodes in it, border included, are among its own; between them all lie in between.
  const int per_cell = kBrick >> shift_;
  int first[8];
  corner(per_cell * cell, first);
  if (std::abs(first[0]) != kFullBand) return false;
  kind = first[0] < 0 ? kInside : kOutside;
  for (int x = 0; x < per_cell; ++x)
    for (int y = 0; y < per_cell; ++y)
      for (int z = 0; z < per_cell; ++z) {
        int nodes[8];
        corner(per_cell * cell + Index3(x, y, z), nodes);
        if (std::any_of(nodes, nodes + 8, [&](int n) { return n != first[0]; })) return false;
      }
  return true;
}

void readElsewhere(const FieldView& field, int count, ReadBatch& batch) noexcept {
  const VoxLayout& layout = *field.layout;
  const CoarseNodes coarse(layout);
  const Index3 origin = kBrick * layout.low;
  for (int slot = 0; slot < count; ++slot) {
    if (!batch.is_read[slot]) continue;
    bool has_any = false;
    for (int i = kLanes * slot; i < kLanes * (slot + 1); ++i) {
      if (field.bricks[batch.cell[i]] != layout.elsewhere) continue;
      has_any = true;
      const std::int32_t at[3] = {batch.x[i], batch.y[i], batch.z[i]};
      Index3 low = origin;
      float t[3];
      for (int k = 0; k < 3; ++k) {
        low[k] += batch.base[slot][k] + (at[k] >> kStepBits);
        t[k] = static_cast<float>(at[k] & (kSteps - 1)) / kSteps;
      }
      NodeValue d[8];
      coarse.corners(low, d);
      for (int k = 0; k < 4; ++k) batch.pair[k][i] = pairOf(d[2 * k], d[2 * k + 1]);
      batch.value[i] = valueOf(d, t[0], t[1], t[2]);
    }
    if (has_any)
      batch.least[slot] = *std::min_element(batch.value + kLanes * slot, batch.value + kLanes * (slot + 1));
  }
}

void readElsewhereAt(const FieldView& field, const std::int32_t* const whole[3], const float* const t[3],
                     int count, float* value) noexcept {
  const VoxLayout& layout = *field.layout;
  const CoarseNodes coarse(layout);
  for (int i = 0; i < count; ++i) {
    const Index3 low = kBrick * layout.low + Index3(whole[0][i], whole[1][i], whole[2][i]);
    const Index3 cell(low.x() >> 3, low.y() >> 3, low.z() >> 3);
    if (!layout.holds(cell) || layout.bricks[layout.cellIndex(cell)] != layout.elsewhere) continue;
    NodeValue d[8];
    coarse.corners(low, d);
    value[i] = valueOf(d, t[0][i], t[1][i], t[2][i]);
  }
}

void joinCoarse(VoxLayout& layout, const VoxMap& coarse, double voxel_m, double quantum_m) {
  const FieldView field(coarse);
  nameOtherCells(layout);
  const double steps = 1 << layout.coarse_shift;
  // Neighbours among coarse nodes differ by `steepest` a coarse voxel, and so do nodes read between them by
  // it a fine one, but for rounding. Bricks that meet them may be steeper: measured, since adding what their
  // nodes changed said 3.9 for 2.5.
  const float in_bricks = steepnessOf(joinBricks(layout), voxel_m, quantum_m);
  const auto between = static_cast<float>(static_cast<double>(layout.coarse->steepest) + quantum_m / voxel_m);
  layout.steepest = std::max({layout.steepest, between, in_bricks});
  layout.node_error =
      std::max(layout.node_error, static_cast<float>(steps * static_cast<double>(field.error)));
  layout.is_metric = layout.is_metric && layout.coarse->is_metric;
  boundCenters(layout, coarse, voxel_m);
}

}  // namespace vps
