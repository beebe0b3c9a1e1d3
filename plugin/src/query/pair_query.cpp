// SPDX-License-Identifier: BSD-3-Clause
#include "vps/pair_query.h"

#include <algorithm>

namespace vps {

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
