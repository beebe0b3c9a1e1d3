// SPDX-License-Identifier: BSD-3-Clause
// Coarser versions of a mesh, for drafts (pictures of a moving view), shadows, and parts that are small in a
// picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/shading_mesh.h"

namespace vps::viewer {

/// The coarser versions of one mesh. The creases of the mesh are found once, on first use.
class CoarseMesh {
 public:
  /// @param mesh  must outlive the CoarseMesh
  explicit CoarseMesh(const ShadingMesh& mesh) : mesh_(mesh) {}

  /// Indices of about `wanted` triangles between some of the mesh's own vertices; all triangles if the mesh
  /// has no more. Vertices of one colour in one cell of a cubic grid whose normals face the same side are
  /// replaced by one of them, and triangles that collapse are dropped. The surface moves by at most a cell's
  /// diagonal. O(triangles). Source: vertex clustering, Rossignac and Borrel 1993.
  std::vector<std::uint32_t> indices(std::size_t wanted);

  /// The same surface with fewer triangles in smooth regions: vertices of one colour in one cell whose
  /// normals differ by less than about a twelfth of a right angle are replaced by one of them. Vertices on
  /// creases and borders stay, so no gap opens. The surface moves by at most a quarter of a cell.
  /// O(triangles).
  /// @param cell  edge of a cell [m], > 0
  std::vector<std::uint32_t> smoothedIndices(double cell);

 private:
  const std::vector<bool>& creased();
  [[nodiscard]] std::vector<std::uint32_t> withStandIns(const std::vector<std::uint32_t>& stand_in) const;

  const ShadingMesh& mesh_;
  std::vector<bool> is_creased_;  ///< by vertex; empty until first use
};

}  // namespace vps::viewer
