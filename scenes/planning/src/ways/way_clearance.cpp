// SPDX-License-Identifier: BSD-3-Clause
#include "ways/way.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "pair/pair_measures.h"
#include "surface/placed_surface.h"
#include "surface/triangle_gap.h"

namespace vps::scenes {

namespace {

using Pair = std::pair<std::size_t, std::size_t>;

constexpr double kEnough_m = 1e-6, kShare = 1e-3;  // accuracy of the least distance: absolute, or relative
constexpr double kResting_m = 10e-6;  // gap that rounding of a drawing leaves between faces that should touch

/// Indices of parts by name, and the pairs that touch.
struct Numbers {
  std::map<std::string, std::size_t> of;
  std::set<Pair> touching;  ///< pairs that are in contact at their targets, or in a fit

  explicit Numbers(const Placing& placing) {
    for (std::size_t i = 0; i < placing.parts.size(); ++i) of[placing.parts[i].name] = i;
    for (const CheckedPair& pair : placing.checked.pairs)
      if (pair.state != PairState::Apart || pair.is_uncertain || pair.clearance_m < kResting_m)
        touching.insert(std::minmax(of.at(pair.a), of.at(pair.b)));
    for (const CheckedFit& fit : placing.checked.fits)
      touching.insert(std::minmax(of.at(fit.shaft), of.at(fit.bore)));
  }
};

/// The path of one part as its scene states the path: poses, between which the part's centre moves on
/// straight lines.
class PartWay {
 public:
  /// @param center_W  middle of what the step moves, about which it turns if it is a screw
  PartWay(const PlacedSurface& part, const PlannedStep& step, const Vec3& center_W) : part_(part) {
    center_P_ = part.surface->box().center();
    radius_m_ = 0.5 * part.surface->box().size().norm();
    for (const Pose& before_W : step.before_W) poses_.push_back(before_W * part.X_WP);
    if (step.kind == WayKind::Screw) appendTurns(step, center_W);
    poses_.push_back(part.X_WP);
  }

  /// Lowers `best_m` if the part comes nearer to the held part than `best_m`.
  bool lower(const PlacedSurface& held, double& best_m) const {
    bool is_lower = false;
    for (std::size_t i = 0; i + 1 < poses_.size(); ++i) {
      Box swept = moved(part_.surface->box(), poses_[i]);
      const Box end = moved(part_.surface->box(), poses_[i + 1]);
      swept.add(end.min);
      swept.add(end.max);
      // A turn sweeps a larger box than the box around its end poses.
      const double turned_m = radius_m_ * angleBetween(poses_[i], poses_[i + 1]);
      if (!overlap(grown(swept, best_m + turned_m), held.box_W)) continue;
      Leg leg{held, poses_[i], poses_[i + 1], 0};
      leg.length_m = (poses_[i + 1] * center_P_ - poses_[i] * center_P_).norm() + turned_m;
      const double before_m = best_m;
      if (turned_m == 0) {
        best_m = leastAlong(leg, best_m);
        is_lower = is_lower || best_m < before_m;
        continue;
      }
      descend(leg, 0, 1, gapAt(leg, 0, best_m), gapAt(leg, 1, best_m), best_m);
      is_lower = is_lower || best_m < before_m;
    }
    return is_lower;
  }

 private:
  struct Leg {
    const PlacedSurface& held;
    const Pose &from, &to;
    double length_m;  ///< upper bound of the path length of any surface point
  };

  static double angleBetween(const Pose& a, const Pose& b) {
    return rotationVector(a.R.transpose() * b.R).norm();
  }

  /// Appends poses along the thread, around the axis of the last leg.
  void appendTurns(const PlannedStep& step, const Vec3& center_W) {
    constexpr double kPiece_rad = std::numbers::pi / 4;
    constexpr int kMostPieces = 400;  // fifty turns
    if (step.lead_m == 0) return;
    const Vec3 out_W = -step.insertion_W;
    const double way_m = out_W.dot(poses_.back() * center_P_ - part_.X_WP * center_P_);
    const double forward_m = step.lead_m / (2 * std::numbers::pi);
    const int pieces = std::min(kMostPieces, static_cast<int>(way_m / (std::abs(forward_m) * kPiece_rad)));
    for (int i = pieces; i > 0; --i) {
      const double turn_rad = kPiece_rad * i;
      const Vec3 vector = (forward_m > 0 ? 1 : -1) * turn_rad * out_W;
      const Mat3 R = rotationFromVector(vector);
      const Vec3 at_W = center_W + std::abs(forward_m) * turn_rad * out_W;
      poses_.emplace_back(R * part_.X_WP.R, at_W - R * (center_W - part_.X_WP.p));
    }
  }

  /// Least distance along a straight leg without a turn, in one descent of both trees: the boxes are swept
  /// along the whole leg. The distance of two facets is convex along the leg, since both facets are convex
  /// sets and one facet is translated.
  /// @return at most best_m; exceeds the least distance by at most a micrometre or a thousandth of that
  /// distance
  [[nodiscard]] double leastAlong(const Leg& leg, double best_m) const {
    const PartSurface &held = *leg.held.surface, &moving = *part_.surface;
    const Pose X_HP = leg.held.X_WP.inverse() * leg.from;
    const Vec3 way_H = leg.held.X_WP.R.transpose() * (leg.to.p - leg.from.p);
    const auto nearEnough = [&] { return best_m - std::max(kEnough_m, kShare * best_m); };
    visitPairs(
        held.tree(), moving.tree(),
        [&](const Box& box) {
          Box swept = moved(box, X_HP);
          const Box end{swept.min + way_H, swept.max + way_H};
          swept.add(end.min);
          swept.add(end.max);
          return swept;
        },
        [](const Box& of_held, const Box& swept) { return distance2(of_held, swept); },
        [&] { return nearEnough() > 0 ? nearEnough() * nearEnough() : 0; },
        [&](std::uint32_t i, std::uint32_t k) {
          Triangle at_start = moving.triangle(k);
          for (Vec3& p : at_start) p = X_HP * p;
          lowerAlong(held.triangle(i), at_start, way_H, nearEnough, best_m);
        });
    return best_m;
  }

  /// Least distance of two facets along the leg. Bisects the interval while the tangents at its ends cross
  /// below the least known distance.
  template <class NearEnough>
  static void lowerAlong(const Triangle& held, const Triangle& start, const Vec3& way, NearEnough nearEnough,
                         double& best_m) {
    struct Point {
      double share, gap_m, slope_m;  // slope_m: derivative by the share of the leg
    };
    const auto at = [&](double share) {
      const Vec3 d = share * way;
      const TriangleGap gap = triangleGap(held, {start[0] + d, start[1] + d, start[2] + d});
      best_m = std::min(best_m, gap.distance_m);
      if (gap.distance_m == 0) return Point{share, 0, 0};
      return Point{share, gap.distance_m, way.dot(gap.p_b - gap.p_a) / gap.distance_m};
    };
    constexpr int kMostHalvings = 40;
    Point from = at(0), to = at(1);
    // A tangent of a convex function lies below the function, and the minimum lies where the slope changes
    // its sign.
    for (int i = 0; i < kMostHalvings && from.slope_m < 0 && to.slope_m > 0; ++i) {
      const double crossing = (to.gap_m - from.gap_m + from.slope_m * from.share - to.slope_m * to.share) /
                              (from.slope_m - to.slope_m);
      if (from.gap_m + from.slope_m * (crossing - from.share) >= nearEnough()) return;
      const Point middle = at(0.5 * (from.share + to.share));
      if (middle.slope_m == 0) return;
      (middle.slope_m < 0 ? from : to) = middle;
    }
  }

  [[nodiscard]] Pose poseAt(const Leg& leg, double share) const {
    const Pose X_PC = Pose::translation(center_P_);
    return interpolate(leg.from * X_PC, leg.to * X_PC, share) * X_PC.inverse();
  }

  [[nodiscard]] double gapAt(const Leg& leg, double share, double& best_m) const {
    const Pose X_WP = poseAt(leg, share);
    const double most_m = best_m + leg.length_m;  // a greater distance proves that the leg is free
    const double gap_m =
        surfaceGap(*part_.surface, *leg.held.surface, X_WP.inverse() * leg.held.X_WP, most_m).distance_m;
    best_m = std::min(best_m, gap_m);
    return std::min(gap_m, most_m);
  }

  void descend(const Leg& leg, double from, double to, double from_m, double to_m, double& best_m) const {
    constexpr double kLeastPiece = 1.0 / 4096;
    const double least_m = 0.5 * (from_m + to_m - (to - from) * leg.length_m);
    if (least_m >= best_m - std::max(kEnough_m, kShare * best_m) || to - from < kLeastPiece) return;
    const double middle = 0.5 * (from + to);
    const double middle_m = gapAt(leg, middle, best_m);
    descend(leg, from, middle, from_m, middle_m, best_m);
    descend(leg, middle, to, middle_m, to_m, best_m);
  }

  const PlacedSurface& part_;
  Vec3 center_P_;
  double radius_m_ = 0;
  std::vector<Pose> poses_;
};

/// Middle of the part, or of the parts, that a step moves, at the target.
Vec3 middleOf(const Placing& placing, const Numbers& numbers, const PlannedStep& step) {
  const PlacedSurface& first = placing.parts[numbers.of.at(step.parts.front())];
  if (step.parts.size() == 1) return first.X_WP * first.surface->box().center();
  Box box_W;
  for (const std::string& name : step.parts) {
    const Box& of_part_W = placing.parts[numbers.of.at(name)].box_W;
    box_W.add(of_part_W.min);
    box_W.add(of_part_W.max);
  }
  return box_W.center();
}

}  // namespace

void measureWays(const Placing& placing, PlannedAssembly& assembly, const Progress& progress) {
  const Numbers numbers(placing);
  std::vector<std::size_t> held;  // held parts in order of assembly
  std::vector<std::size_t> held_before;
  for (const std::string& name : assembly.fixed) held.push_back(numbers.of.at(name));
  for (const PlannedStep& step : assembly.steps) {
    held_before.push_back(held.size());
    for (const std::string& name : step.parts) held.push_back(numbers.of.at(name));
  }
  std::map<std::size_t, std::vector<const CheckedFit*>> fits;
  for (const CheckedFit& fit : placing.checked.fits)
    for (const std::string& name : {fit.shaft, fit.bore}) fits[numbers.of.at(name)].push_back(&fit);
  forEachOnCores(assembly.steps.size(), progress, "measuring the paths", [&](std::size_t i) {
    PlannedStep& step = assembly.steps[i];
    const std::vector<std::size_t> in_place(held.begin(),
                                            held.begin() + static_cast<std::ptrdiff_t>(held_before[i]));
    double best_m = kNearWay_m;
    const Vec3 center_W = middleOf(placing, numbers, step);
    for (const std::string& name : step.parts) {
      const std::size_t part = numbers.of.at(name);
      const PartWay way(placing.parts[part], step, center_W);
      for (const std::size_t other : in_place)
        if (!numbers.touching.contains(std::minmax(part, other)) && way.lower(placing.parts[other], best_m))
          step.nearest = placing.parts[other].name;
      if (const auto of_part = fits.find(part); of_part != fits.end())
        for (const CheckedFit* fit : of_part->second) {
          const std::size_t mate = numbers.of.at(fit->shaft == name ? fit->bore : fit->shaft);
          if (std::ranges::find(in_place, mate) == in_place.end()) continue;
          step.fit_clearance_m =
              std::min(fit->diametral_clearance_m, step.fit_clearance_m.value_or(fit->diametral_clearance_m));
        }
    }
    if (!step.nearest.empty()) step.clearance_m = best_m;
  });
}

}  // namespace vps::scenes
