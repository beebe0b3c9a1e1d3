// SPDX-License-Identifier: BSD-3-Clause
// A map and a pose in the form that the kernels use.
#include <cmath>

#include "voxmap/kernels/read_kernel.h"
#include "voxmap/voxmap_access.h"

namespace vps {
namespace {

/// An empty map is one cell of the outer constant brick.
constexpr std::uint32_t kNoBricks[1] = {kOutside};
constexpr float kNoCenters[1] = {0};

}  // namespace

FieldView::FieldView(const VoxMap& map) noexcept : voxel_m(map.voxel_m()), quantum_m(map.quantum_m()) {
  const VoxLayout& layout = *VoxMapAccess::layout(map);
  nodes = layout.pool->nodes(0);
  bricks = layout.bricks.data();
  centers_m = layout.centers_m.data();
  far_cells = layout.far_cells.empty() ? nullptr : layout.far_cells.data();
  for (int k = 0; k < 3; ++k) {
    size[k] = layout.size[k];
    low[k] = static_cast<double>(VoxMap::kBrick) * layout.low[k];
  }
  if (layout.bricks.empty()) {
    bricks = kNoBricks;
    centers_m = kNoCenters;
    size[0] = size[1] = size[2] = 1;
    voxel_m = voxel_m > 0 ? voxel_m : 1;
  }
  for (int k = 0; k < 3; ++k) half[k] = 0.5 * VoxMap::kBrick * size[k];
  for (int k = 0; k < 3; ++k) {
    box[0][k] = static_cast<float>(map.bounds().min[k] / voxel_m - low[k]);
    box[1][k] = static_cast<float>(map.bounds().max[k] / voxel_m - low[k]);
  }
  voxels_per_m = static_cast<float>(1 / voxel_m);
  quantum = static_cast<float>(quantum_m / voxel_m);
  band = kFullBand * quantum;
  is_metric = layout.is_metric;
  error = 0.8661f + layout.node_error + quantum;
  diagonal = 1.7322f + 2 * layout.node_error + quantum;
  // Neighbouring nodes along an axis differ by at most `steepest`, and each is rounded by half a quantum.
  slope = 1.7320509f * (layout.steepest + quantum) * (1 + 1e-6f);
}

GridPose::GridPose(const FieldView& field, const Pose& X_MP) noexcept {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      R[3 * i + j] = column[j][i] = X_MP.R(i, j) / field.voxel_m;
      r[3 * i + j] = static_cast<float>(kSteps * R[3 * i + j]);
    }
    p[i] = X_MP.p[i] / field.voxel_m - field.low[i];
  }
  p[3] = column[0][3] = column[1][3] = column[2][3] = 0;
}

}  // namespace vps
