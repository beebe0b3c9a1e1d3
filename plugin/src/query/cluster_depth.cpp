// SPDX-License-Identifier: BSD-3-Clause
#include "query/cluster_depth.h"

#include <algorithm>
#include <cmath>

#include "vps/voxmap.h"

namespace vps {
namespace {

constexpr float kCell = VoxMap::kBrick;

struct Place {
  float p[3];  ///< in voxels from the directory's corner
};

/// Of a lane's point, along one axis [voxels from the directory's corner].
double positionOf(const Motion& m, const ShellBlock& block, std::uint32_t lane, int axis) noexcept {
  const double* R = m.R + 3 * axis;
  return m.p[axis] + R[0] * (block.center[0] + block.x[lane]) + R[1] * (block.center[1] + block.y[lane]) +
         R[2] * (block.center[2] + block.z[lane]);
}

Place placeOf(const Motion& m, const ShellBlock& block, std::uint32_t lane) noexcept {
  Place place;
  for (int k = 0; k < 3; ++k) place.p[k] = static_cast<float>(positionOf(m, block, lane, k));
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

/// The field at the spheres' centres [voxels], in a map that is fine in regions only. Its bricks alone do not
/// tell: elsewhere they are -band, a bound for all, by which every cluster there would seem as deep as can
/// be, and beside a region depths would jump to that.
void readCenters(const Reading& reading, const ShellBlock& spheres, float* value) noexcept {
  const FieldView& f = reading.field;
  std::int32_t whole[3][kLanes];
  float t[3][kLanes];
  for (int k = 0; k < 3; ++k) {
    // Farther off all is the same; also for what is not a number.
    const double low = -VoxMap::kBrick, high = VoxMap::kBrick * (f.size[k] + 1.0);
    for (std::uint32_t i = 0; i < spheres.count; ++i) {
      const double p = positionOf(reading.motion, spheres, i, k), near = p > low ? std::min(p, high) : low;
      whole[k][i] = static_cast<std::int32_t>(std::floor(near));
      t[k][i] = static_cast<float>(near - whole[k][i]);
    }
  }
  const std::int32_t* const at[3] = {whole[0], whole[1], whole[2]};
  const float* const parts[3] = {t[0], t[1], t[2]};
  const int count = static_cast<int>(spheres.count);
  reading.kernels.readAt(f, at, parts, count, value);
  readElsewhereAt(f, at, parts, count, value);
  for (int i = 0; i < count; ++i) value[i] *= f.quantum;
}

}  // namespace

void boundClusters(const Reading& reading, const ShellBlock& spheres, ClusterBounds& out) noexcept {
  const FieldView& f = reading.field;
  if (f.layout != nullptr) {
    readCenters(reading, spheres, out.value);
  } else {
    SphereBounds bounds;
    reading.kernels.bound(f, reading.motion, spheres, 0, bounds);
    std::copy_n(bounds.center, spheres.count, out.value);
  }
  // Positions are floats, and may be rounded to steps.
  const float rounding = 1e-3f + 2e-6f * static_cast<float>(spheres.radius_m / f.voxel_m);
  for (std::uint32_t i = 0; i < spheres.count; ++i) {
    out.radius[i] = spheres.weight[i] * f.voxels_per_m * (1 + 1e-6f) + rounding;
    out.depth[i] = depthBound(reading, spheres, i, out.value[i], out.radius[i]);
  }
}

}  // namespace vps
