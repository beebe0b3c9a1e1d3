// SPDX-License-Identifier: BSD-3-Clause
// Signs of a voxmap's nodes by winding number, for meshes whose pseudonormals cannot be trusted.
#pragma once

#include <cstdint>
#include <vector>

#include "voxmap/voxmap_layout.h"
#include "vps/winding_number.h"

namespace vps {

/// How fast the winding number can change where no triangle is. Its gradient is the field of a current along
/// the mesh's border (Biot and Savart), so at most sum of length / distance^2 over border edges, over 4 pi;
/// zero for a closed mesh. The border: edges not run through as often forwards as backwards.
class WindingSlope {
 public:
  explicit WindingSlope(const Mesh& mesh);
  [[nodiscard]] bool isZero() const noexcept { return nodes_.empty(); }
  /// A bound [1/m] of the gradient's length anywhere in the box; infinite where the border enters it.
  [[nodiscard]] double bound(const Box& box) const noexcept;

 private:
  struct Node {
    Box box;
    double length_m = 0;
    std::uint32_t first = 0, count = 0;  ///< edges of a leaf; or count 0 and the left child
  };
  std::vector<Node> nodes_;
  std::vector<std::pair<Box, double>> edges_;  // box and length [m]
};

/// Signs nodes: inside is where the winding number exceeds 0.5, less than a band from the surface's box.
/// Beyond all is outside, so the directory's rim is. Between neighbouring nodes farther from the
/// surface than their step it changes by no more than its slope, so one value serves many nodes: all of a
/// brick's on one side of a closed surface. Near a border, every node has its own.
class WindingSigner {
 public:
  /// @param solid faces out (see RepairedMesh), with shared vertices
  explicit WindingSigner(const Mesh& solid) : winding_(solid), slope_(solid) {}

  /// Overwrites the signs of all bricks' nodes, and notes how steep the field is then: near a hole signs
  /// change without a surface. Parallel over bricks, each with an order of its own.
  void signBricks(VoxLayout& layout, double voxel_m, double quantum_m);
  /// Makes empty cells inside or outside by the winding number at their centres; after fillEmptyCells(),
  /// whose filling goes through holes that are wider than the band. Cells whose corners disagree, in the
  /// middle of such a hole, become bricks with a sign at each node. Nothing to do for a closed mesh.
  void signEmptyCells(VoxLayout& layout, double voxel_m, double quantum_m);
  /// Share of the nodes signed so far, in the band, whose winding number is more than 0.25 from 0.5.
  [[nodiscard]] double certainShare() const noexcept;

 private:
  struct Count {
    std::size_t nodes = 0, certain = 0;
  };
  /// The cells, ascending, that a hole's middle passes; `is_uncertain` by cell.
  [[nodiscard]] std::vector<std::size_t> cutCells(const VoxLayout& layout, double voxel_m, double quantum_m,
                                                  const std::vector<std::uint8_t>& is_uncertain) const;
  /// Signs the nodes of these cells' bricks.
  void signCells(VoxLayout& layout, const std::vector<std::size_t>& cells, double voxel_m, double quantum_m);
  Count signBrick(NodeValue* nodes, const Index3& low, double voxel_m, double quantum_m) const;

  WindingNumber winding_;
  WindingSlope slope_;
  Count count_;
};

/// Whether no two neighbours within a brick that the surface cannot pass between have different signs. False
/// tells that pseudonormals were misled: by a mesh that crosses itself, most likely.
bool signsAgree(const VoxLayout& layout, double voxel_m, double quantum_m);

}  // namespace vps
