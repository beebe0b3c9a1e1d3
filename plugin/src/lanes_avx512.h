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
using Axes [[gnu::vector_size(32)]] = double;  // x, y, z, and one that stays 0

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

/// Whether x, y and z of four numbers are at least `least`.
inline bool areAtLeast(Axes v, double least) {
  return (_mm256_movemask_pd(_mm256_cmp_pd((__m256d)v, _mm256_set1_pd(least), _CMP_GE_OQ)) & 7) == 7;
}

/// Nearest whole numbers, ties to even.
inline Ints toNearest(Floats v) {
  return (Ints)_mm512_maskz_cvtps_epi32(0xffff, (__m512)v);
}

/// Pairs of nodes at p and p + kY, of two lanes: four words of each 32 bytes. One load brings both pairs.
template <int kY>
inline __m128i twoLanes(const std::int16_t* p, const std::int16_t* q) {
  const __m256i words = _mm256_setr_epi16(0, 1, 16, 17, kY, kY + 1, kY + 16, kY + 17, 0, 0, 0, 0, 0, 0, 0, 0);
  const auto load = [](const std::int16_t* from) {
    return _mm256_loadu_si256(reinterpret_cast<const __m256i_u*>(from));
  };
  return _mm256_castsi256_si128(_mm256_permutex2var_epi16(load(p), words, load(q)));
}

inline __m512i joined(__m128i a, __m128i b, __m128i c, __m128i d) {
  using Four [[gnu::vector_size(16)]] = std::int32_t;
  using Eight [[gnu::vector_size(32)]] = std::int32_t;
  const auto two = [](__m128i low, __m128i high) -> Eight {
    return __builtin_shufflevector((Four)low, (Four)high, 0, 1, 2, 3, 4, 5, 6, 7);
  };
  return (__m512i)__builtin_shufflevector(two(a, b), two(c, d), 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13,
                                          14, 15);
}

/// The node at(i) of each lane i and the next; the same kY further, kX further, and both.
template <int kY, int kX, typename At>
inline void fetchPairs(At at, Ints* pairs) {
  __m128i low[8], high[8];
  for (int i = 0; i < 8; ++i) {
    const std::int16_t *p = at(2 * i), *q = at(2 * i + 1);
    low[i] = twoLanes<kY>(p, q);
    high[i] = twoLanes<kY>(p + kX, q + kX);
  }
  const auto split = [](const __m128i* two, Ints* out) {
    const __m512i even = joined(two[0], two[2], two[4], two[6]), odd = joined(two[1], two[3], two[5], two[7]);
    out[0] = (Ints)_mm512_maskz_unpacklo_epi64(0xff, even, odd);
    out[1] = (Ints)_mm512_maskz_unpackhi_epi64(0xff, even, odd);
  };
  split(low, pairs);
  split(high, pairs + 2);
}

}  // namespace
}  // namespace vps
