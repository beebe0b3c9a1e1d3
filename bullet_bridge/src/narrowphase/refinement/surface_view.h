// SPDX-License-Identifier: BSD-3-Clause
// Distances of one body's points from the exact surfaces of another.
#pragma once

#include <vector>

#include "narrowphase/candidates/contact_candidate.h"
#include "native_shapes/native_shape.h"

namespace vps::bullet {

/// Distances of points of `side` (in its models' frame M) from the surfaces of `other` (in its frame N). Both
/// must outlive it.
class SurfaceView {
 public:
  SurfaceView(const SideView& side, const SideView& other);

  /// Lower bound of the distance of p; max_m if p is farther, or deep behind a sheet.
  [[nodiscard]] double leastDistance(const Vec3& p_M, double max_m);

  /// Distance and normal in N of the nearest surface; kNever_m beyond cutoff_m.
  [[nodiscard]] SurfaceDistance at(const Vec3& p_M, const Vec3& inward_M, double cutoff_m) const;

  static constexpr double kNever_m = 1e30;

 private:
  /// The last distance from a solid that was computed for a node of the shell: of p, at q.
  struct Known {
    Vec3 p = Vec3::Zero(), q = Vec3::Zero();
    double distance_m = 0;
    bool is_set = false;
  };

  // How far the nearest surface can be from p, since q is a point of it; where p must lie outside, no farther
  // than matters. Inside a solid every depth counts, so the sign is needed at any distance. A search
  // without a limit would be long where much of the surface is about equally far. 0: p is outside and beyond
  // max_m. With a winding number the sign may change off the surface, at holes.
  static double searchLimit_m(const Surface& surface, const Vec3& p, double max_m, const Known& known);

  // max_m if p is farther.
  static double solidDistance(const Surface& surface, const Vec3& p, double max_m, Known& known);

  // Greatest depth behind a sheet at which a point counts: as far as its part's field can measure.
  [[nodiscard]] double depthBehindSheets_m() const;

  [[nodiscard]] double sheetBound(const Surface& surface, const Vec3& p, double max_m) const;
  [[nodiscard]] SurfaceDistance atSolid(const Surface& surface, const Vec3& p_M, double cutoff_m,
                                        const Known& known) const;
  [[nodiscard]] SurfaceDistance atSheet(const Surface& surface, const Vec3& p_M, const Vec3& inward_M,
                                        double cutoff_m) const;

  // A face that looks at a sheet from a wall's thickness above has not passed through it from below: the
  // sheet is then nearer to the wall's other face. The part's own field tells, with an error of half a voxel
  // at its edges.
  [[nodiscard]] bool hasEnteredBy(double depth_m, const Vec3& q_M) const;

  const SideView& side_;
  const std::vector<Surface>& surfaces_;
  std::vector<Known> known_;  // by surface
  Pose X_NM_;
};

}  // namespace vps::bullet
