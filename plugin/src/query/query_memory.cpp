// SPDX-License-Identifier: BSD-3-Clause
#include "vps/query_memory.h"

#include <algorithm>
#include <limits>

#include "query/coherent_walk.h"

namespace vps::inline v0 {

QueryMemory::QueryMemory(const VoxMap& map, const PointShell& shell)
    : map_(map), shell_(&shell), blocks_(shell.blocks.data()) {
  const auto sphere = [](const ShellBlock& b) { return Vec3(b.center[0], b.center[1], b.center[2]); };
  for (std::size_t first = 0; first < shell.leaf_blocks; first += kGroupLeaves) {
    const std::size_t end = std::min(shell.leaf_blocks, first + kGroupLeaves);
    Box box;
    for (std::size_t i = first; i < end; ++i) box.add(sphere(shell.blocks[i]));
    Group group;
    group.center = box.center();
    for (std::size_t i = first; i < end; ++i)
      group.radius_m = std::max(group.radius_m,
                                (sphere(shell.blocks[i]) - group.center).norm() + shell.blocks[i].radius_m);
    groups_.push_back(group);
  }
  row_next_.resize((shell.leaf_blocks + kLanes - 1) / kLanes);
  row_near_.resize(row_next_.size());
  leaf_next_.resize(row_next_.size() * kLanes);
  clear();
}

void QueryMemory::clear() noexcept {
  for (Group& group : groups_) group.odometer = 0, group.next = -1;
  std::fill(row_next_.begin(), row_next_.end(), -1.0);
  std::fill(leaf_next_.begin(), leaf_next_.end(), std::numeric_limits<double>::infinity());
  std::fill_n(leaf_next_.begin(), shell_->leaf_blocks, -1.0);
  std::fill(row_near_.begin(), row_near_.end(), std::uint16_t{0});
  cutoff_ = kNoQuery;
}

bool QueryMemory::isFor(const VoxMap& map, const PointShell& shell) const noexcept {
  return map_.isSame(map) && shell_ == &shell && blocks_ == shell.blocks.data() &&
         row_next_.size() == (shell.leaf_blocks + kLanes - 1) / kLanes;
}

}  // namespace vps::inline v0
