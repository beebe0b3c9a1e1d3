// SPDX-License-Identifier: BSD-3-Clause
#include "haptics/path_segments.h"

#include <algorithm>
#include <cstdio>

#include "vps/load_error.h"
#include "vps/mesh.h"

namespace vps {

namespace {

/// Left free on each side of a stroke, at the device: what aim, sight and a search add to the way. assumed.
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
  std::vector<bool> is_regrasp;
};

/// Backwards from the target, each stroke as long as it gets.
Way inStrokes(const std::vector<Pose>& X_WG, const Vec3& room_W) {
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
        way.is_regrasp.push_back(true);
      } else {
        way.is_regrasp.back() = true;  // the border is at a way point
      }
      box = Box{};
      box.add(way.X_WG.back().p);
    }
    way.X_WG.push_back(X_goal);
    way.is_regrasp.push_back(false);
    box.add(X_goal.p);
  }
  std::reverse(way.X_WG.begin(), way.X_WG.end());
  std::reverse(way.is_regrasp.begin(), way.is_regrasp.end());
  return way;
}

[[noreturn]] void refuse(const Scene& scene, const SceneStep& step, const Vec3& needed_m,
                         const Vec3& room_m) {
  char words[240];
  std::snprintf(words, sizeof words,
                "its path is longer than the device's workspace of %.0f x %.0f x %.0f mm; start nearer, set "
                "[device] scale above %f, or let the hand take it anew on the way ([device] ratchet = true)",
                1e3 * room_m.x(), 1e3 * room_m.y(), 1e3 * room_m.z(),
                scene.device.scale * (needed_m.array() / room_m.array()).maxCoeff());
  throw LoadError(scene.file, scene.parts[step.part].part.name, words);
}

/// Where the handle starts each stroke, and what lies between.
Strokes handled(const Way& way, const Pose& X_GP, double scale) {
  Strokes strokes;
  Box stroke;
  Vec3 p_from = way.X_WG.front().p;
  const auto endStroke = [&](const Vec3& p_next) {
    strokes.X_DH_start.push_back(Pose::translation((p_from - stroke.center()) / scale));
    p_from = p_next;
    stroke = Box{};
    stroke.add(p_next);
  };
  for (std::size_t i = 0; i < way.X_WG.size(); ++i) {
    const Vec3& p = way.X_WG[i].p;
    stroke.add(p);
    if (i > 0 && i + 1 < way.X_WG.size()) strokes.way_points.push_back(way.X_WG[i] * X_GP);
    if (!way.is_regrasp[i]) continue;
    strokes.regrasps.push_back(strokes.way_points.size() - 1);
    endStroke(p);
  }
  endStroke(p_from);
  return strokes;
}

}  // namespace

Strokes strokesOf(const Scene& scene, const SceneStep& step, const Vec3& room_m) {
  const double scale = scene.device.scale;
  const Pose X_PG = Pose::translation(massProperties(scene.parts[step.part].part.mesh).com);
  std::vector<Pose> X_WG = {step.X_WP_start * X_PG};
  for (const Pose& X_WP : step.way_points) X_WG.push_back(X_WP * X_PG);
  X_WG.push_back(step.X_WP_target * X_PG);

  Box all;
  for (const Pose& X : X_WG) all.add(X.p);
  const Vec3 needed_m = all.size() / scale;
  if ((needed_m.array() > room_m.array()).any()) {
    if (!scene.device.has_ratchet) refuse(scene, step, needed_m, room_m);
    const Vec3 margin_m = (room_m / 10).cwiseMin(kMargin_m);
    return handled(inStrokes(X_WG, scale * (room_m - 2 * margin_m)), X_PG.inverse(), scale);
  }
  Strokes one = handled({X_WG, std::vector<bool>(X_WG.size(), false)}, X_PG.inverse(), scale);
  one.way_points = step.way_points;  // to the bit
  return one;
}

}  // namespace vps
