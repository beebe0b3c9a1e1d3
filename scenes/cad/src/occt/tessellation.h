// SPDX-License-Identifier: BSD-3-Clause
// Triangulates Open CASCADE shapes and compares the triangles with the exact faces.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

#include "vps/mesh.h"
#include "vps_scenes/cad/import.h"

namespace vps::scenes::import {

/// Triangles of a shape, in its length unit (a metre has units_per_m of them), outward for a solid. Faces of
/// one shape share the points of their common edges, so welding closes the mesh.
struct Tessellation {
  /// A face, and the number of its triangles, which are consecutive in the mesh.
  struct Face {
    TopoDS_Face face;
    std::size_t triangles = 0;
    bool is_good = true;  ///< the face has triangles, which lie on it, cover it, and are within its box
  };

  Mesh mesh;
  std::vector<Face> faces;
  /// Greatest of these lengths [m]: distance of a triangle's centre from its exact face; error of the volume
  /// divided by the surface's area, if the volume is wrong; square root of the error of a face's area, if the
  /// area is wrong.
  double deviation_m = 0;
  double deflection_m = 0;     ///< deflection in use: the requested one, or more, see ImportSettings
  int missing = 0;             ///< faces without triangles
  int off = 0;                 ///< faces with triangles that deviate more than accepted
  int folded = 0;              ///< triangles that are inverted within their face
  int uncovered = 0;           ///< faces whose triangles differ in area, for example by spanning a hole
  int outside = 0;             ///< faces with triangles outside of the face's bounding box
  std::size_t open_edges = 0;  ///< open edges in the mesh of a closed shape

  /// Number of faulty faces, plus one for an open mesh.
  [[nodiscard]] int faults() const { return missing + uncovered + outside + (open_edges > 0 ? 1 : 0); }
  [[nodiscard]] bool isTrusted() const;
};

/// Takes the triangles that the shape has and compares them with its faces: distance at the triangles'
/// centres, area, bounding box. For a closed shape (a solid, or loose faces that were sewn together) also
/// checks that the mesh is closed, and its volume.
/// @param tell  called with the share of the faces that are compared; may throw
Tessellation compared(const TopoDS_Shape& shape, const ImportSettings& settings, double units_per_m,
                      const std::function<void(double)>& tell = {});

/// Triangulates a shape and compares the triangles with its faces, since Open CASCADE can place a face's
/// triangles elsewhere without an error: of 17 solids of one public motor 6 had triangles up to 24 mm off a
/// cylinder, and all were closed. While the result is not trusted, tries points inside faces, then finer
/// triangles, then healed faulty faces, then a healed shape, and returns the best result. Cost in addition to
/// the triangulation: a point of the surface for each triangle, and the volume of a solid.
/// @param tell  called from face to face with the share done, which never falls; may throw to end the work.
/// The number
///              of tries is not known, so that each try takes half of the share that is left.
Tessellation tessellate(const TopoDS_Shape& shape, ImportSettings settings, double units_per_m,
                        const std::function<void(double)>& tell = {});

/// A warning about a part that is coarser or less accurate than requested; empty for any other part.
std::string inWords(const Tessellation& tessellation, const ImportSettings& settings);

}  // namespace vps::scenes::import
