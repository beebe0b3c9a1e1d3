// SPDX-License-Identifier: BSD-3-Clause
#include "voxmap/map_limits.h"

#include <cmath>
#include <cstdio>
#include <limits>

#include "vps/errors.h"

namespace vps {
namespace {

static_assert(kMemoryLimit_bytes / VoxLayout::kCellBytes < 2147483648.0, "kernels count cells in int");
static_assert(kMemoryLimit_bytes / VoxPool::kBytes < VoxPool::kMaxBricks,
              "all bricks that fit into memory have a name");

}  // namespace

void requireSettings(const VoxMapSettings& settings, const std::string& part) {
  if (!(settings.voxel_m > 0) || !std::isfinite(settings.voxel_m))
    throw LoadError("", part, "the voxel size must be above 0; 0.25 mm suits fits of 20 um and more");
  // Distances are floats. No part comes near these limits, but the values of a damaged file may.
  if (!(settings.voxel_m > 1e-30) || !(settings.voxel_m < 1e30))
    throw LoadError("", part, "the voxel size must lie between 1e-30 and 1e30 m; is the unit right?");
  // A band read from a map is rounded, see quantumOf().
  if (!(settings.band_voxels >= 3 * (1 - 1e-6)) || !(settings.band_voxels <= 64 * (1 + 1e-6)))
    throw LoadError("", part,
                    "the band must be 3 to 64 voxels wide on each side of the surface; 4 voxels are usual");
}

void requirePose(const Pose& X_MP) {
  if (!X_MP.isFinite())
    throw LoadError("", "", "the pose of the part to be mounted is not finite; give finite numbers");
}

void requireNear(const Box& bounds_M, double voxel_m, const std::string& part) {
  const double away_m = bounds_M.center().cwiseAbs().maxCoeff();
  if (away_m / voxel_m < 1e9) return;
  char text[160];
  std::snprintf(text, sizeof text,
                "the part lies %.3g m from the origin, too far for %.3g mm voxels; move it nearer", away_m,
                voxel_m * 1e3);
  throw LoadError("", part, text);
}

double directoryBytes(const Vec3& cells) {
  return cells.prod() * VoxLayout::kCellBytes;
}

void requireDirectory(const Vec3& cells, const std::string& file, const std::string& part) {
  const double bytes = directoryBytes(cells);
  char what_for[96], remedy[128];
  std::snprintf(what_for, sizeof what_for, " for its directory of %.6g x %.6g x %.6g bricks", cells.x(),
                cells.y(), cells.z());
  std::snprintf(remedy, sizeof remedy,
                "make the voxels %.2g times as large, or move parts that lie far apart closer together",
                1.05 * std::cbrt(bytes / kMemoryLimit_bytes));
  requireMemory(bytes, what_for, remedy, file, part);
}

void requireMemory(double bytes, const std::string& what_for, const std::string& remedy,
                   const std::string& file, const std::string& part) {
  if (bytes <= kMemoryLimit_bytes) return;
  constexpr double kGiB = 1024.0 * 1024 * 1024;
  char needs[48], limit[48];
  std::snprintf(needs, sizeof needs, "needs %.4g GiB", bytes / kGiB);
  std::snprintf(limit, sizeof limit, ", the limit is %.0f GiB; ", kMemoryLimit_bytes / kGiB);
  throw LoadError(file, part, needs + what_for + limit + remedy);
}

namespace {

/// Bytes for a map of a surface: the directory, and bricks that meet a slab around the surface. The slab is
/// as thick as the band plus a brick's slant.
double estimatedBytes(double area_m2, const Vec3& size_m, double h, double band_voxels) {
  const double cell_m = VoxMap::kBrick * h;
  const double bricks = area_m2 / (cell_m * cell_m) * (2 * band_voxels / VoxMap::kBrick + 1.5);
  const Vec3 cells = (size_m.array() + 2 * band_voxels * h) / cell_m + 3;
  constexpr double kTemporary = 15;  // assumed: bytes of temporary memory for each cell while building
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
  std::snprintf(remedy, sizeof remedy, "voxels of %.2g mm would fit", h * 1.05e3);
  requireMemory(bytesAt(settings.voxel_m), what_for, remedy, "", part);
}

}  // namespace vps
