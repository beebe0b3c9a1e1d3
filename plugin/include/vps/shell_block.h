// SPDX-License-Identifier: BSD-3-Clause
// Sixteen points of a pointshell, or sixteen spheres around such, side by side as one vector takes them.
#pragma once

#include <cstdint>

namespace vps {

/// Points or spheres per block: one AVX-512 vector of floats, two of AVX2.
inline constexpr int kLanes = 16;

/// Offsets are floats from a centre of the block's own: a few millimetres to 1e-7 of themselves, wherever the
/// block lies. No members but plain ones: sources that are compiled for several processors include this.
struct alignas(64) ShellBlock {
  double center[3] = {0, 0, 0};  ///< of a sphere that holds all lanes' points or spheres, in P [m]
  double radius_m = 0;
  std::uint32_t first = 0;  ///< a leaf's first point; else the first of the blocks that lanes stand for
  std::uint32_t count = 0;  ///< lanes in use; the others repeat lane 0
  std::uint32_t is_leaf = 0;
  alignas(64) float x[kLanes] = {};  ///< from the centre, in P [m]
  float y[kLanes] = {};
  float z[kLanes] = {};
  float weight[kLanes] = {};  ///< a point's area [m^2], 0 in lanes not in use; a sphere's radius [m]
};

}  // namespace vps
