// SPDX-License-Identifier: BSD-3-Clause
// Vectors for the kernels on any processor: four lanes. See lanes_avx512.h for what each means.
#pragma once

#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <cstdint>
#include <cstring>

namespace vps {
namespace {

constexpr int kWide = 4;
using Ints [[gnu::vector_size(16), gnu::may_alias]] = std::int32_t;
using Floats [[gnu::vector_size(16), gnu::may_alias]] = float;

inline Ints sumOfProducts(Ints pairs, Ints weights) {
#ifdef __SSE2__
  return (Ints)_mm_madd_epi16((__m128i)pairs, (__m128i)weights);
#else
  using Unsigned [[gnu::vector_size(16)]] = std::uint32_t;
  const Ints low = (Ints)((Unsigned)pairs << 16) >> 16, low_weight = (Ints)((Unsigned)weights << 16) >> 16;
  return low * low_weight + (pairs >> 16) * (weights >> 16);
#endif
}

inline Floats squareRoots(Floats v) {
#ifdef __SSE2__
  return (Floats)_mm_sqrt_ps((__m128)v);
#else
  for (int i = 0; i < kWide; ++i) v[i] = __builtin_sqrtf(v[i]);
  return v;
#endif
}

inline float leastOf(Floats v) {
  const float a = v[2] < v[0] ? v[2] : v[0], b = v[3] < v[1] ? v[3] : v[1];
  return b < a ? b : a;
}

inline std::uint32_t bitsOf(Ints mask) {
#ifdef __SSE2__
  return static_cast<std::uint32_t>(_mm_movemask_ps((__m128)mask));
#else
  std::uint32_t bits = 0;
  for (int i = 0; i < kWide; ++i) bits |= (mask[i] != 0 ? 1u : 0u) << i;
  return bits;
#endif
}

inline Ints lookedUp(const std::uint32_t* table, const std::uint32_t* index) {
  const auto at = [&](int i) { return static_cast<std::int32_t>(table[index[i]]); };
  return Ints{at(0), at(1), at(2), at(3)};
}

inline std::int32_t pairAt(const std::int16_t* node) {
  std::int32_t both;
  std::memcpy(&both, node, sizeof both);
  return both;
}

template <int... kOffsets>
inline void fetchPairs(const std::int16_t* nodes, const std::uint32_t* element, Ints* pairs) {
  const std::int16_t* at[kWide];
  for (int i = 0; i < kWide; ++i) at[i] = nodes + element[i];
  ((*pairs++ = Ints{pairAt(at[0] + kOffsets), pairAt(at[1] + kOffsets), pairAt(at[2] + kOffsets),
                    pairAt(at[3] + kOffsets)}),
   ...);
}

}  // namespace
}  // namespace vps
