// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/path_segments.h"

#include <algorithm>
#include <cstdio>

#include "vps/load_error.h"
#include "vps/mesh.h"

namespace vps::scenes::inline v0 {

namespace {

/// Left free on each side of a segment, at the device, for aim errors and the search for a hole. assumed.
constexpr double kMargin_m = 20e-3;

Pose between(const Pose& X_from, const Pose& X_to, double share) {
  const Vec3 turn_rad = rotationVector(X_to.R * X_from.R.transpose());
  return {Mat3(rotationFromVector(share * turn_rad) * X_from.R),
          Vec3(X_from.p + share * (X_to.p - X_from.p))};
}

/// The share of the line from a to b that fits into a box of this size together with `box`, which contains a.
double reachOf(const Box& box, const Vec3& size_m, const Vec3& a, const Vec3& b) {
  double share = 1;
  for (int i = 0; i < 3; ++i) {
    const double d_m = b[i] - a[i];
    if (d_m > 0) share = std::min(share, (box.min[i] + size_m[i] - a[i]) / d_m);
    if (d_m < 0) share = std::min(share, (box.max[i] - size_m[i] - a[i]) / d_m);
  }
  return std::clamp(share, 0.0, 1.0);
}

/// The path of the grasp frame G, which the handle follows; at the device it is shorter by the scale.
struct GraspPath {
  std::vector<Pose> X_WG;
  std::vector<bool> is_index_point;
};

/// Splits from the target backwards, each segment as long as possible.
GraspPath inSegments(const std::vector<Pose>& X_WG, const Vec3& workspace_W) {
  GraspPath path{{X_WG.back()}, {false}};  // in reverse order until the end
  Box box;
  box.add(X_WG.back().p);
  for (std::size_t i = X_WG.size() - 1; i-- > 0;) {
    const Pose X_goal = X_WG[i];
    for (;;) {
      const Pose X_at = path.X_WG.back();
      const double share = reachOf(box, workspace_W, X_at.p, X_goal.p);
      if (share >= 1) break;
      if (share > 0) {
        path.X_WG.push_back(between(X_at, X_goal, share));
        path.is_index_point.push_back(true);
      } else {
        path.is_index_point.back() = true;  // the workspace ends at a way point
      }
      box = Box{};
      box.add(path.X_WG.back().p);
    }
    path.X_WG.push_back(X_goal);
    path.is_index_point.push_back(false);
    box.add(X_goal.p);
  }
  std::reverse(path.X_WG.begin(), path.X_WG.end());
  std::reverse(path.is_index_point.begin(), path.is_index_point.end());
  return path;
}

[[noreturn]] void refuse(const Scene& scene, const SceneStep& step, const Vec3& needed_m,
                         const Vec3& workspace_m) {
  char words[240];
  std::snprintf(words, sizeof words,
                "its path is longer than the device's workspace of %.0f x %.0f x %.0f mm; start nearer, set "
                "[device] scale above %f, or let the hand re-grasp it on the way ([device] indexing = true)",
                1e3 * workspace_m.x(), 1e3 * workspace_m.y(), 1e3 * workspace_m.z(),
                scene.device.scale * (needed_m.array() / workspace_m.array()).maxCoeff());
  throw LoadError(scene.file, scene.parts[step.part].part.name, words);
}

/// Adds the handle's pose at the start of each segment.
PathSegments withHandle(const GraspPath& path, const Pose& X_GP, double scale) {
  PathSegments segments;
  Box segment;
  Vec3 p_from = path.X_WG.front().p;
  const auto endSegment = [&](const Vec3& p_next) {
    segments.X_DH_start.push_back(Pose::translation((p_from - segment.center()) / scale));
    p_from = p_next;
    segment = Box{};
    segment.add(p_next);
  };
  for (std::size_t i = 0; i < path.X_WG.size(); ++i) {
    const Vec3& p = path.X_WG[i].p;
    segment.add(p);
    if (i > 0 && i + 1 < path.X_WG.size()) segments.way_points.push_back(path.X_WG[i] * X_GP);
    if (!path.is_index_point[i]) continue;
    segments.index_points.push_back(segments.way_points.size() - 1);
    endSegment(p);
  }
  endSegment(p_from);
  return segments;
}

}  // namespace

PathSegments splitPath(const Scene& scene, const SceneStep& step, const Vec3& workspace_m) {
  const double scale = scene.device.scale;
  const Pose X_PG = Pose::translation(massProperties(scene.parts[step.part].part.mesh).com);
  std::vector<Pose> X_WG = {step.X_WP_start * X_PG};
  for (const Pose& X_WP : step.way_points) X_WG.push_back(X_WP * X_PG);
  X_WG.push_back(step.X_WP_target * X_PG);

  Box all;
  for (const Pose& X : X_WG) all.add(X.p);
  const Vec3 needed_m = all.size() / scale;
  if ((needed_m.array() > workspace_m.array()).any()) {
    if (!scene.device.has_indexing) refuse(scene, step, needed_m, workspace_m);
    const Vec3 margin_m = (workspace_m / 10).cwiseMin(kMargin_m);
    return withHandle(inSegments(X_WG, scale * (workspace_m - 2 * margin_m)), X_PG.inverse(), scale);
  }
  PathSegments one = withHandle({X_WG, std::vector<bool>(X_WG.size(), false)}, X_PG.inverse(), scale);
  one.way_points = step.way_points;  // the same bits
  return one;
}

}  // namespace vps::scenes::inline v0
