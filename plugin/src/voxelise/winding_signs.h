// SPDX-License-Identifier: BSD-3-Clause
// Signs of a voxmap's nodes by winding number, for meshes whose pseudonormals are not reliable.
#pragma once

#include <cstdint>
#include <vector>

#include "voxmap/voxmap_layout.h"
#include "vps/winding_number.h"

namespace vps::inline v0 {

/// A bound of the gradient of the winding number away from triangles. The gradient is the field of a current
/// along the mesh's border (Biot and Savart), so it is at most the sum of length / distance^2 over border
/// edges, over 4 pi; zero for a closed mesh. The border consists of the edges that do not have as many facets
/// in one direction as in the other.
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

/// Signs nodes: inside is where the winding number exceeds 0.5 and the distance to the surface's box is less
/// than a band. Everything else is outside, the directory's rim too. Between neighbouring nodes that are
/// farther from the surface than their step, the winding number changes at most by its slope, so that one
/// value serves many nodes: all nodes of a brick on one side of a closed surface. Near a border every node
/// needs its own.
class WindingSigner {
 public:
  /// @param solid faces out (see RepairedMesh), with shared vertices
  explicit WindingSigner(const Mesh& solid) : winding_(solid), slope_(solid) {}

  /// Overwrites the signs of all bricks' nodes and updates the layout's slope: near a hole signs change
  /// without a surface. Parallel over bricks; the result does not depend on the threads.
  void signBricks(VoxLayout& layout, double voxel_m, double quantum_m);
  /// Decides by the winding number at their centres whether empty cells are inside. Call after
  /// fillEmptyCells(), whose signs spread through holes that are wider than the band. Cells whose corners
  /// disagree, in the middle of such a hole, become bricks with a sign for each node. Does nothing for a
  /// closed mesh.
  void signEmptyCells(VoxLayout& layout, double voxel_m, double quantum_m);
  /// Share of the nodes signed so far, in the band, whose winding number is more than 0.25 from 0.5.
  [[nodiscard]] double certainShare() const noexcept;

 private:
  struct Count {
    std::size_t nodes = 0, certain = 0;
  };
  /// The cells, ascending, through which the middle of a hole passes; `is_uncertain` by cell.
  [[nodiscard]] std::vector<std::size_t> cutCells(const VoxLayout& layout, double voxel_m, double quantum_m,
                                                  const std::vector<std::uint8_t>& is_uncertain) const;
  /// Signs the nodes of these cells' bricks.
  void signCells(VoxLayout& layout, const std::vector<std::size_t>& cells, double voxel_m, double quantum_m);
  Count signBrick(NodeValue* nodes, const Index3& low, double voxel_m, double quantum_m) const;

  WindingNumber winding_;
  WindingSlope slope_;
  Count count_;
};

/// True if no two neighbours within a brick have different signs unless the surface can pass between them.
/// False means that pseudonormals were wrong, most likely because the mesh crosses itself.
bool signsAgree(const VoxLayout& layout, double voxel_m, double quantum_m);

}  // namespace vps::inline v0
