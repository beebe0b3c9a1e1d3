// SPDX-License-Identifier: BSD-3-Clause
// Triangulates Open CASCADE shapes and compares the triangles with the exact faces.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

#include "vps/mesh.h"
#include "vps_scenes/cad/import.h"

namespace vps::scenes::import {

/// Triangles of a shape, in its length unit (a metre has units_per_m of them), outward for a solid. Faces of
/// one shape share the points of their common edges, so welding closes it.
struct Tessellation {
  /// A face, and how many triangles it has; they follow each other in the mesh.
  struct Face {
    TopoDS_Face face;
    std::size_t triangles = 0;
    bool is_good = true;  ///< has triangles, which lie on it, cover it, and are within its box
  };

  Mesh mesh;
  std::vector<Face> faces;
  /// Greatest distance of a triangle's centre from its exact face, or, where the volume is wrong, its error
  /// over the area, or, where the area of a face is wrong, the root of its error [m].
  double deviation_m = 0;
  double deflection_m = 0;     ///< that it was made with: as asked for, or more, see ImportSettings
  int missing = 0;             ///< faces without triangles
  int off = 0;                 ///< faces with triangles that are farther off than asked for
  int folded = 0;              ///< triangles that are turned over within their face
  int uncovered = 0;           ///< faces whose triangles have another area, as where one spans a hole
  int outside = 0;             ///< faces with triangles outside of the face's bounding box
  std::size_t open_edges = 0;  ///< of the mesh of a shape that is closed

  /// Faces that are not as they should be, and one for a mesh that is open.
  [[nodiscard]] int faults() const { return missing + uncovered + outside + (open_edges > 0 ? 1 : 0); }
  [[nodiscard]] bool isTrusted() const;
};

/// The triangles that the shape has, compared with its faces: their distance at the triangles' centres, their
/// area and bounding box; for a closed shape, be it a solid or loose faces that were sewn together, that the
/// mesh is closed and its volume.
Tessellation compared(const TopoDS_Shape& shape, const ImportSettings& settings, double units_per_m);

/// Open CASCADE can triangulate a face in quite another place without an error: of 17 solids of one public
/// motor 6 had triangles up to 24 mm off a cylinder, and all were closed. So triangles are compared with
/// faces, and where they are not as asked for the shape is triangulated with points inside its faces, then
/// finer, then with the faces healed that are not as asked for, and then all of it; the best is returned.
/// Cost besides the triangulation: a surface's point for each triangle, and the volume of a solid.
Tessellation tessellate(const TopoDS_Shape& shape, ImportSettings settings, double units_per_m);

/// A warning about a part that is not as asked for; empty if it is.
std::string inWords(const Tessellation& tessellation, const ImportSettings& settings);

}  // namespace vps::scenes::import
