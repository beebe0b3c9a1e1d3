// SPDX-License-Identifier: BSD-3-Clause
#include "vps/simd.h"

#include <new>

#include "voxmap/kernel_timing.h"
#include "voxmap/read_kernel.h"

namespace vps {

extern const ReadKernels kScalarKernels;
#ifdef VPS_HAS_X86_KERNELS
extern const ReadKernels kAvx2Kernels, kAvx512Kernels;
#endif

namespace {

Simd widest() noexcept {
#ifdef VPS_HAS_X86_KERNELS
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return Simd::Avx512;
  if (__builtin_cpu_supports("avx2")) return Simd::Avx2;
#endif
  return Simd::Scalar;
}

/// The faster of the two widest sets: on some processors AVX2 reads as fast as AVX-512 or faster, and all
/// sets give the same bits. If memory is short, the wider set is taken.
Simd fastest(Simd widest_here) noexcept {
#ifdef VPS_HAS_X86_KERNELS
  try {
    if (widest_here == Simd::Avx512 && !isFaster(kAvx512Kernels, kAvx2Kernels)) return Simd::Avx2;
  } catch (const std::bad_alloc&) {
    return widest_here;
  }
#endif
  return widest_here;
}

/// Determined when the program starts, so that the first query does not wait. The constructor of another
/// global object that runs earlier reads zero, which is Best and leads to the scalar kernels.
const Simd kWidest = widest();
const Simd kFastest = fastest(kWidest);

}  // namespace

Simd availableSimd(Simd wanted) noexcept {
  if (wanted == Simd::Best) return kFastest;
  const Simd widest_here = kWidest;
  return wanted > widest_here ? widest_here : wanted;
}

const char* toText(Simd simd) noexcept {
  switch (simd) {
    case Simd::Best:
      return "best";
    case Simd::Scalar:
      return "scalar";
    case Simd::Avx2:
      return "AVX2";
    case Simd::Avx512:
      return "AVX-512";
  }
  return "unknown";
}

const ReadKernels& readKernels(Simd simd) noexcept {
#ifdef VPS_HAS_X86_KERNELS
  switch (availableSimd(simd)) {
    case Simd::Avx512:
      return kAvx512Kernels;
    case Simd::Avx2:
      return kAvx2Kernels;
    default:
      break;
  }
#endif
  return kScalarKernels;
}

}  // namespace vps
