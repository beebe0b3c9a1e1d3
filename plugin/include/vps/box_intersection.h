// SPDX-License-Identifier: BSD-3-Clause
// The intersection of two axis-aligned boxes.
#pragma once

#include "vps/box.h"

namespace vps {

/// The box of all points that lie in both boxes. Empty if the boxes share no point; the middle of such an
/// empty box lies between the two boxes.
[[nodiscard]] inline Box intersection(const Box& a, const Box& b) noexcept {
  Box out;
  out.min = a.min.cwiseMax(b.min);
  out.max = a.max.cwiseMin(b.max);
  return out;
}

}  // namespace vps
