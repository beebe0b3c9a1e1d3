// SPDX-License-Identifier: BSD-3-Clause
// Coarser versions of a mesh: for drafts (pictures of a view that moves), shadows, and parts that are small
// in a picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/shading_mesh.h"

namespace vps::viewer {

/// The coarser versions of one mesh. Its creases are found once, for the first that needs them.
class CoarseMesh {
 public:
  /// @param mesh  outlives it
  explicit CoarseMesh(const ShadingMesh& mesh) : mesh_(mesh) {}

  /// Indices of about `wanted` triangles between some of the mesh's own vertices, or of all where it has no
  /// more. The vertices of one colour within a cell of a cubic grid whose normals face the same side become
  /// one of them, and triangles that collapse are dropped; a surface stays within a cell's diagonal of where
  /// it was. O(triangles). Source: vertex clustering, Rossignac and Borrel 1993.
  std::vector<std::uint32_t> indices(std::size_t wanted);

  /// The same surface with fewer triangles where it is smooth: vertices of one colour within a cell whose
  /// normals differ by less than about a twelfth of a right angle become one. Those on creases and borders
  /// stay, so nothing opens. A surface stays within a quarter of a cell of where it was. O(triangles).
  /// @param cell  edge of a cell [m], > 0
  std::vector<std::uint32_t> smoothedIndices(double cell);

 private:
  const std::vector<bool>& creased();
  [[nodiscard]] std::vector<std::uint32_t> withStandIns(const std::vector<std::uint32_t>& stand_in) const;

  const ShadingMesh& mesh_;
  std::vector<bool> is_creased_;  ///< of each vertex; empty until it is needed
};

}  // namespace vps::viewer
