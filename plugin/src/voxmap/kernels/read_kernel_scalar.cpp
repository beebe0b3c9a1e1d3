// SPDX-License-Identifier: BSD-3-Clause
// The kernels as compiled for any processor, on vectors of four lanes. read_kernel_avx512.cpp describes each
// vector function.
#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include <cstdint>
#include <cstring>

#include "voxmap/kernels/read_kernel.h"

namespace vps {
namespace {

constexpr int kWide = 4;
using Ints [[gnu::vector_size(16), gnu::may_alias]] = std::int32_t;
using Floats [[gnu::vector_size(16), gnu::may_alias]] = float;
using Axes [[gnu::vector_size(32)]] = double;

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

inline bool areAtLeast(const Axes& v, double least) {
  return v[0] >= least && v[1] >= least && v[2] >= least;
}

inline Ints toNearest(Floats v) {
#ifdef __SSE2__
  return (Ints)_mm_cvtps_epi32((__m128)v);
#else
  Ints n;
  for (int i = 0; i < kWide; ++i) n[i] = static_cast<std::int32_t>(__builtin_rintf(v[i]));
  return n;
#endif
}

inline std::int32_t pairAt(const std::int16_t* node) {
  std::int32_t both;
  std::memcpy(&both, node, sizeof both);
  return both;
}

template <int kY, int kX, typename At>
inline void fetchPairs(At at, Ints* pairs) {
  const std::int16_t* p[kWide];
  for (int i = 0; i < kWide; ++i) p[i] = at(i);
  const auto gather = [&](int offset) {
    return Ints{pairAt(p[0] + offset), pairAt(p[1] + offset), pairAt(p[2] + offset), pairAt(p[3] + offset)};
  };
  pairs[0] = gather(0);
  pairs[1] = gather(kY);
  pairs[2] = gather(kX);
  pairs[3] = gather(kX + kY);
}

#include "voxmap/kernels/read_kernel.inc"

}  // namespace

extern const ReadKernels kScalarKernels;
const ReadKernels kScalarKernels = {read, bound, touch, addRow, readAt};

}  // namespace vps
