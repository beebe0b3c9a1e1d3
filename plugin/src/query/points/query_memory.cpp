// SPDX-License-Identifier: BSD-3-Clause
#include "vps/query_memory.h"

#include <algorithm>
#include <limits>

#include "query/points/coherent_walk.h"

namespace vps {

QueryMemory::QueryMemory(const VoxMap& map, const PointShell& shell)
    : map_(map), shell_(&shell), blocks_(shell.blocks.data()) {
  const std::size_t rows = rowCount(shell);
  // Up to sixteen rows have one block above them; a single leaf, or a single row, is itself the last block.
  for (std::size_t g = 0; g < groupCount(shell); ++g) {
    const ShellBlock& block = shell.blocks[std::min(shell.blocks.size() - 1, shell.leaf_blocks + rows + g)];
    groups_.push_back({Vec3(block.center[0], block.center[1], block.center[2]), block.radius_m, 0, -1, 0});
  }
  row_next_.resize(rows);
  row_near_.resize(rows);
  leaf_next_ = std::make_unique_for_overwrite<double[]>(rows * kLanes);
  clear();
}

void QueryMemory::clear() noexcept {
  const std::size_t rows = row_next_.size();
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const std::size_t of_group = std::min(kGroupRows, rows - g * kGroupRows);
    groups_[g].odometer = 0;
    groups_[g].next = -1;
    groups_[g].closed = rows > 1 ? static_cast<std::uint16_t>((1U << of_group) - 1) : std::uint16_t{0};
  }
  std::fill(row_next_.begin(), row_next_.end(), -1.0);
  std::fill(row_near_.begin(), row_near_.end(), std::uint16_t{0});
  if (rows == 1) openRow(0);
  cutoff_ = kNoQuery;
}

void QueryMemory::openRow(std::size_t row) noexcept {
  double* next = &leaf_next_[row * kLanes];
  std::fill_n(next, kLanes, std::numeric_limits<double>::infinity());
  std::fill_n(next, std::min<std::size_t>(kLanes, shell_->leaf_blocks - row * kLanes), -1.0);
  row_next_[row] = -1;
}

bool QueryMemory::isFor(const VoxMap& map, const PointShell& shell) const noexcept {
  return map_.isSame(map) && shell_ == &shell && blocks_ == shell.blocks.data() &&
         row_next_.size() == rowCount(shell);
}

}  // namespace vps
