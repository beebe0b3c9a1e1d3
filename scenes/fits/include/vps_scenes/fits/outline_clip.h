// SPDX-License-Identifier: BSD-3-Clause
// Outlines within a square window.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace vps::scenes {

/// The part of a closed chain of points that lies within half_m of the middle along both axes. Sutherland and
/// Hodgman 1974. O(n).
inline std::vector<std::array<double, 2>> clippedToSquare(std::vector<std::array<double, 2>> chain,
                                                          const std::array<double, 2>& middle_m,
                                                          double half_m) {
  for (const std::size_t axis : {0U, 1U})
    for (const double sign : {1.0, -1.0}) {
      std::vector<std::array<double, 2>> kept;
      for (std::size_t k = 0; k < chain.size(); ++k) {
        const auto &a = chain[k], &b = chain[(k + 1) % chain.size()];
        const double in_a = half_m - sign * (a[axis] - middle_m[axis]),
                     in_b = half_m - sign * (b[axis] - middle_m[axis]);
        if (in_a >= 0) kept.push_back(a);
        if ((in_a >= 0) == (in_b >= 0)) continue;
        const double share = in_a / (in_a - in_b);
        kept.push_back({a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])});
      }
      chain = std::move(kept);
    }
  return chain;
}

}  // namespace vps::scenes
