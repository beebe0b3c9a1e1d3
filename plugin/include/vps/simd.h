// SPDX-License-Identifier: BSD-3-Clause
// The vector instructions that queries use, and the blocks of sixteen points or spheres that they process.
// The instructions are chosen at run time; every choice gives the same bits.
#pragma once

#include <cstdint>

#include "vps/export.h"

namespace vps {

/// `Best` is the faster of the two widest instruction sets that the processor has, by a measurement of 0.1 ms
/// when the program starts. The other values are for tests and measurements; if the processor lacks a set,
/// the next narrower set is used.
enum class Simd { Best, Scalar, Avx2, Avx512 };

/// The instruction set that `wanted` selects on this processor; never `Best`.
VPS_API Simd availableSimd(Simd wanted = Simd::Best) noexcept;
VPS_API const char* toText(Simd simd) noexcept;

/// Points or spheres per block: one AVX-512 vector of floats, two of AVX2.
inline constexpr int kLanes = 16;

/// Positions are floats relative to the block's centre, so that their relative error of 1e-7 refers to some
/// millimetres, wherever the block lies. The members are plain, because sources that are compiled for several
/// processors include this header.
struct alignas(64) ShellBlock {
  double center[3] = {0, 0, 0};  ///< of a sphere that holds all lanes' points or spheres, in P [m]
  double radius_m = 0;
  std::uint32_t first = 0;  ///< in a leaf its first point; otherwise the block that lane 0 bounds
  std::uint32_t count = 0;  ///< lanes in use; the unused ones repeat lane 0
  std::uint32_t is_leaf = 0;
  alignas(64) float x[kLanes] = {};  ///< from the centre, in P [m]
  float y[kLanes] = {};
  float z[kLanes] = {};
  float weight[kLanes] = {};  ///< a point's area [m^2], 0 in unused lanes; a sphere's radius [m]
};

}  // namespace vps
