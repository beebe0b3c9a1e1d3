// SPDX-License-Identifier: BSD-3-Clause
// Cells whose neighbours are all empty: the sixteen points of a leaf in such a cell need not be read.
#include "voxmap/voxmap_layout.h"

namespace vps::inline v0 {
namespace {

/// Spreads set entries to their neighbours along one axis. `stride`: from neighbour to neighbour; `length`:
/// of a whole row of them.
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
  std::vector<std::uint8_t> is_used(layout.bricks.size());
  for (std::size_t i = 0; i < is_used.size(); ++i) is_used[i] = layout.bricks[i] != kOutside;
  std::size_t stride = 1;
  for (int axis = 2; axis >= 0; --axis) {
    const std::size_t length = stride * static_cast<std::size_t>(layout.size[axis]);
    std::vector<std::uint8_t> wider = is_used;
    spread(is_used, stride, length, wider);
    is_used = std::move(wider);
    stride = length;
  }
  for (std::uint8_t& is_far : is_used) is_far = !is_far;
  layout.is_far = std::move(is_used);
}

}  // namespace vps::inline v0
