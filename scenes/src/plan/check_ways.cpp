// SPDX-License-Identifier: BSD-3-Clause
// Overlap along the ways of a scene. It measures depths at poses and does not use the search that found the
// ways, so that it judges a plan independently.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "check/on_cores.h"
#include "check/placed_surface.h"
#include "plan/pair_motions.h"

#include "vps_scenes/plan.h"

namespace vps::scenes::inline v0 {

namespace {

constexpr int kPosesOfLeg = 24;
constexpr double kTouch_m = 10e-6;  // as StepResult::penetration_limit_m without a clearance

class WayCheck {
 public:
  WayCheck(const Scene& scene, const std::vector<PlacedSurface>& placed, std::size_t step)
      : step_(scene.steps[step]), part_(placed[step_.part]) {
    for (std::size_t i = 0; i < scene.parts.size(); ++i)
      if (scene.parts[i].is_fixed) held_.push_back(&placed[i]);
    for (std::size_t i = 0; i < step; ++i) held_.push_back(&placed[scene.steps[i].part]);
  }

  /// Where the way is deepest in a part, beyond what is drawn; no part if it is free.
  [[nodiscard]] WayFault deepest() const {
    WayFault worst;
    const std::vector<Pose> poses = poses_W();
    for (const PlacedSurface* held : held_) {
      const double allowed_m = kTouch_m + depthAt(*held, step_.X_WP_target).depth_m;
      for (const Pose& X_WP : poses) {
        if (!overlap(moved(part_.surface->box(), X_WP), held->box_W)) continue;
        const Overlap here = depthAt(*held, X_WP);
        if (here.depth_m <= allowed_m || here.depth_m - allowed_m <= worst.depth_m - worst.allowed_m)
          continue;
        worst = {part_.name, held->name, here.depth_m, allowed_m, here.p_W};
      }
    }
    return worst;
  }

 private:
  [[nodiscard]] Overlap depthAt(const PlacedSurface& held, const Pose& X_WP) const {
    return deepestOverlap(part_.surface->overlap(), X_WP, held.surface->overlap(), held.X_WP);
  }

  [[nodiscard]] std::vector<Pose> poses_W() const {
    std::vector<Pose> stops{step_.X_WP_start};
    stops.insert(stops.end(), step_.way_points.begin(), step_.way_points.end());
    stops.push_back(step_.X_WP_target);
    std::vector<Pose> poses;
    for (std::size_t leg = 0; leg + 1 < stops.size(); ++leg)
      for (int i = 0; i < kPosesOfLeg; ++i) {
        const bool is_turned = step_.motion == StepMotion::Screw && leg + 2 == stops.size();
        const double share = static_cast<double>(i) / kPosesOfLeg;
        poses.push_back(is_turned ? screwed(1 - share, stops[leg])
                                  : between(stops[leg], stops[leg + 1], share));
      }
    return poses;
  }

  /// As the hand moves it: its centre on a straight line.
  [[nodiscard]] Pose between(const Pose& from, const Pose& to, double share) const {
    const Vec3 center_P = centerOfMass();
    const Pose X_PG = Pose::translation(center_P);
    return interpolate(from * X_PG, to * X_PG, share) * X_PG.inverse();
  }

  /// A share of the way out from the target, along the thread.
  [[nodiscard]] Pose screwed(double share, const Pose& from) const {
    const Vec3 center_P = centerOfMass(), center_W = step_.X_WP_target * center_P;
    const Vec3 out_W = share * (from * center_P - center_W);
    if (out_W.norm() < 1e-12) return step_.X_WP_target;
    const double turn_rad = 2 * std::numbers::pi * out_W.norm() / step_.pitch_m;
    const Motion turn{out_W.normalized(), center_W, true, step_.pitch_m / (2 * std::numbers::pi)};
    return turn.at(turn_rad) * step_.X_WP_target;
  }

  [[nodiscard]] Vec3 centerOfMass() const { return massProperties(part_.surface->mesh()).com; }

  const SceneStep& step_;
  const PlacedSurface& part_;
  std::vector<const PlacedSurface*> held_;
};

}  // namespace

std::vector<WayFault> checkWays(const Scene& scene, const Progress& progress) {
  const std::vector<DrawnPart> drawn = drawnParts(scene);
  const std::vector<PlacedSurface> placed = placedSurfaces(drawn, progress);
  std::vector<WayFault> of_step(scene.steps.size());
  forEachOnCores(scene.steps.size(), progress, "checking the ways",
                 [&](std::size_t i) { of_step[i] = WayCheck(scene, placed, i).deepest(); });
  std::erase_if(of_step, [](const WayFault& fault) { return fault.against.empty(); });
  return of_step;
}

}  // namespace vps::scenes::inline v0
