// SPDX-License-Identifier: BSD-3-Clause
// Finds shapes that are rigid copies of each other, as in a file that has each screw written out.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <TopoDS_Shape.hxx>

#include "vps/mesh.h"

namespace vps::scenes::import {

/// What a rigid copy of a shape has in common with it, in one order: kinds and counts of its faces and edges,
/// and points on them.
struct ShapeTrace {
  std::vector<int> kinds;
  std::vector<Vec3> points;
};

/// Faces, their orientation, surfaces and edges in the shape's order; for each edge five points, and for each
/// face a grid of its surface. O(faces + edges).
ShapeTrace traceOf(const TopoDS_Shape& shape);

/// The motion X with X a = b, if all points of b are then within `tolerance` of those of a; never a mirror
/// image. Two shapes with the same trace are taken for equal: surfaces that agree at their edges and at the
/// grid could still differ in between, as free-form faces that somebody changed between the grid's points.
std::optional<Eigen::Affine3d> motionBetween(const ShapeTrace& a, const ShapeTrace& b, double tolerance);

}  // namespace vps::scenes::import
