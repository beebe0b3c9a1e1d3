// SPDX-License-Identifier: BSD-3-Clause
// Divides the shapes of a file into rigid pieces and triangulates them: rigid copies once, the others on all
// cores.
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Geometry>
#include <TopoDS_Shape.hxx>

#include "occt/tessellation.h"
#include "vps/errors.h"

namespace vps::scenes::import {

/// The rigid pieces of a shape: each solid, and the faces outside of solids, sewn together where they meet.
/// @param tell  called with the share done while faces are sewn; may throw
/// @param remember  called with each face that sewing made, and the face of `shape` of which it was made
std::vector<TopoDS_Shape> pieces(
    const TopoDS_Shape& shape, const std::function<void(double)>& tell = {},
    const std::function<void(const TopoDS_Shape& sewn, const TopoDS_Shape& face)>& remember = {});

struct TessellatedShape {
  std::size_t number = 0;                              ///< index of its tessellation
  Eigen::Affine3d X_ST = Eigen::Affine3d::Identity();  ///< from the tessellation's frame to the shape's
};

struct TessellatedShapes {
  std::vector<TessellatedShape> shapes;  ///< in the order of the given shapes
  /// One for each set of rigid copies. Tessellation::faces has no handles if it was made in another process.
  std::vector<Tessellation> tessellations;
};

/// Calls tessellate() for each shape. A shape that is a rigid copy of an earlier one within a nanometre gets
/// the earlier shape's triangles, so that later code finds equal parts equal.
/// @param progress  called as "meshing", with the share done by edges, as faces and shapes are finished
TessellatedShapes tessellateAll(const std::vector<TopoDS_Shape>& shapes, const ImportSettings& settings,
                                double units_per_m, const Progress& progress);

}  // namespace vps::scenes::import
