// SPDX-License-Identifier: BSD-3-Clause
// The eight corners of a box.
#pragma once

#include <array>

#include "vps/mesh.h"

namespace vps::viewer {

/// Corner i takes the greatest x, y, z where bit 0, 1, 2 of i is set.
inline std::array<Vec3, 8> corners(const Box& box) {
  std::array<Vec3, 8> points;
  for (int i = 0; i < 8; ++i)
    points[static_cast<std::size_t>(i)] =
        Vec3((i & 1) != 0 ? box.max.x() : box.min.x(), (i & 2) != 0 ? box.max.y() : box.min.y(),
             (i & 4) != 0 ? box.max.z() : box.min.z());
  return points;
}

}  // namespace vps::viewer
