// SPDX-License-Identifier: BSD-3-Clause
// The answer of either side for a pose, so that they can be compared.
#pragma once

#include <cstddef>

#include "vps/wrench.h"

namespace vps::bench {

/// Stiffness of every wrench here [N/m^3]; any value would serve.
inline constexpr double kStiffness_N_per_m3 = 1e12;

struct Answer {
  std::size_t touching = 0;
  double least_m = 0;  ///< least signed distance of any point; +band or more when all are beyond it
  Wrench F_Mo_M;       ///< on the shell's part, about M's origin, in M
};

}  // namespace vps::bench
