// SPDX-License-Identifier: BSD-3-Clause
#include "cluster_depth.h"

#include <algorithm>
#include <cmath>

#include "vps/voxmap.h"

namespace vps {
namespace {

constexpr float kCell = VoxMap::kBrick;

struct Place {
  float p[3];  ///< in voxels from the directory's corner
};

Place placeOf(const Motion& m, const ShellBlock& block, std::uint32_t lane) noexcept {
  const double offset[3] = {block.center[0] + block.x[lane], block.center[1] + block.y[lane],
                            block.center[2] + block.z[lane]};
  Place place;
  for (int k = 0; k < 3; ++k)
    place.p[k] = static_cast<float>(m.p[k] + m.R[3 * k] * offset[0] + m.R[3 * k + 1] * offset[1] +
                                    m.R[3 * k + 2] * offset[2]);
  return place;
}

/// From a place to a box; 0 within.
float wayToBox(const Place& place, const float low[3], const float high[3]) noexcept {
  float squared = 0;
  for (int k = 0; k < 3; ++k) {
    const float way = std::max({0.0f, low[k] - place.p[k], place.p[k] - high[k]});
    squared += way * way;
  }
  return std::sqrt(squared);
}

/// The blend g of the eight cells around a place.
float byCells(const FieldView& f, const Place& place) noexcept {
  constexpr float kRoot = 0.6f;  // a: the bound is exact where sum t (1 - t) is 0.36
  int cell[3][2];
  float t[3], spread = kRoot * kRoot, past2 = 0;
  for (int k = 0; k < 3; ++k) {
    // Clamped to the box of the centres, and paid for by the way there.
    const float u = place.p[k] / kCell - 0.5f, most = static_cast<float>(f.size[k] - 1);
    const float within = u > 0 ? std::min(u, most) : 0;  // also for what is not a number
    cell[k][0] = static_cast<int>(within);
    cell[k][1] = std::min(cell[k][0] + 1, f.size[k] - 1);
    t[k] = within - static_cast<float>(cell[k][0]);
    spread += t[k] * (1 - t[k]);
    past2 += (u - within) * (u - within);
  }
  // Where a centre is inside, nothing is known of f but that less than this is nowhere read as less.
  const float deepest = -(f.band + f.diagonal);
  const auto at = [&](int x, int y, int z) {
    const float center = f.centers_m[(cell[0][x] * f.size[1] + cell[1][y]) * f.size[2] + cell[2][z]];
    return center > 0 ? center * f.voxels_per_m * (1 - 4e-7f) : deepest;
  };
  const auto mix = [](float a, float b, float w) { return a + w * (b - a); };
  const auto alongZ = [&](int x, int y) { return mix(at(x, y, 0), at(x, y, 1), t[2]); };
  const auto alongY = [&](int x) { return mix(alongZ(x, 0), alongZ(x, 1), t[1]); };
  return mix(alongY(0), alongY(1), t[0]) - kCell * (spread / (2 * kRoot) + std::sqrt(past2));
}

/// What the field's directory says of a cluster's depth; of a saturated reading, all that is said.
float farDepth(const Reading& reading, const ShellBlock& spheres, std::uint32_t lane, float radius) noexcept {
  const FieldView& f = reading.field;
  const Place place = placeOf(reading.motion, spheres, lane);
  const float rounding = 1e-6f * (std::abs(place.p[0]) + std::abs(place.p[1]) + std::abs(place.p[2]));
  if (f.is_metric) {
    const float by_box = radius + f.error + rounding - wayToBox(place, f.box[0], f.box[1]);
    return by_box > 0 ? std::min(by_box, radius + f.error + rounding - byCells(f, place)) : by_box;
  }
  // A field that is no distance reads as the band on the border of the directory and beyond.
  const float low[3] = {0, 0, 0};
  float high[3];
  for (int k = 0; k < 3; ++k) high[k] = kCell * static_cast<float>(f.size[k]);
  return f.slope * (radius + rounding - wayToBox(place, low, high)) - f.band;
}

/// What a distance of `away` or more, less the field's error, is read as at least.
float leastRead(const FieldView& f, float away) noexcept {
  const bool is_sure = !f.is_metric || away + f.error >= f.band + f.diagonal;
  return is_sure ? f.band : f.band - f.error;
}

float depthBound(const Reading& reading, const ShellBlock& spheres, std::uint32_t lane, float value,
                 float radius) noexcept {
  const FieldView& f = reading.field;
  float depth = f.slope * radius - value;
  if (f.is_metric) depth = std::min(depth, radius + 2 * f.error - value);
  const float far = std::clamp(2 * value / f.band - 1, 0.0f, 1.0f);
  if (depth > 0 && far > 0) depth -= far * std::max(0.0f, depth - farDepth(reading, spheres, lane, radius));
  return std::clamp(depth, -leastRead(f, -depth), f.band);
}

}  // namespace

void boundClusters(const Reading& reading, const ShellBlock& spheres, ClusterBounds& out) noexcept {
  const FieldView& f = reading.field;
  SphereBounds bounds;
  reading.kernels.bound(f, reading.motion, spheres, 0, bounds);
  // Positions are floats, and may be rounded to steps.
  const float rounding = 1e-3f + 2e-6f * static_cast<float>(spheres.radius_m / f.voxel_m);
  for (std::uint32_t i = 0; i < spheres.count; ++i) {
    out.value[i] = bounds.center[i];
    out.radius[i] = spheres.weight[i] * f.voxels_per_m * (1 + 1e-6f) + rounding;
    out.depth[i] = depthBound(reading, spheres, i, out.value[i], out.radius[i]);
  }
}

}  // namespace vps
