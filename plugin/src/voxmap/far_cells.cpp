// SPDX-License-Identifier: BSD-3-Clause
// Marks cells that have only empty cells around them: points near such a cell need not be read.
#include "voxmap/voxmap_layout.h"

namespace vps {
namespace {

/// Spreads set entries to their neighbours along one axis.
/// @param stride  distance in memory from neighbour to neighbour
/// @param length  entries of a whole row of neighbours
void spread(const std::vector<std::uint8_t>& from, std::size_t stride, std::size_t length,
            std::vector<std::uint8_t>& to) {
  for (std::size_t row = 0; row < from.size(); row += length) {
    const std::uint8_t* a = &from[row];
    std::uint8_t* __restrict b = &to[row];
    for (std::size_t i = 0; i + stride < length; ++i) b[i] |= a[i + stride];
    for (std::size_t i = stride; i < length; ++i) b[i] |= a[i - stride];
  }
}

}  // namespace

void markFarCells(VoxLayout& layout) {
  std::vector<std::uint8_t> is_used(layout.bricks.size()), wider;
  for (std::size_t i = 0; i < is_used.size(); ++i) is_used[i] = layout.bricks[i] != kOutside;
  layout.far_cells.assign(is_used.size(), 0);
  for (int away = 1; away <= kMostFarCells; ++away) {
    std::size_t stride = 1;
    for (int axis = 2; axis >= 0; --axis) {
      const std::size_t length = stride * static_cast<std::size_t>(layout.size[axis]);
      wider = is_used;
      spread(is_used, stride, length, wider);
      is_used.swap(wider);
      stride = length;
    }
    for (std::size_t i = 0; i < is_used.size(); ++i)
      layout.far_cells[i] = static_cast<std::uint8_t>(layout.far_cells[i] + (is_used[i] == 0 ? 1 : 0));
  }
}

}  // namespace vps
