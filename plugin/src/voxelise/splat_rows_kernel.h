// SPDX-License-Identifier: BSD-3-Clause
// The body of findRows(), compiled once for each set of vector instructions. All copies do the same
// operations on each value, so the bits are the same. This file includes no header with inline functions,
// because the linker would keep one copy of such functions for all processors.
#pragma once

#include "voxelise/splat_rows.h"

namespace vps {
namespace {  // one copy for each set of instructions

/// Vectors of eight, which GCC and Clang split if the processor's vectors are shorter. GCC 12 did not
/// vectorise loops over arrays of eight.
using Floats = float __attribute__((vector_size(32)));
using Ints = int __attribute__((vector_size(32)));
inline constexpr int kRowLanes = 8;

inline int findRowsHere(const SplatRegion& region, SplatRow* rows) {
  constexpr Floats kLane = {0, 1, 2, 3, 4, 5, 6, 7};
  // Both ends are moved outwards by the rounding error of z.
  constexpr float kMargin = 1e-3F;
  const Floats first = static_cast<float>(region.low[2]) - kMargin - Floats{};
  const Floats last = static_cast<float>(region.high[2]) + kMargin - Floats{};
  int count = 0;
  for (int x = region.low[0]; x <= region.high[0]; ++x) {
    for (int y = region.low[1]; y <= region.high[1]; y += kRowLanes) {
      Floats low = first, high = last;
      const Floats at_y = static_cast<float>(y) + kLane;
      for (int k = 0; k < region.count; ++k) {
        const Floats z = region.at[k] + region.per_x[k] * static_cast<float>(x) + region.per_y[k] * at_y;
        const Floats from = z + region.lift[k], to = z + region.drop[k];
        low = low > from ? low : from;
        high = high < to ? high : to;
      }
      // Truncation equals the floor for numbers that are not negative; low is at least -kMargin.
      const Floats kFar = 1e3F - Floats{}, kBelow = -1.F - Floats{};
      low = low < kFar ? low : kFar;
      high = high > kBelow ? high : kBelow;
      const Ints from = __builtin_convertvector(low + (1 - 2 * kMargin), Ints);
      const Ints end = __builtin_convertvector(high + (1 + 2 * kMargin), Ints);
      // NaN, from features too thin or too far away for floats, converts to the least integer, which is no
      // row.
      const Ints is_row = (from < end) & (from >= 0);
      using Pairs = long long __attribute__((vector_size(32)));
      const auto pairs = reinterpret_cast<Pairs>(is_row);
      if ((pairs[0] | pairs[1] | pairs[2] | pairs[3]) == 0) continue;
      const int left = region.high[1] - y + 1, lanes = left < kRowLanes ? left : kRowLanes;
      for (int i = 0; i < lanes; ++i) {
        if (is_row[i] == 0) continue;
        rows[count++] = {static_cast<unsigned char>(x), static_cast<unsigned char>(y + i),
                         static_cast<unsigned char>(from[i]), static_cast<unsigned char>(end[i] - 1)};
      }
    }
  }
  return count;
}

}  // namespace
}  // namespace vps
