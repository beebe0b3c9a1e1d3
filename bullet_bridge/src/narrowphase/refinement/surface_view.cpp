// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/refinement/surface_view.h"

#include <algorithm>

#include "shape/sheet_border.h"
#include "vps/contact_tolerances.h"

namespace vps::bullet {

namespace {

SurfaceDistance make(const MeshDistance::Closest& closest, const Vec3& p, const Vec3& normal,
                     const Surface& surface) {
  const double sign = normal.dot(p - closest.q) < 0 ? -1 : 1;
  const Vec3 n =
      closest.distance_m > kRounding_m ? Vec3(sign / closest.distance_m * (p - closest.q)) : normal;
  return {sign * closest.distance_m, surface.X_MP.R * n};
}

}  // namespace

SurfaceView::SurfaceView(const SideView& side, const SideView& other)
    : side_(side),
      surfaces_(other.shape->models().surfaces),
      known_(surfaces_.size()),
      X_NM_(other.X_WM.inverse() * side.X_WM) {}

double SurfaceView::leastDistance(const Vec3& p_M, double max_m) {
  double least_m = max_m;
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const Vec3 p = surfaces_[i].X_MP.inverse() * (X_NM_ * p_M);
    least_m = std::min(least_m, surfaces_[i].sheet ? sheetBound(surfaces_[i], p, max_m)
                                                   : solidDistance(surfaces_[i], p, max_m, known_[i]));
  }
  return least_m;
}

SurfaceDistance SurfaceView::at(const Vec3& p_M, const Vec3& inward_M, double cutoff_m) const {
  SurfaceDistance nearest{kNever_m, Vec3::Zero()};
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const SurfaceDistance d = surfaces_[i].sheet ? atSheet(surfaces_[i], p_M, inward_M, cutoff_m)
                                                 : atSolid(surfaces_[i], p_M, cutoff_m, known_[i]);
    if (d.distance_m >= nearest.distance_m) continue;
    nearest = d;
    nearest.surface = static_cast<std::uint16_t>(i);
  }
  return nearest;
}

double SurfaceView::searchLimit_m(const Surface& surface, const Vec3& p, double max_m, const Known& known) {
  if (!known.is_set) return 1e300;
  const double way_m = (p - known.p).norm();
  const double limit_m = (p - known.q).norm() * (1 + kRoundingShare) + kRounding_m;
  if (surface.distance->isByWinding() || known.distance_m <= way_m * (1 + kRoundingShare) + kRounding_m)
    return limit_m;
  if (known.distance_m - way_m * (1 + kRoundingShare) - kRounding_m > max_m) return 0;
  return std::min(limit_m, std::max(max_m, 0.0) * (1 + kRoundingShare) + kRounding_m);
}

double SurfaceView::solidDistance(const Surface& surface, const Vec3& p, double max_m, Known& known) {
  const double limit_m = searchLimit_m(surface, p, max_m, known);
  if (limit_m == 0) return max_m;
  const Solid::Closest closest = surface.distance->closest(p, limit_m);
  if (!closest.found) return max_m;
  const double sign = closest.normal.dot(p - closest.q) < 0 ? -1 : 1;
  known = {p, closest.q, sign * closest.distance_m, true};
  return known.distance_m;
}

double SurfaceView::depthBehindSheets_m() const {
  const VoxMap* map = side_.shape->models().map.get();
  return map ? 2 * map->band_m() : 0.5 * side_.shape->models().shell->spacing_m;
}

double SurfaceView::sheetBound(const Surface& surface, const Vec3& p, double max_m) const {
  const double reach_m = max_m + depthBehindSheets_m();
  const MeshDistance::Closest closest = surface.distance->closest(p, reach_m);
  return closest.found ? closest.distance_m - depthBehindSheets_m() : max_m;
}

SurfaceDistance SurfaceView::atSolid(const Surface& surface, const Vec3& p_M, double cutoff_m,
                                     const Known& known) const {
  const SurfaceDistance never{kNever_m, Vec3::Zero()};
  const Vec3 p = surface.X_MP.inverse() * (X_NM_ * p_M);
  const double limit_m = searchLimit_m(surface, p, cutoff_m, known);
  if (limit_m == 0) return never;
  const Solid::Closest closest = surface.distance->closest(p, limit_m);
  return closest.found ? make(closest, p, closest.normal, surface) : never;
}

SurfaceDistance SurfaceView::atSheet(const Surface& surface, const Vec3& p_M, const Vec3& inward_M,
                                     double cutoff_m) const {
  const SurfaceDistance never{kNever_m, Vec3::Zero()};
  const Pose X_PM = surface.X_MP.inverse() * X_NM_;
  const Vec3 p = X_PM * p_M, inward = X_PM.R * inward_M;
  const MeshDistance::Closest closest =
      surface.distance->closest(p, std::max(cutoff_m, depthBehindSheets_m()));
  if (!closest.found) return never;
  const SheetFoot foot = surface.sheet->seenFrom(p, inward, closest);
  const Vec3 normal = foot.normal;
  // If the point's normal is nearly parallel to the sheet, rounding decides its side; such points do not
  // touch.
  if (inward.dot(normal) < kSinLean) return never;
  const SurfaceDistance d = make(closest, p, normal, surface);
  return d.distance_m < 0 && !hasEnteredBy(-d.distance_m, X_PM.inverse() * closest.q) ? never : d;
}

bool SurfaceView::hasEnteredBy(double depth_m, const Vec3& q_M) const {
  const VoxMap* map = side_.shape->models().map.get();
  return !map || 0.5 * map->voxel_m() - map->distance(q_M) >= 0.5 * depth_m;
}

}  // namespace vps::bullet
