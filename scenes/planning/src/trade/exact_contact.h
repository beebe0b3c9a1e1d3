// SPDX-License-Identifier: BSD-3-Clause
// Contact of a sampled surface with a solid, by exact distances.
#pragma once

#include <limits>
#include <vector>

#include "judge/overlap_judge.h"
#include "trade/surface_samples.h"
#include "vps/wrench.h"

namespace vps::scenes {

/// Any value will do, since only ratios of wrenches are reported.
inline constexpr double kProbeStiffness_N_per_m3 = 1e12;

/// Contact of one part's samples with another solid.
struct ExactContact {
  double least_m = std::numeric_limits<double>::infinity();
  Wrench F_S;  ///< on the samples' part about p_SO, in the solid's frame
};

/// Computes the exact distance of every sample that may touch by the solid's map, whose error is known.
/// @param X_SB  the samples' part in the solid's frame
/// @param p_SO  where the wrench is taken, in the solid's frame
/// Gives the same bits on any number of threads. O(samples), and an exact distance for each that is near.
ExactContact exactContact(const JudgedBody& solid, const std::vector<SurfaceSample>& samples,
                          const Pose& X_SB, const Vec3& p_SO);

}  // namespace vps::scenes
