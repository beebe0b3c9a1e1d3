// SPDX-License-Identifier: BSD-3-Clause
// The coarse part of a map that is fine only in regions.
//
//   a fine cell of a region, with a brick   its own nodes
//   any other cell                          the coarse field, read at the fine grid's nodes when asked
//
// It is as if the coarse map had been resampled onto the fine grid, but takes no memory. The grids nest, so
// that interpolating such nodes gives the coarse field again (but for a node's rounding); and bricks have
// just the same nodes where they meet the coarse part, so that distance never jumps.
#pragma once

#include <algorithm>

#include "voxmap/read_kernel.h"
#include "voxmap/voxmap_layout.h"

namespace vps {

/// Nodes of the fine grid in the coarse field. The layout must have a coarse one, and outlive this.
class CoarseNodes {
 public:
  explicit CoarseNodes(const VoxLayout& fine) noexcept : coarse_(*fine.coarse), shift_(fine.coarse_shift) {}

  /// A node of the fine grid, by its index from the map's origin.
  [[nodiscard]] NodeValue node(const Index3& at) const noexcept {
    NodeValue nodes[8];
    corners(at, nodes);
    return nodes[0];
  }
  /// The nodes at the corners of a fine grid cell; bits of the index: x y z.
  void corners(const Index3& low, NodeValue out[8]) const noexcept {
    const Block block(*this, low);
    block.corners(out);
  }
  /// Whether all nodes of a fine directory cell, border included, are one end of the band; and which.
  [[nodiscard]] bool isConstant(const Index3& cell, std::uint32_t& kind) const noexcept;

 private:
  /// The coarse grid cell that holds a fine one.
  class Block {
   public:
    Block(const CoarseNodes& in, const Index3& low) noexcept : steps_(1 << in.shift_) {
      Index3 cell;
      for (int k = 0; k < 3; ++k) {
        cell[k] = low[k] >> in.shift_;
        from_[k] = low[k] & (steps_ - 1);
      }
      in.corner(cell, node_);
      // A power of two, so that the product is exact.
      scale_ = 1.0 / (steps_ * steps_ * steps_);
    }
    /// Whole numbers until they are rounded, so that a node is the same from every cell that has it.
    void corners(NodeValue out[8]) const noexcept {
      int z[8], y[8];
      narrow<1>(node_, from_[2], z);
      narrow<2>(z, from_[1], y);
      int x[8];
      narrow<4>(y, from_[0], x);
      for (int k = 0; k < 8; ++k) out[k] = nodeOf(scale_ * x[k]);
    }

   private:
    /// Along an axis (its bit of the index), from the ends of the coarse cell to those of the fine one.
    template <int Bit>
    void narrow(const int* in, int t, int* out) const noexcept {
      for (int k = 0; k < 8; ++k) {
        if ((k & Bit) != 0) continue;
        const int slope = in[k | Bit] - in[k];
        out[k] = in[k] * steps_ + slope * t;
        out[k | Bit] = out[k] + slope;
      }
    }

    const int steps_;
    double scale_;
    int from_[3];
    int node_[8];
  };

  /// The nodes of a coarse grid cell; outside the coarse directory all are the band's end.
  void corner(const Index3& cell, int out[8]) const noexcept {
    const Index3 brick(cell.x() >> 3, cell.y() >> 3, cell.z() >> 3);
    if (!coarse_.holds(brick)) {
      std::fill_n(out, 8, kFullBand);
      return;
    }
    const NodeValue* nodes =
        coarse_.nodesOf(coarse_.cellIndex(brick)) + nodeIndex(cell.x() & 7, cell.y() & 7, cell.z() & 7);
    for (int k = 0; k < 8; ++k) out[k] = nodes[nodeIndex(k >> 2, k >> 1 & 1, k & 1)];
  }

  const VoxLayout& coarse_;
  const int shift_;
};

/// Gives a batch that has been read the lanes that lie in the coarse part: their nodes, values and leasts.
/// Not a part of the kernels, whose bricks they are not in; the same bits on every processor.
void readElsewhere(const FieldView& field, int count, ReadBatch& batch) noexcept;

/// The same for ReadKernels::readAt().
void readElsewhereAt(const FieldView& field, const std::int32_t* const whole[3], const float* const t[3],
                     int count, float* value) noexcept;

/// Makes a layout with bricks in regions whole: names the other cells, gives bricks the coarse nodes where
/// they meet them, and bounds what the field can be off by. `layout.elsewhere` must be a brick already.
void joinCoarse(VoxLayout& layout, const VoxMap& coarse, double voxel_m, double quantum_m);

}  // namespace vps
