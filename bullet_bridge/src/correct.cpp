// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "candidate.h"

namespace vps {

namespace {

// An edge turns by more than this (about 20 degrees) or it is a seam of a tessellated curve. Same as the
// shell's PointShellSettings::edge_angle_rad.
constexpr double kCosEdge = 0.94;
constexpr double kTouching_m = 1e-9;  // below this p - q has no direction

struct Exact {
  bool found = false;
  double distance_m = 0;
  Vec3 n = Vec3::Zero();
};

// Distance and normal of the surface at p, as a contact of a surface point with the inward normal `inward`.
Exact exactAt(const MeshDistance& surface, const Vec3& p, const Vec3& inward, double max_m) {
  const MeshDistance::Closest closest = surface.closest(p, max_m);
  if (!closest.found) return {};
  const Vec3 from_q = p - closest.q;
  // At a sharp edge the surface has no normal, but the face that rests on the edge has one, and it is that
  // face's plane that must stay clear of the edge. Its normal into the other part is our way out.
  const bool is_edge = surface.featureNormal(closest.triangle, 0).dot(closest.normal) < kCosEdge;
  if (is_edge && inward.dot(closest.normal) > 0.3) return {true, from_q.dot(inward), inward};
  const double sign = from_q.dot(closest.normal) < 0 ? -1 : 1;
  const double distance_m = from_q.norm();
  if (distance_m < kTouching_m) return {true, sign * distance_m, closest.normal};
  return {true, sign * distance_m, sign / distance_m * from_q};
}

}  // namespace

void correctBySurfaces(std::vector<Candidate>& candidates, const SideView& side, const SideView& other) {
  const VpsModels& theirs = other.shape->models();
  if (theirs.surfaces.empty()) return;
  const PointShell& shell = *side.shape->models().shell;
  const double sign = side.side == 0 ? 1 : -1;
  // The field is off by less than a voxel; beyond that it is not the same piece of surface.
  const double field_error_m = theirs.map ? theirs.map->voxel_m() : 0;
  for (Candidate& c : candidates) {
    if (c.side != side.side) continue;
    const Vec3 inward_W = side.X_WM.R * shell.inward[c.id];
    // A cooked body is the union of its parts: the least of their signed distances.
    Exact nearest;
    double max_m = std::abs(c.distance_m) + field_error_m;
    for (const VpsSurface& surface : theirs.surfaces) {
      const Pose X_WP = other.X_WM * surface.X_MP;
      const Exact exact =
          exactAt(*surface.distance, X_WP.inverse() * c.p_W, X_WP.R.transpose() * inward_W, max_m);
      if (!exact.found || (nearest.found && exact.distance_m >= nearest.distance_m)) continue;
      nearest = {true, exact.distance_m, X_WP.R * exact.n};
    }
    if (!nearest.found) continue;
    c.distance_m = nearest.distance_m;
    c.n_W = sign * nearest.n;
  }
}

}  // namespace vps
