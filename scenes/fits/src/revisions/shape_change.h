// SPDX-License-Identifier: BSD-3-Clause
// Whether two drawings of a part have the same shape, by which motion they differ, and how far their surfaces
// are apart.
#pragma once

#include "vps/mesh.h"
#include "vps_scenes/fits/revisions.h"

namespace vps::scenes {

/// A part of a revision, with what the comparison needs of it.
struct RevisedPart {
  const DrawnPart* drawn = nullptr;
  double error_m = 0;  ///< distance of the mesh from the part's faces, and rounding of its file
  Box box_W;
  ShapeMeasures shape;
};

RevisedPart revisedPart(const DrawnPart& part, double chord_m);

/// Coordinates of one point in two files that keep 32-bit floats differ by no more, unless the file says so
/// (ImportedPart::rounding_m): each is rounded by less than 0.05 um.
inline constexpr double kRounding_m = 0.1e-6;

/// The limit up to which two places of a part's points are equal.
inline double rounding_m(const RevisedPart& a, const RevisedPart& b) {
  return kRounding_m + a.drawn->rounding_m + b.drawn->rounding_m;
}

/// A quick test, whatever the poses: volume and area agree to within the errors of the meshes. Parts of equal
/// shape pass it; a part that passes may still have another shape.
bool isAlike(const RevisedPart& a, const RevisedPart& b);

/// The motion from the old to the new place, and the difference of the shapes.
struct ShapeChange {
  Pose motion_W;  ///< takes points of the old part to their places in the new revision
  bool is_reshaped = false;
  double deviation_m = 0, deviation_error_m = 0;  ///< see PartChange
};

/// O(n) for meshes whose facets correspond; otherwise a search of bounded length.
ShapeChange shapeChange(const RevisedPart& before, const RevisedPart& after);

}  // namespace vps::scenes
