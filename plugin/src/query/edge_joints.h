// SPDX-License-Identifier: BSD-3-Clause
// Finds the places where an edge continues in another edge.
#pragma once

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

#include "vps/pose.h"

namespace vps {

/// An end of an edge.
struct EdgeEnd {
  std::uint32_t vertex, edge;
  int end;    ///< 0 or 1
  Vec3 away;  ///< unit, along the edge
};

/// Calls visit(a, b) for each vertex at which exactly two ends meet, with these ends. O(n log n); sorts the
/// ends.
template <typename Visit>
void forEachJoint(std::vector<EdgeEnd>& ends, Visit visit) {
  std::sort(ends.begin(), ends.end(), [](const EdgeEnd& a, const EdgeEnd& b) {
    return std::tie(a.vertex, a.edge) < std::tie(b.vertex, b.edge);
  });
  for (std::size_t i = 0; i < ends.size();) {
    std::size_t next = i + 1;
    while (next < ends.size() && ends[next].vertex == ends[i].vertex) ++next;
    if (next - i == 2) visit(ends[i], ends[i + 1]);
    i = next;
  }
}

}  // namespace vps
