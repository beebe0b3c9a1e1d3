// SPDX-License-Identifier: BSD-3-Clause
// Computes the wrench of all touching points without a list of them, for haptic loops.
#include "query/coherent_walk.h"
#include "query/wrench_collector.h"
#include "vps/query.h"

namespace vps {

QueryResult queryWrench(const VoxMap& map, const PointShell& shell, const Pose& X_MP,
                        const QueryOptions& options, double k_N_per_m3, const Vec3& p_MO, TouchSummary& out,
                        QueryMemory* memory) noexcept {
  out = TouchSummary();
  QueryResult result;
  if (!X_MP.isFinite() || !p_MO.allFinite()) {
    result.status = Status::BadPose;
    return result;
  }
  const Reading reading(map, shell, X_MP, options.simd);
  WrenchCollector collector(reading, X_MP, options.gradient, p_MO);
  const double least_skipped =
      readNearLeaves(reading, X_MP, options, 0, memoryFor(memory, map, shell), result.points_tested,
                     [&](const ReadLeaf& leaf) { collector.take(leaf); });
  collector.finish();
  out = collector.summary(k_N_per_m3);
  setDistance(map, reading, collector.least(), least_skipped, result);
  return result;
}

Wrench penaltyWrench(std::span<const Contact> contacts, double k_N_per_m3, const Vec3& p_MO) noexcept {
  Wrench F_O_M;
  // Summed in the order of ids, so that the result is the same in every run.
  for (const Contact& c : contacts) {
    if (!(c.distance_m < 0)) continue;
    const Vec3 f_M = k_N_per_m3 * c.area_m2 * -c.distance_m * c.n_M;
    F_O_M.f += f_M;
    F_O_M.tau += (c.p_M - p_MO).cross(f_M);
  }
  return F_O_M;
}

}  // namespace vps
