// SPDX-License-Identifier: BSD-3-Clause
// The kernels as compiled for processors with AVX-512 (flags: CMakeLists.txt), on vectors of sixteen lanes.
#include <immintrin.h>

#include <cstdint>

#include "voxmap/kernels/read_kernel.h"

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

// The form with a mask of all ones is used, because gcc 12 warns of an undefined operand in the plain form.
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

/// True if x, y and z are at least `least`.
inline bool areAtLeast(Axes v, double least) {
  return (_mm256_movemask_pd(_mm256_cmp_pd((__m256d)v, _mm256_set1_pd(least), _CMP_GE_OQ)) & 7) == 7;
}

/// Nearest whole numbers, ties to even.
inline Ints toNearest(Floats v) {
  return (Ints)_mm512_maskz_cvtps_epi32(0xffff, (__m512)v);
}

/// Pairs of nodes at p and p + kY, for two lanes, as four words in the low or the high half. One load of 32
/// bytes brings both pairs of a lane.
template <int kY, bool kIsHigh>
inline __m256i twoLanes(const std::int16_t* p, const std::int16_t* q) {
  constexpr int a = kY, b = kY + 1, c = kY + 16, d = kY + 17;
  const __m256i words = kIsHigh ? _mm256_setr_epi16(0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 16, 17, a, b, c, d)
                                : _mm256_setr_epi16(0, 1, 16, 17, a, b, c, d, 0, 0, 0, 0, 0, 0, 0, 0);
  const auto load = [](const std::int16_t* from) {
    return _mm256_loadu_si256(reinterpret_cast<const __m256i_u*>(from));
  };
  return _mm256_permutex2var_epi16(load(p), words, load(q));
}

/// Pairs of nodes as in twoLanes(), for four lanes.
template <int kY>
inline __m256i fourLanes(const std::int16_t* a, const std::int16_t* b, const std::int16_t* c,
                         const std::int16_t* d) {
  const __m256i low = twoLanes<kY, false>(a, b), high = twoLanes<kY, true>(c, d);
  return _mm256_blend_epi32(low, high, 0xf0);  // a macro in some compilers, which would split a<b, c>()
}

/// The node at(i) of each lane i and the next node along z; the same pairs kY further, kX further, and both.
template <int kY, int kX, typename At>
inline void fetchPairs(At at, Ints* pairs) {
  __m256i even[2][2], odd[2][2];  // pairs of lanes
  // Lanes are processed in halves, because the addresses of all lanes exceed the registers.
  for (int half = 0; half < 2; ++half) {
    const std::int16_t* p[8];
    for (int i = 0; i < 8; ++i) p[i] = at(8 * half + i);
    for (int x = 0; x < 2; ++x) {
      const int k = kX * x;
      even[x][half] = fourLanes<kY>(p[0] + k, p[1] + k, p[4] + k, p[5] + k);
      odd[x][half] = fourLanes<kY>(p[2] + k, p[3] + k, p[6] + k, p[7] + k);
    }
  }
  const auto joined = [](const __m256i* half) {
    return _mm512_maskz_inserti64x4(0xff, _mm512_castsi256_si512(half[0]), half[1], 1);
  };
  for (int x = 0; x < 2; ++x) {
    pairs[2 * x] = (Ints)_mm512_maskz_unpacklo_epi64(0xff, joined(even[x]), joined(odd[x]));
    pairs[2 * x + 1] = (Ints)_mm512_maskz_unpackhi_epi64(0xff, joined(even[x]), joined(odd[x]));
  }
}

#include "voxmap/kernels/read_kernel.inc"

}  // namespace

extern const ReadKernels kAvx512Kernels;
const ReadKernels kAvx512Kernels = {read, bound, touch, addRow, readAt};

}  // namespace vps
