// SPDX-License-Identifier: BSD-3-Clause
// Signs of a voxmap's nodes by winding number, for meshes whose pseudonormals are not reliable.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/interior.h"
#include "voxmap/voxmap_layout.h"

namespace vps {

/// Signs nodes as an Interior does. Between neighbouring nodes that are farther from the surface than their
/// step, the winding number changes at most by its slope, so that one value serves many nodes: all nodes of a
/// brick on one side of a closed surface. Near a border every node needs its own.
class WindingSigner {
 public:
  explicit WindingSigner(const Interior& interior) : interior_(interior) {}

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
  [[nodiscard]] std::vector<std::size_t> cutCells(const VoxLayout& layout, double voxel_m,
                                                  const std::vector<std::uint8_t>& is_uncertain) const;
  /// Signs the nodes of these cells' bricks.
  void signCells(VoxLayout& layout, const std::vector<std::size_t>& cells, double voxel_m, double quantum_m);
  Count signBrick(NodeValue* nodes, const Index3& low, double voxel_m, double quantum_m) const;

  const Interior& interior_;
  Count count_;
};

/// True if no two neighbours within a brick have different signs unless the surface can pass between them.
/// False means that pseudonormals were wrong, most likely because the mesh crosses itself.
bool signsAgree(const VoxLayout& layout, double voxel_m, double quantum_m);

}  // namespace vps
