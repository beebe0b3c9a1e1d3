// SPDX-License-Identifier: BSD-3-Clause
// Differences of neighbouring nodes of a brick. They bound the slope of the field.
#pragma once

#include <algorithm>
#include <cstdlib>

#include "voxmap/voxmap_layout.h"

namespace vps {

/// The largest difference of nodes that are one step (X, Y, Z) apart, over a brick [quanta].
template <int X, int Y, int Z>
int mostDifference(const NodeValue* nodes) {
  constexpr int kStep = nodeIndex(X, Y, Z);
  int most = 0;
  for (int x = 0; x < kNodes - X; ++x)
    for (int y = std::max(0, -Y); y < kNodes - std::max(0, Y); ++y)
      for (int z = std::max(0, -Z); z < kNodes - std::max(0, Z); ++z) {
        const NodeValue* node = nodes + nodeIndex(x, y, z);
        most = std::max(most, std::abs(int{node[kStep]} - int{node[0]}));
      }
  return most;
}

/// The largest difference of neighbours along the three axes [quanta].
inline int mostAlongAxes(const NodeValue* nodes) {
  return std::max(
      {mostDifference<1, 0, 0>(nodes), mostDifference<0, 1, 0>(nodes), mostDifference<0, 0, 1>(nodes)});
}

/// Converts a difference of neighbours along an axis to VoxLayout::steepest. Rounding alone makes a quantum.
inline float steepnessOf(int difference, double voxel_m, double quantum_m) {
  return static_cast<float>((difference - 1) * quantum_m / voxel_m * (1 + 1e-6));
}

}  // namespace vps
