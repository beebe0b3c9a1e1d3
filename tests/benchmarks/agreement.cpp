// SPDX-License-Identifier: BSD-3-Clause
#include "measure.h"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "vps/vdb.h"

namespace vps::bench {
namespace {

/// The map as OpenVDB reads it. The field is kept for the next case on the same map, since writing takes
/// seconds.
const RivalField& sameField(const VoxMap& map) {
  static std::unique_ptr<RivalField> kept;
  static VoxMap kept_map;
  static bool is_kept = false;
  const auto isSame = [&](const VoxMap& other) {
    return other.voxel_m() == map.voxel_m() && other.memoryBytes() == map.memoryBytes() &&
           other.bounds().min == map.bounds().min && other.bounds().max == map.bounds().max;
  };
  if (is_kept && isSame(kept_map)) return *kept;
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "vps_benchmark_field.vdb";
  saveVdb(map, file.string());
  kept = readOpenVdb(file.string());
  kept_map = map;
  is_kept = true;
  std::filesystem::remove(file);
  return *kept;
}

struct Tolerance {
  double distance_m = 0, force_N = 0, torque_Nm = 0;
};

void requireSame(const Answer& ours, const Answer& theirs, std::size_t surely, std::size_t perhaps,
                 const Tolerance& tol, const std::string& where) {
  std::ostringstream what;
  if (ours.touching < surely || ours.touching > perhaps)
    what << ours.touching << " points touch, where " << surely << " to " << perhaps << " do";
  else if (surely > 0 && std::abs(ours.least_m - theirs.least_m) > tol.distance_m)
    what << "least distance " << ours.least_m << " m, where " << theirs.least_m << " m is read";
  else if (ours.least_m > theirs.least_m + tol.distance_m)
    what << "least distance at least " << ours.least_m << " m, where " << theirs.least_m << " m is read";
  else if ((ours.F_Mo_M.f - theirs.F_Mo_M.f).norm() > tol.force_N)
    what << "force " << ours.F_Mo_M.f.transpose() << " N, where it is " << theirs.F_Mo_M.f.transpose()
         << " N";
  else if ((ours.F_Mo_M.tau - theirs.F_Mo_M.tau).norm() > tol.torque_Nm)
    what << "torque " << ours.F_Mo_M.tau.transpose() << " N m, where it is " << theirs.F_Mo_M.tau.transpose()
         << " N m";
  if (!what.str().empty()) throw std::runtime_error(where + ": " + what.str());
}

}  // namespace

void requireAgreement(const std::string& name, const VoxMap& map, const PointShell& shell,
                      const SubjectOptions& options, const Motion& motion, int steps) {
  const auto rival = openVdbQuery(sameField(map), shell, true);
  Subject subject(map, shell, options);
  // Nodes of 16 bits over the band have an error of half of band / 32767 (6e-5 voxel). Positions and weights
  // in single precision have an error of a few 2^-24 of up to 1000 voxels (1e-4 voxel).
  const double tol_m = 3e-4 * map.voxel_m();
  const double area_m2 =
      std::accumulate(shell.area_m2.begin(), shell.area_m2.end(), 0.0) / static_cast<double>(shell.size());
  for (int step = 0; step < steps; ++step) {
    // Without this offset, points on vertices may lie exactly on faces of cells, at which the rival's
    // gradient jumps.
    const Pose X_MP = Pose::translation(map.voxel_m() * Vec3(3.7e-3, 2.1e-3, 4.3e-3)) * motion(step);
    const Answer ours = subject.step(X_MP), theirs = rival->step(X_MP);
    const std::size_t surely = rival->countBelow(X_MP, -tol_m), perhaps = rival->countBelow(X_MP, tol_m);
    // Each touching point may have an error of the tolerance, and its normal an error of 1e-3 where cells
    // meet.
    Tolerance tol{tol_m, 0, 0};
    tol.force_N = kStiffness_N_per_m3 * area_m2 * static_cast<double>(perhaps) * 2 *
                  (tol_m + 1e-3 * std::max(0.0, -theirs.least_m));
    tol.torque_Nm = tol.force_N * map.bounds().size().norm();
    requireSame(ours, theirs, surely, perhaps, tol, name + ", step " + std::to_string(step));
  }
}

}  // namespace vps::bench
