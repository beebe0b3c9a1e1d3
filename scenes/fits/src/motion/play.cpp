// SPDX-License-Identifier: BSD-3-Clause
#include "motion/play.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "motion/screw_profile.h"

namespace vps::scenes {

namespace {

constexpr double kPlayForever = std::numeric_limits<double>::infinity();
constexpr double kSame = 1e-9;  // squared distance of equal directions

bool isOf(const CheckedFit& fit, const PlacedSurface& part) {
  return fit.shaft == part.name || fit.bore == part.name;
}

Vec3 centreOf(const PlacedSurface& part) {
  const Box& box = part.surface->box();
  const MassProperties mass = part.surface->solid().mass();
  // The computed centre of mass of an open mesh can be anywhere.
  const bool is_within = mass.volume_m3 > 0 && isWithin(mass.com, box);
  return part.X_WP * (is_within ? mass.com : box.center());
}

/// Turns the axes by the least angle so that the axis nearest to d is parallel to d.
Mat3 turnedTo(const Mat3& axes, const Vec3& d) {
  int nearest = 0;
  (axes.transpose() * d).cwiseAbs().maxCoeff(&nearest);
  const Vec3 from = axes.col(nearest);
  const Vec3 to = from.dot(d) > 0 ? d : Vec3(-d);
  if ((from - to).squaredNorm() < kSame * kSame) return axes;
  return Quat::FromTwoVectors(from, to).toRotationMatrix() * axes;
}

}  // namespace

PlayFrame playFrame(const PlacedSurface& part, const std::vector<CheckedFit>& fits) {
  PlayFrame frame{part.X_WP.R, centreOf(part)};
  const CheckedFit* longest = nullptr;
  for (const CheckedFit& fit : fits) {
    if (!isOf(fit, part) || fit.kind == FitKind::Key) continue;
    // A part is guided by the fits in which it is the shaft. Fits in which the part is the bore may be many
    // and count less.
    const bool is_better =
        longest == nullptr || std::pair(fit.shaft == part.name, fit.length_m) >
                                  std::pair(longest->shaft == part.name, longest->length_m);
    if (is_better) longest = &fit;
  }
  if (longest == nullptr) return frame;
  frame.axes_W = turnedTo(frame.axes_W, longest->axis_W);
  frame.center_W = longest->at_W + longest->axis_W * longest->axis_W.dot(frame.center_W - longest->at_W);
  return frame;
}

AxisPlay playAlong(const MotionSearch& search, const PlayFrame& frame, int axis, double leave_m,
                   double error_m) {
  const Motion motion{frame.axes_W.col(axis % 3), frame.center_W, axis >= 3};
  const std::array<Reach, 2> reach =
      search.reachBoth(motion, motion.is_turn ? 2 * std::numbers::pi : leave_m);
  AxisPlay play;
  for (const std::size_t i : {0, 1}) {
    play.way[i] = reach[i].is_stopped ? reach[i].s : kPlayForever;
    play.is_given_up = play.is_given_up || reach[i].is_given_up;
    if (!reach[i].is_stopped) continue;
    // A face that the motion does not approach but for rounding stops it at no certain place.
    constexpr double kNoRate = 1e-9;
    const double off_m = std::max(error_m, search.chordOf_m(reach[i].by) + MotionSearch::kRest_m);
    const bool is_along = reach[i].rate < kNoRate;
    play.error[i] = reach[i].is_given_up || is_along ? kPlayForever : off_m / reach[i].rate;
  }
  return play;
}

std::vector<Vec3> waysOut(const MotionSearch& search, const PlacedSurface& part, const PlayFrame& frame,
                          const std::vector<CheckedFit>& fits, double leave_m) {
  std::vector<Vec3> directions;
  const auto add = [&](const Vec3& d) {
    const bool is_new = std::ranges::none_of(
        directions, [&](const Vec3& other) { return (other - d).squaredNorm() < kSame; });
    if (is_new) directions.push_back(d);
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1, -1}) add(sign * frame.axes_W.col(axis));
  for (const CheckedFit& fit : fits)
    if (isOf(fit, part) && fit.kind != FitKind::Key)
      for (const double sign : {1, -1}) add(sign * fit.axis_W);
  for (const Vec3& d : makeSphere(1, 1).vertices) add(d);

  std::vector<Vec3> ways;
  std::vector<Blocker> blockers;  // a facet pair that stopped one direction stops many others
  for (const Vec3& d : directions) {
    const Motion motion{d, Vec3::Zero(), false};
    if (std::ranges::any_of(blockers,
                            [&](const Blocker& b) { return search.isStoppedBy(b, motion, leave_m); }))
      continue;
    const Reach reach = search.reach(motion, leave_m);
    if (reach.is_stopped)
      blockers.insert(blockers.begin(), reach.by);
    else
      ways.push_back(d);
  }
  return ways;
}

std::vector<ScrewWay> screwWaysOut(const MotionSearch& search, const PlacedSurface& part,
                                   const std::vector<CheckedFit>& fits, double leave_m) {
  std::vector<ScrewWay> ways;
  for (const CheckedFit& fit : fits) {
    if (!isOf(fit, part) || fit.kind != FitKind::Thread) continue;
    const double forward_m = fit.lead_m / (2 * std::numbers::pi);
    // A right-hand thread advances along the axis when it is turned to the right.
    const Motion screw{fit.axis_W, fit.at_W, true, forward_m};
    const double most_rad = leave_m / std::abs(forward_m);
    const bool is_screw = fit.shaft == part.name;
    const std::size_t mate = search.indexOf(is_screw ? fit.bore : fit.shaft);
    const PlacedSurface& other = search.held(mate);
    const PlacedSurface &inner = is_screw ? part : other, &outer = is_screw ? other : part;
    // The nut moves over the screw, or the screw moves in the opposite direction through the nut.
    const Vec3 ahead_W = (forward_m > 0) == is_screw ? Vec3(-fit.axis_W) : fit.axis_W;
    const PassingFacets forwards(mate, is_screw, ScrewProfile(outer, screw, inner, ahead_W).passing(inner),
                                 inner.surface->tree());
    const PassingFacets back(mate, is_screw, ScrewProfile(outer, screw, inner, -ahead_W).passing(inner),
                             inner.surface->tree());
    const std::array<Reach, 2> reach = search.reachBoth(screw, most_rad, {&forwards, &back});
    for (const std::size_t i : {0, 1})
      if (!reach[i].is_stopped)
        ways.push_back({(i == 0) == (forward_m > 0) ? fit.axis_W : Vec3(-fit.axis_W), fit.at_W, fit.lead_m});
  }
  return ways;
}

}  // namespace vps::scenes
