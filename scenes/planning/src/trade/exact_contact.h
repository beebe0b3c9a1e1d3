// SPDX-License-Identifier: BSD-3-Clause
// Contact of a sampled surface with a solid, measured by exact distances.
#pragma once

#include <limits>
#include <vector>

#include "judge/overlap_judge.h"
#include "trade/surface_samples.h"
#include "vps/wrench.h"

namespace vps::scenes {

/// Stiffness of the probe's penalty contact. Its value is arbitrary, since only ratios of wrenches are
/// reported.
inline constexpr double kProbeStiffness_N_per_m3 = 1e12;

/// Contact of one part's samples with another solid.
struct ExactContact {
  double least_m = std::numeric_limits<double>::infinity();
  Wrench F_S;  ///< wrench on the sampled part about p_SO, in the solid's frame S
};

/// Computes the exact distance of each sample that may touch; the solid's map, whose error is known, excludes
/// the others.
/// @param X_SB  pose of the sampled part B in the solid's frame S
/// @param p_SO  reference point of the wrench, in the solid's frame
/// @return the same bits for any number of threads. O(samples), plus an exact distance for each near sample.
ExactContact exactContact(const JudgedBody& solid, const std::vector<SurfaceSample>& samples,
                          const Pose& X_SB, const Vec3& p_SO);

}  // namespace vps::scenes
