// SPDX-License-Identifier: BSD-3-Clause
// The vector instructions that queries use. They are chosen at run time; every choice gives the same bits.
#pragma once

#include "vps/export.h"

namespace vps {

/// `Best` is the faster of the two widest sets that the processor has, by a measurement of 0.1 ms when the
/// program starts. The other values are for tests and measurements; if the processor lacks a set, the next
/// narrower one is used.
enum class Simd { Best, Scalar, Avx2, Avx512 };

/// The set that `wanted` selects on this processor; never `Best`.
VPS_API Simd availableSimd(Simd wanted = Simd::Best) noexcept;
VPS_API const char* toText(Simd simd) noexcept;

}  // namespace vps
