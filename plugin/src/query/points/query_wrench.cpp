// SPDX-License-Identifier: BSD-3-Clause
// Computes the wrench of all touching points without a list of them, for haptic loops; in one direction, and
// in both directions of a pair.
#include <algorithm>

#include "query/points/coherent_walk.h"
#include "query/points/wrench_collector.h"
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
  const MapReading reading(map, shell, X_MP, options.simd);
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

Wrench bothWays(const Wrench& F_B_A, const Wrench& F_A_B, const Mat3& R_AB) {
  return F_B_A * 0.5 + rotated(R_AB, -F_A_B) * 0.5;  // the wrench on B is the opposite of the wrench on A
}

QueryResult queryBothSides(const PairSide& a, const PairSide& b, const Pose& X_AB,
                           const QueryOptions& options, double k_N_per_m3, const Vec3& p_AO,
                           TouchSummary& out, PairMemory* memory) noexcept {
  out = TouchSummary();
  TouchSummary b_in_a, a_in_b;
  const QueryResult first = queryWrench(*a.map, *b.shell, X_AB, options, k_N_per_m3, p_AO, b_in_a,
                                        memory != nullptr ? &memory->b_in_a : nullptr);
  if (first.status == Status::BadPose) return first;
  const Pose X_BA = X_AB.inverse();
  const QueryResult second = queryWrench(*b.map, *a.shell, X_BA, options, k_N_per_m3, X_BA * p_AO, a_in_b,
                                         memory != nullptr ? &memory->a_in_b : nullptr);
  out.count = b_in_a.count + a_in_b.count;
  out.area_m2 = 0.5 * (b_in_a.area_m2 + a_in_b.area_m2);
  out.volume_m3 = 0.5 * (b_in_a.volume_m3 + a_in_b.volume_m3);
  out.max_depth_m = std::max(b_in_a.max_depth_m, a_in_b.max_depth_m);
  out.F_O_M = bothWays(b_in_a.F_O_M, a_in_b.F_O_M, X_AB.R);

  QueryResult result;
  result.status = second.status;
  result.points_tested = first.points_tested + second.points_tested;
  result.min_distance_m = std::min(first.min_distance_m, second.min_distance_m);
  const QueryResult& nearer = second.min_distance_m < first.min_distance_m ? second : first;
  result.is_beyond_band = nearer.is_beyond_band;
  return result;
}

}  // namespace vps
