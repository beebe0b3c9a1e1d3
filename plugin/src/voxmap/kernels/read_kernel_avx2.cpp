// SPDX-License-Identifier: BSD-3-Clause
// The kernels as compiled for processors with AVX2 (flags: CMakeLists.txt), on vectors of eight lanes.
// read_kernel_avx512.cpp describes each vector function.
#include <immintrin.h>

#include <cstdint>

#include "voxmap/kernels/read_kernel.h"

namespace vps {
namespace {

constexpr int kWide = 8;
using Ints [[gnu::vector_size(32), gnu::may_alias]] = std::int32_t;
using Floats [[gnu::vector_size(32), gnu::may_alias]] = float;
using Axes [[gnu::vector_size(32)]] = double;

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

inline bool areAtLeast(Axes v, double least) {
  return (_mm256_movemask_pd(_mm256_cmp_pd((__m256d)v, _mm256_set1_pd(least), _CMP_GE_OQ)) & 7) == 7;
}

inline Ints toNearest(Floats v) {
  return (Ints)_mm256_cvtps_epi32((__m256)v);
}

template <int kY, int kX, typename At>
inline void fetchPairs(At at, Ints* pairs) {
  const std::int16_t* p[kWide];
  for (int i = 0; i < kWide; ++i) p[i] = at(i);
  const auto gather = [&](int offset) {
    const auto load = [&](int i) { return _mm_loadu_si32(p[i] + offset); };
    const __m128i low =
        _mm_unpacklo_epi64(_mm_unpacklo_epi32(load(0), load(1)), _mm_unpacklo_epi32(load(2), load(3)));
    const __m128i high =
        _mm_unpacklo_epi64(_mm_unpacklo_epi32(load(4), load(5)), _mm_unpacklo_epi32(load(6), load(7)));
    return (Ints)_mm256_inserti128_si256(_mm256_castsi128_si256(low), high, 1);
  };
  pairs[0] = gather(0);
  pairs[1] = gather(kY);
  pairs[2] = gather(kX);
  pairs[3] = gather(kX + kY);
}

#include "voxmap/kernels/read_kernel.inc"

}  // namespace

extern const ReadKernels kAvx2Kernels;
const ReadKernels kAvx2Kernels = {read, bound, touch, addRow, readAt};

}  // namespace vps
