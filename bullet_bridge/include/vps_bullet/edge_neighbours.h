// SPDX-License-Identifier: BSD-3-Clause
// Which of a shell's points on sharp edges lie next to each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vps/pointshell.h"
#include "vps_bullet/export.h"
#include "vps_bullet/precision.h"

namespace vps::bullet::inline v0 {

class VPS_BULLET_API EdgeNeighbours {
 public:
  /// Of no points.
  EdgeNeighbours() = default;
  /// O(n log n); 4 bytes for each point and each neighbour.
  /// @param on_edge  by point: not 0 for those on sharp edges. Empty: none are.
  EdgeNeighbours(const PointShell& shell, std::span<const std::uint8_t> on_edge);

  /// Up to eight edge points nearer to an edge point than one and a half times the shell's spacing, nearest
  /// first: the next ones along its edge, and those on edges beside it. Empty for a point on a face.
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t id) const {
    if (first_.empty()) return {};
    return std::span(ids_).subspan(first_[id], first_[id + 1] - first_[id]);
  }

 private:
  std::vector<std::uint32_t> ids_, first_;  // first_: by point, into ids_
};

}  // namespace vps::bullet::inline v0
