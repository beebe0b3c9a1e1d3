// SPDX-License-Identifier: BSD-3-Clause
#include "step/way_check.h"

#include <algorithm>

#include "text/words.h"

namespace vps::scenes {

namespace {

constexpr int kPosesPerLeg = 24;
// The error of a hand's aim is greater than this, so that a shallower contact does not stop the hand. assumed
constexpr double kShallow_m = 0.1e-3;

/// Interpolates a pose: the centre of mass moves on a straight line, and the part turns at a constant rate.
Pose between(const Pose& a, const Pose& b, const Vec3& center_P, double share) {
  const Vec3 turn = share * rotationVector(b.R * a.R.transpose());
  Pose X(Mat3(rotationFromVector(turn) * a.R), Vec3::Zero());
  X.p = (1 - share) * (a * center_P) + share * (b * center_P) - X.R * center_P;
  return X;
}

/// Deepest penetration at kPosesPerLeg poses from `from` on, without `to`.
Penetration deepestBetween(const OverlapJudge& judge, const JudgedBody& body, const Vec3& center_P,
                           const Pose& from, const Pose& to) {
  Penetration deepest;
  for (int i = 0; i < kPosesPerLeg; ++i) {
    const double share = i / static_cast<double>(kPosesPerLeg);
    const Penetration here = judge.deepest(body, between(from, to, center_P, share));
    if (here.depth_m > deepest.depth_m) deepest = here;
  }
  return deepest;
}

}  // namespace

std::string wallOnTheWay(AssemblyWorld& world, const SceneStep& step) {
  const OverlapJudge& judge = world.placed().judge();
  std::vector<Pose> stops{step.X_WP_start};
  stops.insert(stops.end(), step.way_points.begin(), step.way_points.end());
  stops.push_back(step.X_WP_target);
  Penetration deepest;
  for (std::size_t leg = 0; leg + 1 < stops.size(); ++leg) {
    const Penetration here = deepestBetween(judge, world.placed().judgedBody(step.part),
                                            world.state().moving.X_PG.p, stops[leg], stops[leg + 1]);
    if (here.depth_m > deepest.depth_m) deepest = here;
  }
  if (deepest.depth_m < kShallow_m) return {};
  return "; the part's path leads through '" + judge.name(deepest.against) + "', up to " +
         lengthInWords(deepest.depth_m) + " deep at " + placeInWords(deepest.p_W) +
         ": set start or way_points that lead around this part";
}

bool isFreeBetween(const OverlapJudge& judge, const JudgedBody& body, const Vec3& center_P, const Pose& from,
                   const Pose& to, double limit_m) {
  return deepestBetween(judge, body, center_P, from, to).depth_m <= limit_m;
}

bool isFreeToTarget(AssemblyWorld& world, const SceneStep& step, const Pose& X_WP, double limit_m) {
  const OverlapJudge& judge = world.placed().judge();
  const JudgedBody& body = world.placed().judgedBody(step.part);
  for (const Pose& end : {X_WP, step.X_WP_target})
    limit_m = std::max(limit_m, judge.deepest(body, end).depth_m);
  return isFreeBetween(judge, body, world.state().moving.X_PG.p, X_WP, step.X_WP_target, limit_m);
}

bool isFreeBeyondTarget(AssemblyWorld& world, const SceneStep& step, const Vec3& axis_W, double by_m,
                        double limit_m) {
  const OverlapJudge& judge = world.placed().judge();
  const JudgedBody& body = world.placed().judgedBody(step.part);
  limit_m = std::max(limit_m, judge.deepest(body, step.X_WP_target).depth_m);
  const Pose X_beyond = Pose::translation(by_m * axis_W) * step.X_WP_target;
  return judge.deepest(body, X_beyond).depth_m <= limit_m;
}

}  // namespace vps::scenes
