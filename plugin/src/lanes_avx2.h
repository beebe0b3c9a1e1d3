// SPDX-License-Identifier: BSD-3-Clause
// Vectors for the kernels on processors with AVX2: eight lanes. See lanes_avx512.h for what each means.
#pragma once

#include <immintrin.h>

#include <cstdint>

namespace vps {
namespace {

constexpr int kWide = 8;
using Ints [[gnu::vector_size(32), gnu::may_alias]] = std::int32_t;
using Floats [[gnu::vector_size(32), gnu::may_alias]] = float;

inline Ints sumOfProducts(Ints pairs, Ints weights) {
  return (Ints)_mm256_madd_epi16((__m256i)pairs, (__m256i)weights);
}

inline Floats squareRoots(Floats v) {
  return (Floats)_mm256_sqrt_ps((__m256)v);
}

inline float leastOf(Floats v) {
  __m128 least = _mm_min_ps(_mm256_castps256_ps128((__m256)v), _mm256_extractf128_ps((__m256)v, 1));
  least = _mm_min_ps(least, _mm_movehl_ps(least, least));
  return _mm_cvtss_f32(_mm_min_ss(least, _mm_movehdup_ps(least)));
}

inline std::uint32_t bitsOf(Ints mask) {
  return static_cast<std::uint32_t>(_mm256_movemask_ps((__m256)mask));
}

template <typename T>
inline Ints eightAt(const T* table, const std::uint32_t* index, int offset) {
  const auto load = [&](int i) { return _mm_loadu_si32(table + index[i] + offset); };
  const __m128i low =
      _mm_unpacklo_epi64(_mm_unpacklo_epi32(load(0), load(1)), _mm_unpacklo_epi32(load(2), load(3)));
  const __m128i high =
      _mm_unpacklo_epi64(_mm_unpacklo_epi32(load(4), load(5)), _mm_unpacklo_epi32(load(6), load(7)));
  return (Ints)_mm256_inserti128_si256(_mm256_castsi128_si256(low), high, 1);
}

inline Ints lookedUp(const std::uint32_t* table, const std::uint32_t* index) {
  return eightAt(table, index, 0);
}

template <int... kOffsets>
inline void fetchPairs(const std::int16_t* nodes, const std::uint32_t* element, Ints* pairs) {
  ((*pairs++ = eightAt(nodes, element, kOffsets)), ...);
}

}  // namespace
}  // namespace vps
