// SPDX-License-Identifier: BSD-3-Clause
// Signs of a voxmap's nodes by winding number, for meshes whose pseudonormals are not reliable.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/solid/interior.h"
#include "voxmap/voxmap_layout.h"

namespace vps {

/// Signs nodes as an Interior does. Between neighbouring nodes that are farther from the surface than the
/// distance between them, the winding number changes at most by its slope. One value therefore serves many
/// nodes: in a brick all nodes on one side of a closed surface. Near a border every node needs a value of its
/// own.
class WindingSigner {
 public:
  explicit WindingSigner(const Interior& interior) : interior_(interior) {}

  /// Overwrites the signs of all bricks' nodes and updates the layout's slope: near a hole signs change
  /// without a surface. Parallel over bricks; the result does not depend on the threads.
  void signBricks(VoxLayout& layout, double voxel_m, double quantum_m);
  /// Decides by the winding number at their centres whether empty cells are inside. Call after
  /// fillEmptyCells(), whose signs spread through holes wider than the band. In the middle of such a hole the
  /// corners of a cell disagree; these cells become bricks with a sign for each node. Does nothing for a
  /// closed mesh.
  void signEmptyCells(VoxLayout& layout, double voxel_m, double quantum_m);
  /// Fraction of the band's nodes, of those signed so far, whose winding number is more than 0.25 from 0.5.
  [[nodiscard]] double certainShare() const noexcept;

 private:
  struct Count {
    std::size_t nodes = 0, certain = 0;
  };
  /// The cells, in ascending order, through which the middle of a hole passes; `is_uncertain` is by cell.
  [[nodiscard]] std::vector<std::size_t> cutCells(const VoxLayout& layout, double voxel_m,
                                                  const std::vector<std::uint8_t>& is_uncertain) const;
  /// Signs the nodes of these cells' bricks.
  void signCells(VoxLayout& layout, const std::vector<std::size_t>& cells, double voxel_m, double quantum_m);
  Count signBrick(NodeValue* nodes, const Index3& low, double voxel_m, double quantum_m) const;

  const Interior& interior_;
  Count count_;
};

/// False if two neighbours within a brick have different signs although the surface cannot pass between them.
/// In this case pseudonormals are wrong, most likely because the mesh crosses itself.
bool signsAgree(const VoxLayout& layout, double voxel_m, double quantum_m);

}  // namespace vps
