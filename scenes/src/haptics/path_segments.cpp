// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/path_segments.h"

#include <algorithm>
#include <cstdio>

#include "vps/load_error.h"
#include "vps/mesh.h"

namespace vps::scenes {

namespace {

/// Left free on each side of a segment, at the device: what aim, sight and a search add to the way. assumed.
constexpr double kMargin_m = 20e-3;

Pose between(const Pose& X_from, const Pose& X_to, double share) {
  const Vec3 turn_rad = rotationVector(X_to.R * X_from.R.transpose());
  return {Mat3(rotationFromVector(share * turn_rad) * X_from.R),
          Vec3(X_from.p + share * (X_to.p - X_from.p))};
}

/// How far from a to b a box of this size can follow that holds `box` (with a) already: 1 as far as b.
double reachOf(const Box& box, const Vec3& size_m, const Vec3& a, const Vec3& b) {
  double share = 1;
  for (int i = 0; i < 3; ++i) {
    const double way_m = b[i] - a[i];
    if (way_m > 0) share = std::min(share, (box.min[i] + size_m[i] - a[i]) / way_m);
    if (way_m < 0) share = std::min(share, (box.max[i] - size_m[i] - a[i]) / way_m);
  }
  return std::clamp(share, 0.0, 1.0);
}

/// The way of the grasp frame G, which the handle goes along; at the device it is 1 / scale as long.
struct Way {
  std::vector<Pose> X_WG;
  std::vector<bool> is_index_point;
};

/// Backwards from the target, each segment as long as it gets.
Way inSegments(const std::vector<Pose>& X_WG, const Vec3& room_W) {
  Way way{{X_WG.back()}, {false}};  // backwards, until the end
  Box box;
  box.add(X_WG.back().p);
  for (std::size_t i = X_WG.size() - 1; i-- > 0;) {
    const Pose X_goal = X_WG[i];
    for (;;) {
      const Pose X_at = way.X_WG.back();
      const double share = reachOf(box, room_W, X_at.p, X_goal.p);
      if (share >= 1) break;
      if (share > 0) {
        way.X_WG.push_back(between(X_at, X_goal, share));
        way.is_index_point.push_back(true);
      } else {
        way.is_index_point.back() = true;  // the border is at a way point
      }
      box = Box{};
      box.add(way.X_WG.back().p);
    }
    way.X_WG.push_back(X_goal);
    way.is_index_point.push_back(false);
    box.add(X_goal.p);
  }
  std::reverse(way.X_WG.begin(), way.X_WG.end());
  std::reverse(way.is_index_point.begin(), way.is_index_point.end());
  return way;
}

[[noreturn]] void refuse(const Scene& scene, const SceneStep& step, const Vec3& needed_m,
                         const Vec3& room_m) {
  char words[240];
  std::snprintf(words, sizeof words,
                "its path is longer than the device's workspace of %.0f x %.0f x %.0f mm; start nearer, set "
                "[device] scale above %f, or let the hand take it anew on the way ([device] indexing = true)",
                1e3 * room_m.x(), 1e3 * room_m.y(), 1e3 * room_m.z(),
                scene.device.scale * (needed_m.array() / room_m.array()).maxCoeff());
  throw LoadError(scene.file, scene.parts[step.part].part.name, words);
}

/// Where the handle starts each segment, and what lies between.
PathSegments handled(const Way& way, const Pose& X_GP, double scale) {
  PathSegments segments;
  Box segment;
  Vec3 p_from = way.X_WG.front().p;
  const auto endSegment = [&](const Vec3& p_next) {
    segments.X_DH_start.push_back(Pose::translation((p_from - segment.center()) / scale));
    p_from = p_next;
    segment = Box{};
    segment.add(p_next);
  };
  for (std::size_t i = 0; i < way.X_WG.size(); ++i) {
    const Vec3& p = way.X_WG[i].p;
    segment.add(p);
    if (i > 0 && i + 1 < way.X_WG.size()) segments.way_points.push_back(way.X_WG[i] * X_GP);
    if (!way.is_index_point[i]) continue;
    segments.index_points.push_back(segments.way_points.size() - 1);
    endSegment(p);
  }
  endSegment(p_from);
  return segments;
}

}  // namespace

PathSegments splitPath(const Scene& scene, const SceneStep& step, const Vec3& room_m) {
  const double scale = scene.device.scale;
  const Pose X_PG = Pose::translation(massProperties(scene.parts[step.part].part.mesh).com);
  std::vector<Pose> X_WG = {step.X_WP_start * X_PG};
  for (const Pose& X_WP : step.way_points) X_WG.push_back(X_WP * X_PG);
  X_WG.push_back(step.X_WP_target * X_PG);

  Box all;
  for (const Pose& X : X_WG) all.add(X.p);
  const Vec3 needed_m = all.size() / scale;
  if ((needed_m.array() > room_m.array()).any()) {
    if (!scene.device.has_indexing) refuse(scene, step, needed_m, room_m);
    const Vec3 margin_m = (room_m / 10).cwiseMin(kMargin_m);
    return handled(inSegments(X_WG, scale * (room_m - 2 * margin_m)), X_PG.inverse(), scale);
  }
  PathSegments one = handled({X_WG, std::vector<bool>(X_WG.size(), false)}, X_PG.inverse(), scale);
  one.way_points = step.way_points;  // to the bit
  return one;
}

}  // namespace vps::scenes
