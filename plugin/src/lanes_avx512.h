// SPDX-License-Identifier: BSD-3-Clause
// Vectors for the kernels on processors with AVX-512: sixteen lanes.
#pragma once

#include <immintrin.h>

#include <cstdint>

namespace vps {
namespace {

constexpr int kWide = 16;
using Ints [[gnu::vector_size(64), gnu::may_alias]] = std::int32_t;
using Floats [[gnu::vector_size(64), gnu::may_alias]] = float;

/// low * low + high * high of the two halves of each lane.
inline Ints sumOfProducts(Ints pairs, Ints weights) {
  return (Ints)_mm512_madd_epi16((__m512i)pairs, (__m512i)weights);
}

// With a mask of all ones: gcc 12 warns of what the plain form leaves undefined.
inline Floats squareRoots(Floats v) {
  return (Floats)_mm512_maskz_sqrt_ps(0xffff, (__m512)v);
}

inline float leastOf(Floats v) {
  const auto low = __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7);
  const auto high = __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15);
  const __m256 eight = _mm256_min_ps((__m256)low, (__m256)high);
  __m128 least = _mm_min_ps(_mm256_castps256_ps128(eight), _mm256_extractf128_ps(eight, 1));
  least = _mm_min_ps(least, _mm_movehl_ps(least, least));
  return _mm_cvtss_f32(_mm_min_ss(least, _mm_movehdup_ps(least)));
}

/// A bit for each lane that is not zero.
inline std::uint32_t bitsOf(Ints mask) {
  return _mm512_test_epi32_mask((__m512i)mask, (__m512i)mask);
}

/// Eight lanes of table[index + kOffsets], and the next 16 bits where T has so few. Loads that broadcast into
/// one lane each take no shuffle, and no store as gathering by hand does.
template <int... kOffsets, typename T>
inline void eightAt(const T* table, const std::uint32_t* index, __m256i* out) {
  const auto load = [](const T* p) { return _mm_loadu_si32(p); };
  const T* at[8];
  for (int i = 0; i < 8; ++i) at[i] = table + index[i];
  const auto gather = [&](int offset) {
    __m256i v = _mm256_castsi128_si256(load(at[0] + offset));
    v = _mm256_mask_broadcastd_epi32(v, 0x02, load(at[1] + offset));
    v = _mm256_mask_broadcastd_epi32(v, 0x04, load(at[2] + offset));
    v = _mm256_mask_broadcastd_epi32(v, 0x08, load(at[3] + offset));
    v = _mm256_mask_broadcastd_epi32(v, 0x10, load(at[4] + offset));
    v = _mm256_mask_broadcastd_epi32(v, 0x20, load(at[5] + offset));
    v = _mm256_mask_broadcastd_epi32(v, 0x40, load(at[6] + offset));
    return _mm256_mask_broadcastd_epi32(v, 0x80, load(at[7] + offset));
  };
  ((*out++ = gather(kOffsets)), ...);
}

inline Ints joined(__m256i low, __m256i high) {
  using Eight [[gnu::vector_size(32)]] = std::int32_t;
  return __builtin_shufflevector((Eight)low, (Eight)high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14,
                                 15);
}

/// table[index] of each lane.
inline Ints lookedUp(const std::uint32_t* table, const std::uint32_t* index) {
  __m256i low, high;
  eightAt<0>(table, index, &low);
  eightAt<0>(table, index + 8, &high);
  return joined(low, high);
}

/// The nodes at kOffsets from each lane's element, and the next: low and high half.
template <int... kOffsets>
inline void fetchPairs(const std::int16_t* nodes, const std::uint32_t* element, Ints* pairs) {
  __m256i low[sizeof...(kOffsets)], high[sizeof...(kOffsets)];
  eightAt<kOffsets...>(nodes, element, low);
  asm volatile("" ::: "memory");  // eight addresses are all that registers hold
  eightAt<kOffsets...>(nodes, element + 8, high);
  for (unsigned k = 0; k < sizeof...(kOffsets); ++k) pairs[k] = joined(low[k], high[k]);
}

}  // namespace
}  // namespace vps
