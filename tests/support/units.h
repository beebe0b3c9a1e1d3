// SPDX-License-Identifier: BSD-3-Clause
// Factors from the units in which tests state lengths to metres.
#pragma once

namespace vps {

inline constexpr double kMm = 1e-3;
inline constexpr double kUm = 1e-6;

}  // namespace vps
