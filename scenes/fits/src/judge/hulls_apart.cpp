// SPDX-License-Identifier: BSD-3-Clause
// Convex hulls that stay apart: a pair needs no exact measure where one direction separates the hulls.
#include <algorithm>
#include <cmath>

#include "judge/motion_judge.h"
#include "judge/pair_path.h"

namespace vps::scenes {

namespace {

/// Number of failed searches after which no separating direction is searched for a pair.
constexpr int kSearches = 3;

}  // namespace

/// Whether the hulls of a and b overlap along n_A by at most enough_m at all moments of an interval. Points
/// of b move along arcs, which are replaced by chords.
bool MotionJudge::areApartAlong(PairPath& path, const Vec3& n_A, double from, double to, double enough_m) {
  const double highest_a_m = body(path.a).highest_m(n_A);
  double deep_m = 0;
  const auto isApartAt = [&](double step, double bend_m) {
    const Pose X_AB = poseAt(path.a, step).inverse() * poseAt(path.b, step);
    const double lowest_b_m = n_A.dot(X_AB.p) - body(path.b).highest_m(-(X_AB.R.transpose() * n_A));
    spend(1);
    deep_m = highest_a_m - lowest_b_m;
    return deep_m + bend_m <= enough_m;
  };
  if (!isApartAt(to, 0)) return false;
  path.end_depth_m = std::min(path.end_depth_m, deep_m + path.travel_m.back() - path.travelAt(to));
  for (double begin = from; begin < to;) {
    const double end = std::min(to, std::floor(begin) + 1), share = end - begin;
    const double sagitta_m = path.sagitta_m[static_cast<std::size_t>(begin)] * share * share;
    const double chords = std::min(kMostChords, chordsOf(sagitta_m));
    for (double i = 0; i < chords; ++i)
      if (!isApartAt(std::lerp(begin, end, i / chords), sagitta_m / (chords * chords))) return false;
    begin = end;
  }
  return true;
}

/// Whether a direction separates the hulls during the interval. Tries the direction that separated the hulls
/// last, then the axes of both bodies at the middle of the interval.
bool MotionJudge::areHullsApart(PairPath& path, double from, double to, double enough_m) {
  const auto last = direction_A_.find(path.pair);
  if (last != direction_A_.end() && areApartAlong(path, last->second, from, to, enough_m)) return true;
  if (path.searches >= kSearches) return false;
  const double middle = 0.5 * (from + to);
  const Mat3 R_AB = poseAt(path.a, middle).R.transpose() * poseAt(path.b, middle).R;
  for (const Mat3& axes : {Mat3(Mat3::Identity()), R_AB})
    for (int side = 0; side < 6; ++side) {
      const Vec3 n_A = (side % 2 == 0 ? 1 : -1) * axes.col(side / 2);
      if (!areApartAlong(path, n_A, from, to, enough_m)) continue;
      direction_A_[path.pair] = n_A;
      return true;
    }
  ++path.searches;
  return false;
}

}  // namespace vps::scenes
