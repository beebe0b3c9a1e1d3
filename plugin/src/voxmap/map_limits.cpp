// SPDX-License-Identifier: BSD-3-Clause
#include "voxmap/map_limits.h"

#include <cmath>
#include <cstdio>

#include "vps/errors.h"

namespace vps {
namespace {

static_assert(kMemoryLimit_bytes / VoxLayout::kCellBytes < 2147483648.0, "kernels count cells in int");
static_assert(kMemoryLimit_bytes / VoxPool::kBytes < VoxPool::kMaxBricks, "all bricks that fit have a name");

}  // namespace

void requireSettings(const VoxMapSettings& settings, const std::string& part) {
  if (!(settings.voxel_m > 0) || !std::isfinite(settings.voxel_m))
    throw LoadError("", part, "voxel size must be above 0; 0.25 mm suits fits of 20 um and more");
  // Distances are floats. No part comes near these limits, but the values of a damaged file may.
  if (!(settings.voxel_m > 1e-30) || !(settings.voxel_m < 1e30))
    throw LoadError("", part, "voxel size must lie between 1e-30 and 1e30 m; is the unit right?");
  // A band read from a map is rounded, see quantumOf().
  if (!(settings.band_voxels >= 3 * (1 - 1e-6)) || !(settings.band_voxels <= 64 * (1 + 1e-6)))
    throw LoadError("", part, "band must be 3 to 64 voxels wide on each side; 4 is usual");
}

void requirePose(const Pose& X_MP) {
  if (!X_MP.isFinite())
    throw LoadError("", "", "the pose of a part to be placed is not finite; place it again");
}

void requireNear(const Box& bounds_M, double voxel_m, const std::string& part) {
  const double away_m = bounds_M.center().cwiseAbs().maxCoeff();
  if (away_m / voxel_m < 1e9) return;
  char text[160];
  std::snprintf(text, sizeof text, "lies %.3g m from the origin, too far for %.3g mm voxels; move it nearer",
                away_m, voxel_m * 1e3);
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
                "voxels %.2g times as large would fit, or what lies far apart moved nearer",
                1.05 * std::cbrt(bytes / kMemoryLimit_bytes));
  requireMemory(bytes, what_for, remedy, file, part);
}

void requireMemory(double bytes, const std::string& what_for, const std::string& remedy,
                   const std::string& file, const std::string& part) {
  if (bytes <= kMemoryLimit_bytes) return;
  constexpr double kGiB = 1024.0 * 1024 * 1024;
  char needs[48], limit[48];
  std::snprintf(needs, sizeof needs, "needs %.4g GiB", bytes / kGiB);
  std::snprintf(limit, sizeof limit, ", the limit is %.0f; ", kMemoryLimit_bytes / kGiB);
  throw LoadError(file, part, needs + what_for + limit + remedy);
}

}  // namespace vps
