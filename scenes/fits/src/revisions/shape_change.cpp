// SPDX-License-Identifier: BSD-3-Clause
#include "revisions/shape_change.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/equal_meshes.h"
#include "revisions/surface_deviation.h"
#include "vps/mesh_distance.h"

namespace vps::scenes {

namespace {

Eigen::Matrix3Xd cornersInWorld(const DrawnPart& part) {
  Eigen::Matrix3Xd out(3, static_cast<Eigen::Index>(part.mesh.vertices.size()));
  for (std::size_t i = 0; i < part.mesh.vertices.size(); ++i)
    out.col(static_cast<Eigen::Index>(i)) = part.X_WP * part.mesh.vertices[i];
  return out;
}

/// The motion between two meshes whose facets correspond, and the greatest distance of a corner from its
/// place. Empty if the facets do not correspond.
struct CornerFit {
  Pose motion_W;
  double most_m = 0;
};
std::optional<CornerFit> cornerFit(const DrawnPart& before, const DrawnPart& after) {
  if (before.mesh.vertices.size() != after.mesh.vertices.size() ||
      before.mesh.triangles != after.mesh.triangles)
    return std::nullopt;
  const Eigen::Matrix3Xd from = cornersInWorld(before), to = cornersInWorld(after);
  const bool has_scale = false;
  const Eigen::Matrix4d fit = Eigen::umeyama(from, to, has_scale);
  CornerFit out{Pose(Mat3(fit.topLeftCorner<3, 3>()), Vec3(fit.topRightCorner<3, 1>())), 0};
  for (Eigen::Index i = 0; i < from.cols(); ++i)
    out.most_m = std::max(out.most_m, (out.motion_W * Vec3(from.col(i)) - Vec3(to.col(i))).norm());
  return out;
}

/// The distance of both surfaces from each other, after the old part's motion.
struct Facing {
  const RevisedPart &before, &after;
  MeshDistance to_before, to_after;  ///< in the frames of the parts

  Facing(const RevisedPart& b, const RevisedPart& a)
      : before(b), after(a), to_before(b.drawn->mesh), to_after(a.drawn->mesh) {}

  /// Pose of the old part in the frame of the new part after the motion.
  [[nodiscard]] Pose placed(const Pose& motion_W) const {
    return after.drawn->X_WP.inverse() * (motion_W * before.drawn->X_WP);
  }
  [[nodiscard]] double mean_m(const Pose& motion_W) const {
    const Pose X = placed(motion_W);
    return meanDistance(before.drawn->mesh, X, to_after) +
           meanDistance(after.drawn->mesh, X.inverse(), to_before);
  }
  [[nodiscard]] DeviationBounds greatest(const Pose& motion_W) const {
    const Pose X = placed(motion_W);
    const DeviationBounds of_before = deviation(before.drawn->mesh, X, to_after),
                          of_after = deviation(after.drawn->mesh, X.inverse(), to_before);
    return {std::max(of_before.low_m, of_after.low_m), std::max(of_before.high_m, of_after.high_m)};
  }
};

}  // namespace

RevisedPart revisedPart(const DrawnPart& part, double chord_m) {
  RevisedPart out;
  out.drawn = &part;
  out.error_m = chord_m + part.rounding_m;
  for (const Vec3& p : part.mesh.vertices) out.box_W.add(part.X_WP * p);
  out.shape = {std::abs(massProperties(part.mesh).volume_m3), area(part.mesh), bounds(part.mesh).size()};
  return out;
}

bool isAlike(const RevisedPart& a, const RevisedPart& b) {
  if (&a.drawn->mesh == &b.drawn->mesh || isEqualGeometry(a.drawn->mesh, b.drawn->mesh)) return true;
  constexpr double kShare = 1e-6;  // rounding of 32-bit floats, summed over the surface
  const double error_m = a.error_m + b.error_m + rounding_m(a, b),
               area_m2 = a.shape.area_m2 + b.shape.area_m2;
  const double least_m = std::min(a.shape.size_m.maxCoeff(), b.shape.size_m.maxCoeff());
  // An offset of the surface by the error changes the area by the error over the radii of curvature.
  return std::abs(a.shape.volume_m3 - b.shape.volume_m3) <= area_m2 * error_m &&
         std::abs(a.shape.area_m2 - b.shape.area_m2) <= area_m2 * (kShare + 20 * error_m / least_m);
}

ShapeChange shapeChange(const RevisedPart& before, const RevisedPart& after) {
  const DrawnPart &old_part = *before.drawn, &new_part = *after.drawn;
  ShapeChange out;
  const Pose of_frame_W = new_part.X_WP * old_part.X_WP.inverse();
  if (isEqualGeometry(old_part.mesh, new_part.mesh)) {
    out.motion_W = of_frame_W;
    return out;
  }
  // Corresponding facets show a motion also where the file has no frame of the part (STL).
  const std::optional<CornerFit> fit = cornerFit(old_part, new_part);
  if (fit && fit->most_m <= rounding_m(before, after)) {
    out.motion_W = fit->motion_W;
    return out;
  }
  // Best fits are no guide here: a hole that is moved would take the whole part with it.
  const Facing facing(before, after);
  if (facing.mean_m(of_frame_W) < facing.mean_m(Pose())) out.motion_W = of_frame_W;
  const DeviationBounds found = facing.greatest(out.motion_W);
  const double error_m = before.error_m + after.error_m + rounding_m(before, after);
  out.is_reshaped = found.low_m > error_m;
  if (!out.is_reshaped) return out;
  out.deviation_m = found.low_m;
  out.deviation_error_m = found.high_m - found.low_m;
  return out;
}

}  // namespace vps::scenes
