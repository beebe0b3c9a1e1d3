// SPDX-License-Identifier: BSD-3-Clause
// Which instructions the query uses: chosen at run time, with the same bits whichever it is.
#pragma once

#include "vps/export.h"

namespace vps {

/// `Best` is the widest that the processor has. The others are for tests and measurements; one that the
/// processor lacks falls back to the next narrower.
enum class Simd { Best, Scalar, Avx2, Avx512 };

/// What `wanted` comes to on this processor; never `Best`.
VPS_API Simd availableSimd(Simd wanted = Simd::Best) noexcept;
VPS_API const char* toText(Simd simd) noexcept;

}  // namespace vps
