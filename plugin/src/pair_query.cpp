// SPDX-License-Identifier: BSD-3-Clause
#include "vps/pair_query.h"

#include <algorithm>

namespace vps {

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
  // The second is on A, in B: B gets the opposite.
  out.F_O_M = b_in_a.F_O_M * 0.5 + rotated(X_AB.R, -a_in_b.F_O_M) * 0.5;

  QueryResult result;
  result.status = second.status;
  result.points_tested = first.points_tested + second.points_tested;
  result.min_distance_m = std::min(first.min_distance_m, second.min_distance_m);
  const QueryResult& nearer = second.min_distance_m < first.min_distance_m ? second : first;
  result.is_beyond_band = nearer.is_beyond_band;
  return result;
}

}  // namespace vps
