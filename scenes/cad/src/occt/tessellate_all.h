// SPDX-License-Identifier: BSD-3-Clause
// Triangulates the shapes of a file: rigid copies once, the others on all cores.
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Geometry>
#include <TopoDS_Shape.hxx>

#include "occt/tessellation.h"

namespace vps::scenes::import {

struct TessellatedShape {
  std::size_t number = 0;                              ///< of its tessellation
  Eigen::Affine3d X_ST = Eigen::Affine3d::Identity();  ///< from the tessellation's frame to the shape's
};

struct TessellatedShapes {
  std::vector<TessellatedShape> shapes;  ///< as they were given
  /// Of the different ones. Where they were made in another process, `faces` has no handles of faces.
  std::vector<Tessellation> tessellations;
};

/// What tessellate() gives for each shape. A shape that is a rigid copy of an earlier one within a nanometre
/// has that one's triangles, so that equal parts are equal to all that comes after.
/// @param done  called with how many of the different shapes are triangulated, and how many there are
TessellatedShapes tessellateAll(const std::vector<TopoDS_Shape>& shapes, const ImportSettings& settings,
                                double units_per_m,
                                const std::function<void(std::size_t, std::size_t)>& done);

}  // namespace vps::scenes::import
