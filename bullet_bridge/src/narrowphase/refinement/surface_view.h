// SPDX-License-Identifier: BSD-3-Clause
// Distances of one body's points from the exact surfaces of another body.
#pragma once

#include <vector>

#include "narrowphase/candidates/contact_candidate.h"
#include "native_shapes/native_shape.h"

namespace vps::bullet {

/// Distances of points of `side` (in its models' frame M) from the surfaces of `other` (in its frame N). Both
/// sides must outlive the view.
class SurfaceView {
 public:
  SurfaceView(const SideView& side, const SideView& other);

  /// Lower bound of the distance of p; max_m if p is farther, or deep behind a sheet.
  [[nodiscard]] double leastDistance(const Vec3& p_M, double max_m);

  /// Distance and normal in N of the nearest surface; kNever_m beyond cutoff_m.
  [[nodiscard]] SurfaceDistance at(const Vec3& p_M, const Vec3& inward_M, double cutoff_m) const;

  static constexpr double kNever_m = 1e30;

 private:
  /// Last distance from a solid that was computed for a node of the shell, between its centre p and the
  /// surface point q.
  struct Known {
    Vec3 p = Vec3::Zero(), q = Vec3::Zero();
    double distance_m = 0;
    bool is_set = false;
  };

  // Upper bound of the distance of p, from the known surface point q; for a p that must lie outside also
  // bounded by max_m. Without a bound, a search is slow where much of the surface is about equally far.
  // Inside a solid every depth counts, so the sign is needed at any distance. Returns 0 if p is outside and
  // beyond max_m. If the sign is found by winding number, it may change at holes, away from the surface.
  static double searchLimit_m(const Surface& surface, const Vec3& p, double max_m, const Known& known);

  // Signed distance of p; max_m if p is farther.
  static double solidDistance(const Surface& surface, const Vec3& p, double max_m, Known& known);

  // Greatest depth behind a sheet at which a point counts: the range of the field of the point's part.
  [[nodiscard]] double depthBehindSheets_m() const;

  [[nodiscard]] double sheetBound(const Surface& surface, const Vec3& p, double max_m) const;
  [[nodiscard]] SurfaceDistance atSolid(const Surface& surface, const Vec3& p_M, double cutoff_m,
                                        const Known& known) const;
  [[nodiscard]] SurfaceDistance atSheet(const Surface& surface, const Vec3& p_M, const Vec3& inward_M,
                                        double cutoff_m) const;

  // True if the sheet has entered the part by this depth through the point's own face. If the point belongs
  // to the far face of a wall, the sheet is nearer to the wall's other face, as the part's own field tells
  // (error at its edges: half a voxel).
  [[nodiscard]] bool hasEnteredBy(double depth_m, const Vec3& q_M) const;

  const SideView& side_;
  const std::vector<Surface>& surfaces_;
  std::vector<Known> known_;  // by surface
  Pose X_NM_;
};

}  // namespace vps::bullet
