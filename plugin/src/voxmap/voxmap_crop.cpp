// SPDX-License-Identifier: BSD-3-Clause
// Reduces a map to the nodes in or near some boxes.
#include <algorithm>

#include "voxmap/voxmap_access.h"
#include "vps/voxmap.h"

namespace vps {
namespace {

/// True for cells of 8 voxels in a box or next to it; gradients at a box's border read nodes beyond it.
bool isNear(const std::vector<Box>& boxes_M, const Index3& cell, double cell_m) {
  Box room;
  room.add(cell_m * (cell - Index3::Ones()).cast<double>());
  room.add(cell_m * (cell + Index3::Constant(2)).cast<double>());
  return std::any_of(boxes_M.begin(), boxes_M.end(), [&](const Box& box) { return overlap(box, room); });
}

}  // namespace

VoxMap croppedVoxMap(const VoxMap& map, const std::vector<Box>& boxes_M) {
  auto layout = std::make_shared<VoxLayout>(*VoxMapAccess::layout(map));
  for (std::size_t i = 0; i < layout->bricks.size(); ++i) {
    std::uint32_t& brick = layout->bricks[i];
    if (isConstant(brick) || isNear(boxes_M, layout->cellAt(i), VoxMap::kBrick * map.voxel_m())) continue;
    brick = layout->centers_m[i] < 0 ? kInside : kOutside;
  }
  moveToNewPool(*layout, 0);
  markFarCells(*layout);
  return VoxMapAccess::make(layout, map.voxel_m(), map.band_m(), map.bounds());
}

}  // namespace vps
