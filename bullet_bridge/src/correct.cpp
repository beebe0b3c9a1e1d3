// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "candidate.h"

namespace vps {

namespace {

// A face's point and a surface that looks away from it do not meet, however near they are: such as a table's
// top and the side of a box that stands on it. 0.2: about 78 degrees, so that a corner's mean normal still
// meets each face.
constexpr double kFacing = 0.2;
constexpr double kNever_m = 1;        // far beyond any step
constexpr double kTouching_m = 1e-6;  // below this, p - q is too short to be trusted as a direction

struct Exact {
  bool found = false;
  double distance_m = 0;
  Vec3 n = Vec3::Zero();
  bool is_facing = false;
};

// Distance and normal at a shell point p with normal `inward` into its own part, against a surface.
//
// A point on a face of its part must keep its own tangent plane clear of the other part, so its own normal is
// the contact's. Taking the other's would be the same between smooth surfaces, and wrong near its edges: the
// plane of a chamfer, met a hair below the chamfer's rim, would stop a peg that slides past. A point on an
// edge has no tangent plane; the other's face has.
Exact exactAt(const MeshDistance& surface, const Vec3& p, const Vec3& inward, bool is_edge_point,
              double max_m) {
  const MeshDistance::Closest closest = surface.closest(p, max_m);
  if (!closest.found) return {};
  const Vec3 from_q = p - closest.q;
  const bool is_facing = inward.dot(closest.normal) > kFacing;
  if (!is_edge_point && is_facing) return {true, from_q.dot(inward), inward, true};
  const double sign = from_q.dot(closest.normal) < 0 ? -1 : 1;
  const double distance_m = from_q.norm();
  const Vec3 n = distance_m > kTouching_m ? Vec3(sign / distance_m * from_q) : closest.normal;
  return {true, sign * distance_m, n, is_facing};
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
      const Exact exact = exactAt(*surface.distance, X_WP.inverse() * c.p_W, X_WP.R.transpose() * inward_W,
                                  side.shape->isEdgePoint(c.id), max_m);
      if (!exact.found || (nearest.found && exact.distance_m >= nearest.distance_m)) continue;
      nearest = {true, exact.distance_m, X_WP.R * exact.n, exact.is_facing};
    }
    if (!nearest.found) continue;
    c.distance_m = nearest.is_facing ? nearest.distance_m : kNever_m;
    c.n_W = sign * nearest.n;
  }
}

}  // namespace vps
