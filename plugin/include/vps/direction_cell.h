// SPDX-License-Identifier: BSD-3-Clause
// Classifies directions into a few cells, so that contacts that face different ways are kept apart.
#pragma once

#include <cstdint>

#include "vps/pose.h"

namespace vps {

/// The cell of a direction, among 6 x 2 x 2 cells of a cube's surface: below 24.
inline std::uint32_t directionCell(const Vec3& n) {
  int axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  return static_cast<std::uint32_t>(((axis * 2 + (n[axis] > 0)) * 2 + (n[u] > 0)) * 2 + (n[v] > 0));
}

}  // namespace vps
