// SPDX-License-Identifier: BSD-3-Clause
// One point of each cluster that answers for all of it.
#pragma once

#include <vector>

#include "vps/pointshell.h"

namespace vps {

/// For each inner block of a shell, in order, its children's samples. A child's sample is that of its points
/// that lies nearest to its centre of area.
struct ClusterSamples {
  PointShell points;  ///< a leaf block for each inner block: samples with all of their children's areas
  std::vector<ShellBlock> spheres;  ///< the same, as spheres around samples that hold the children's points
};

/// O(n log n). The points have no hierarchy.
ClusterSamples clusterSamples(const PointShell& shell);

}  // namespace vps
