// SPDX-License-Identifier: BSD-3-Clause
// What samples of one surface say of another solid, by exact distance.
#pragma once

#include <limits>
#include <vector>

#include "judge/overlap_judge.h"
#include "trade/surface_samples.h"
#include "vps/wrench.h"

namespace vps::scenes {

/// Any: only ratios of wrenches are reported.
inline constexpr double kProbeStiffness_N_per_m3 = 1e12;

/// What one side's samples say of another solid.
struct Touch {
  double least_m = std::numeric_limits<double>::infinity();
  Wrench F_S;  ///< on the samples' part about p_SO, in the solid's frame
};

/// Every sample that the solid's map does not put farther than its error is looked at exactly.
/// @param X_SB  the samples' part in the solid's frame
/// @param p_SO  where the wrench is taken, in the solid's frame
/// Same bits on any number of threads. O(samples), and an exact distance for each that is near.
Touch exactTouch(const JudgedBody& solid, const std::vector<SurfaceSample>& samples, const Pose& X_SB,
                 const Vec3& p_SO);

}  // namespace vps::scenes
