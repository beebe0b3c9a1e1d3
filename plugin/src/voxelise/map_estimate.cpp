// SPDX-License-Identifier: BSD-3-Clause
#include "voxelise/map_estimate.h"

#include <cmath>
#include <cstdio>
#include <limits>

#include "voxmap/map_limits.h"

namespace vps {
namespace {

/// Bytes for a map of this surface: the directory, and bricks that meet a slab around the surface. The slab
/// is as thick as the band plus a brick's slant.
double estimatedBytes(double area_m2, const Vec3& size_m, double h, double band_voxels) {
  const double cell_m = VoxMap::kBrick * h;
  const double bricks = area_m2 / (cell_m * cell_m) * (2 * band_voxels / VoxMap::kBrick + 1.5);
  const Vec3 cells = (size_m.array() + 2 * band_voxels * h) / cell_m + 3;
  constexpr double kTemporary = 15;  // bytes a cell, assumed: temporary memory of building
  return bricks * VoxPool::kBytes + directoryBytes(cells) + cells.prod() * kTemporary;
}

}  // namespace

double expectedMapBytes(const Mesh& mesh, const VoxMapSettings& settings) {
  return estimatedBytes(area(mesh), bounds(mesh).size(), settings.voxel_m, settings.band_voxels);
}

double largestMapBytes() {
  return kMemoryLimit_bytes;
}

double fittingVoxel_m(const Mesh& mesh, const VoxMapSettings& settings, double most_bytes) {
  const double area_m2 = area(mesh);
  const Vec3 size_m = bounds(mesh).size();
  const auto fits = [&](double h) {
    return estimatedBytes(area_m2, size_m, h, settings.band_voxels) <= most_bytes;
  };
  double low = settings.voxel_m, high = low;
  if (!(low > 0) || !std::isfinite(area_m2) || fits(low)) return low;
  constexpr double kCoarsest_m = 1e30;  // the limit of requireSettings()
  while (!fits(high *= 2))
    if (high > kCoarsest_m) return std::numeric_limits<double>::infinity();
  for (low = high / 2; high > 1.001 * low;) {
    const double middle = std::sqrt(low * high);
    (fits(middle) ? high : low) = middle;
  }
  return high;
}

void requireFits(const Mesh& mesh, const VoxMapSettings& settings, const std::string& part) {
  const Box box = bounds(mesh);
  const double area_m2 = area(mesh);
  requireSettings(settings, part);
  requireNear(box, settings.voxel_m, part);
  const auto bytesAt = [&](double h) { return estimatedBytes(area_m2, box.size(), h, settings.band_voxels); };
  double h = settings.voxel_m;
  while (bytesAt(h) > kMemoryLimit_bytes) h *= 1.05;
  char what_for[48], remedy[48];
  std::snprintf(what_for, sizeof what_for, " at %.3g mm voxels", settings.voxel_m * 1e3);
  std::snprintf(remedy, sizeof remedy, "%.2g mm would fit", h * 1.05e3);
  requireMemory(bytesAt(settings.voxel_m), what_for, remedy, "", part);
}

}  // namespace vps
