// SPDX-License-Identifier: BSD-3-Clause
#include "proof/pose_cover.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <queue>
#include <utility>
#include <vector>

#include "motion/gap_program.h"
#include "proof/inner_body.h"
#include "surface/placed_surface.h"
#include "vps/box_intersection.h"
#include "vps/mesh_overlap.h"
#include "vps/stoppable.h"

namespace vps::scenes {

namespace {

constexpr double kMostTurn_rad = 0.6;  // up to which the remainders of a cell's rotation hold with room

/// A box of motions.
struct Cell {
  SixNumbers center, half;
  double greatest_m = 0;   ///< upper bound of the least gap in the cell that it was part of
  std::size_t number = 0;  ///< in the order of creation
  int depth = 0;           ///< halvings that made it
  std::shared_ptr<const std::vector<std::size_t>> samples;  ///< those that may be near the other solid
};

/// Cells that may have the widest gap first; of equal ones the older.
struct IsLess {
  bool operator()(const Cell& a, const Cell& b) const {
    return a.greatest_m != b.greatest_m ? a.greatest_m < b.greatest_m : a.number > b.number;
  }
};

/// A point of one of the surfaces.
struct Sample {
  std::size_t obstacle = 0;
  bool is_of_part = false;  ///< of the part that moves; else of the obstacle
  Vec3 p = Vec3::Zero();    ///< in the frame of its surface
};

/// A sample over one cell.
struct CellGap {
  LinearGap gap;  ///< in units of the cell's half widths; without the remainder of the inner body
  std::size_t sample = 0;
  double moved_m = 0;     ///< greatest displacement of the point within the cell, relative to the other solid
  double distance_m = 0;  ///< at the cell's middle
  bool is_bounded = false;  ///< the inner body's remainder is included
};

/// Points of a surface in a box: its vertices, and points of its facets about `apart_m` apart.
void appendPoints(const PartSurface& surface, const Box& within, double apart_m, std::vector<Vec3>& out) {
  surface.tree().forEach(
      [&](const Box& box) { return overlap(box, within); },
      [&](std::uint32_t i) {
        const Triangle t = surface.triangle(i);
        const double longest_m = std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
        const int n = std::clamp(int(std::ceil(longest_m / apart_m)), 1, 200);
        for (int a = 0; a <= n; ++a)
          for (int b = 0; a + b <= n; ++b) {
            const Vec3 p = t[0] + (double(a) / n) * (t[1] - t[0]) + (double(b) / n) * (t[2] - t[0]);
            if (isWithin(p, within)) out.push_back(p);
          }
      });
  // Facets share corners and edges.
  std::ranges::sort(out, [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  });
  out.erase(std::unique(out.begin(), out.end()), out.end());
}

class CoverSearch {
 public:
  CoverSearch(const PartSurface& part, const Pose& X_WP, std::span<const Obstacle> obstacles,
              const PoseSet& set, std::size_t most_work)
      : part_(part), X_WP_(X_WP), obstacles_(obstacles), set_(set), most_work_(most_work) {
    reach_m_ = set.half.head<3>().norm();
    for (std::size_t i = 0; i < obstacles.size(); ++i) addSamples(i);
  }

  PoseCover search() {
    if (!(set_.center.tail<3>().norm() + set_.half.tail<3>().norm() < kMostTurn_rad)) return out_;
    std::priority_queue<Cell, std::vector<Cell>, IsLess> cells;
    std::vector<std::size_t> all(samples_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    cells.push(
        {set_.center, set_.half, 0, 0, 0, std::make_shared<const std::vector<std::size_t>>(std::move(all))});
    std::size_t made = 1;
    while (!cells.empty()) {
      if (out_.work > most_work_) return out_;
      pollStop();
      const Cell cell = cells.top();
      cells.pop();
      ++out_.cells;
      if (isOutside(cell)) continue;
      const Examined found = examine(cell);
      if (found.is_proven) continue;
      if (out_.free) return out_;
      for (const double side : {-0.5, 0.5}) {
        Cell child{cell.center, cell.half, found.greatest_m, made++, cell.depth + 1, found.near};
        child.half[found.axis] *= 0.5;
        child.center[found.axis] += side * cell.half[found.axis];
        cells.push(child);
      }
    }
    out_.is_proven = true;
    return out_;
  }

 private:
  /// Greatest rotations within a cell relative to its middle: along the axes, and as a whole. The rotation
  /// vector of Exp(r) Exp(r_c)^-1 is r - r_c up to (|r| + |r - r_c|) / 2 of it, with a fifth of room for
  /// terms of higher order; it is never longer than r - r_c.
  struct Turn {
    Vec3 half;
    double most = 0;
  };
  [[nodiscard]] static Turn turnOf(const Cell& cell) {
    const double most = cell.half.tail<3>().norm();
    const double share = 0.6 * (cell.center.tail<3>().norm() + 2 * most);
    return {cell.half.tail<3>().array() + share * most, most};
  }

  /// Whether no motion of the cell is of the set, since at each of them some corner moves too far.
  [[nodiscard]] bool isOutside(const Cell& cell) const {
    if (set_.box_W.isEmpty()) return false;
    const Pose X = poseAfter(Pose(), set_.at_W, cell.center);
    for (int i = 0; i < 8; ++i) {
      const Vec3 p_W = cornerOf(set_.box_W, i);
      const double moved_m =
          cell.half.head<3>().norm() + cell.half.tail<3>().norm() * (p_W - set_.at_W).norm();
      if ((X * p_W - p_W).norm() - moved_m > set_.most_m) return true;
    }
    return false;
  }

  void addSamples(std::size_t obstacle) {
    constexpr std::size_t kMostOfSide = 400;
    constexpr double kApart = 1.0 / 6;  // of the shared box's diagonal, and less as long as there is room
    const Obstacle& other = obstacles_[obstacle];
    const Box other_W = moved(other.surface->box(), other.X_WP);
    Box part_W = moved(part_.box(), X_WP_);
    part_W = grown(part_W, reach_m_ + set_.half.tail<3>().norm() * part_.box().size().norm());
    if (!overlap(part_W, other_W)) return;
    const Box both = intersection(part_W, other_W);
    const double near_m = reach_m_ + set_.half.tail<3>().norm() * both.size().norm();
    const Pose X_OP = other.X_WP.inverse() * X_WP_;
    for (const bool is_of_part : {true, false}) {
      const PartSurface &from = is_of_part ? part_ : *other.surface,
                        &to = is_of_part ? *other.surface : part_;
      const Pose X_WF = is_of_part ? X_WP_ : other.X_WP, X_TF = is_of_part ? X_OP : X_OP.inverse();
      const Box within = moved(both, X_WF.inverse());
      std::vector<Vec3> points;
      double apart_m = kApart * both.size().norm();
      for (int k = 0; k < 3 && points.size() < kMostOfSide / 4; ++k, apart_m *= 0.5) {
        points.clear();
        appendPoints(from, within, apart_m, points);
        std::erase_if(points,
                      [&](const Vec3& p) { return std::abs(to.solid().signedDistance(X_TF * p)) > near_m; });
      }
      // Of too many points, evenly some along the order in which they were sorted.
      const std::size_t count = std::min(points.size(), kMostOfSide);
      for (std::size_t i = 0; i < count; ++i)
        samples_.push_back({obstacle, is_of_part, points[i * points.size() / count]});
    }
  }

  /// Solid that the sample is compared with, and its pose when the part is at X_WP.
  [[nodiscard]] std::pair<const PartSurface*, Pose> other(const Sample& sample, const Pose& X_WP) const {
    const Obstacle& obstacle = obstacles_[sample.obstacle];
    return sample.is_of_part ? std::pair{obstacle.surface, obstacle.X_WP} : std::pair{&part_, X_WP};
  }

  [[nodiscard]] PointAtSolid pointAt(const Sample& sample, const Pose& X_WP) const {
    const auto [solid, X_WS] = other(sample, X_WP);
    const Pose X_WF = sample.is_of_part ? X_WP : obstacles_[sample.obstacle].X_WP;
    return {*solid, X_WS.inverse() * (X_WF * sample.p)};
  }

  /// The gap of a sample over a cell, up to the remainder of an inner body.
  [[nodiscard]] CellGap gapOf(std::size_t index, const Cell& cell, const Turn& turn, const Pose& X_WP) const {
    const Sample& sample = samples_[index];
    const PointAtSolid at = pointAt(sample, X_WP);
    const auto [solid, X_WS] = other(sample, X_WP);
    const Pose X_WF = sample.is_of_part ? X_WP : obstacles_[sample.obstacle].X_WP;
    const Vec3 n_W = X_WS.R * at.n();
    // From the point about which the rotation turns; it moves with the part.
    const Vec3 arm_W = X_WF * sample.p - set_.at_W - cell.center.head<3>();
    const double arm_m = arm_W.norm(), shift_m = cell.half.head<3>().norm(), d = turn.most;
    CellGap out;
    out.sample = index;
    out.distance_m = at.distance_m();
    out.moved_m = shift_m + d * arm_m;
    const double sign = sample.is_of_part ? 1 : -1;
    out.gap.slope_m.head<3>() = sign * n_W.cwiseProduct(Vec3(cell.half.head<3>()));
    out.gap.slope_m.tail<3>() = sign * arm_W.cross(n_W).cwiseProduct(turn.half);
    // A rotation vector x of length d displaces a point of the part by x cross arm, and by x cross (x cross
    // arm) / 2
    // + O(d^3), whose component along n is at most d^2 (|arm| - n . arm) / 4. A point at rest is displaced in
    // the part's frame by the opposite rotation, after the displacement.
    const double second_m = sample.is_of_part
                                ? 0.25 * d * d * (arm_m - n_W.dot(arm_W)) + d * d * d * arm_m / 6
                                : 0.5 * d * d * arm_m + d * shift_m;
    out.gap.at_zero_m = at.distance_m() + second_m + obstacles_[sample.obstacle].error_m;
    return out;
  }

  struct Examined {
    bool is_proven = false;
    int axis = 0;           ///< along which to halve the cell
    double greatest_m = 0;  ///< upper bound of the least gap
    std::shared_ptr<const std::vector<std::size_t>> near;
    [[nodiscard]] static Examined proven() {
      Examined out;
      out.is_proven = true;
      return out;
    }
  };

  /// Proves a cell, finds a free pose, or tells how to halve the cell.
  [[nodiscard]] Examined examine(const Cell& cell) {
    const Turn turn = turnOf(cell);
    const Pose X_WP = poseAfter(X_WP_, set_.at_W, cell.center);
    if (last_ < samples_.size() && staysInside(gapOf(last_, cell, turn, X_WP))) return Examined::proven();
    std::vector<std::size_t> tried = *cell.samples, near;
    std::vector<CellGap> gaps;
    for (int round = 0; round < 2; ++round) {
      double deepest_m = 0;
      for (const std::size_t i : tried) {
        const CellGap gap = gapOf(i, cell, turn, X_WP);
        ++out_.work;
        if (staysInside(gap)) {
          last_ = i;
          return Examined::proven();
        }
        deepest_m = std::max(deepest_m, -gap.distance_m - obstacles_[samples_[i].obstacle].error_m);
        if (std::abs(gap.distance_m) <= 3 * gap.moved_m) near.push_back(i);
        if (std::abs(gap.distance_m) <= 2 * gap.moved_m) gaps.push_back(gap);
      }
      if (deepest_m > 0) break;
      // No sample shows an overlap; perhaps another point does.
      const std::size_t known = samples_.size();
      if (!addDeepest(X_WP)) {
        out_.free = cell.center;
        return {};
      }
      tried = {known, known + 1};
    }
    Examined out;
    out.near = std::make_shared<const std::vector<std::size_t>>(std::move(near));
    std::vector<LinearGap> linear;
    for (const CellGap& gap : gaps) linear.push_back(gap.gap);
    GreatestGap found;
    while (!linear.empty()) {
      found = greatestLeastGap(linear);
      out_.work += 1 + linear.size() / 8;
      if (!(found.most_m < 0)) break;
      bool is_new = false;
      for (std::size_t i = 0; i < gaps.size(); ++i) {
        if (!(found.weight[i] > 0) || gaps[i].is_bounded) continue;
        is_new = gaps[i].is_bounded = true;
        linear[i].at_zero_m += remainder(gaps[i], X_WP);
      }
      if (!is_new) return Examined::proven();
    }
    out.greatest_m = linear.empty() ? kFar_m : found.most_m;
    // The best axis for the present weights, which may be another than for those of the halves, and the
    // longest one in turn: every axis is halved in the end.
    out.axis = cell.depth % 2 == 0 ? bestAxis(cell, X_WP, gaps, found) : longestAxis(cell, gaps, found);
    return out;
  }

  /// Whether the point is so deep at the cell's middle that it stays inside.
  [[nodiscard]] bool staysInside(const CellGap& gap) const {
    return -gap.distance_m - obstacles_[samples_[gap.sample].obstacle].error_m > gap.moved_m;
  }

  /// What the best inner body adds to a gap.
  [[nodiscard]] double remainder(const CellGap& gap, const Pose& X_WP) {
    const Sample& sample = samples_[gap.sample];
    const GapBound bound =
        pointAt(sample, X_WP).bound(gap.moved_m, obstacles_[sample.obstacle].error_m, out_.work);
    return std::min(bound.most_m - gap.distance_m, kFar_m);
  }

  /// The axis along which halving the cell lessens the bound by the present weights most.
  [[nodiscard]] int bestAxis(const Cell& cell, const Pose& X_WP, const std::vector<CellGap>& gaps,
                             const GreatestGap& found) {
    int best = longestAxis(cell, gaps, found);
    double least_m = kFar_m;
    for (int axis = 0; axis < 6; ++axis) {
      Cell halved = cell;
      halved.half[axis] *= 0.5;
      if (halved.half == cell.half) continue;
      const Turn turn = turnOf(halved);
      double bound_m = 0;
      SixNumbers mean = SixNumbers::Zero();
      for (std::size_t i = 0; i < found.weight.size(); ++i) {
        if (!(found.weight[i] > 0)) continue;
        const CellGap gap = gapOf(gaps[i].sample, halved, turn, X_WP);
        bound_m += found.weight[i] * (gap.gap.at_zero_m + remainder(gap, X_WP));
        mean += found.weight[i] * gap.gap.slope_m;
      }
      bound_m += mean.cwiseAbs().sum();
      if (bound_m < least_m) least_m = bound_m, best = axis;
    }
    return best;
  }

  /// The axis along which the cell is longest, with what the weighted mean of the slopes adds.
  [[nodiscard]] int longestAxis(const Cell& cell, const std::vector<CellGap>& gaps,
                                const GreatestGap& found) const {
    SixNumbers size = cell.half, mean = SixNumbers::Zero();
    size.tail<3>() *= 0.5 * part_.box().size().norm();
    for (std::size_t i = 0; i < found.weight.size(); ++i) mean += found.weight[i] * gaps[i].gap.slope_m;
    for (int k = 0; k < 6; ++k)
      if (cell.half[k] > 0) size[k] += std::abs(mean[k]);
    int axis = 0;
    size.maxCoeff(&axis);
    return axis;
  }

  /// Measures the overlap exactly. Makes the deepest point a sample if it is deeper than the error allows.
  bool addDeepest(const Pose& X_WP) {
    for (std::size_t i = 0; i < obstacles_.size(); ++i) {
      const Obstacle& obstacle = obstacles_[i];
      const Overlap deepest =
          deepestOverlap(part_.overlap(), X_WP, obstacle.surface->overlap(), obstacle.X_WP);
      out_.work += 1 + deepest.work;
      if (!(deepest.depth_m > obstacle.error_m)) continue;
      samples_.push_back({i, true, X_WP.inverse() * deepest.p_W});
      samples_.push_back({i, false, obstacle.X_WP.inverse() * deepest.p_W});
      return true;
    }
    return false;
  }

  static constexpr double kFar_m = 1e6;  // bound of a gap without an inner body

  const PartSurface& part_;
  Pose X_WP_;
  std::span<const Obstacle> obstacles_;
  PoseSet set_;
  std::size_t most_work_;
  double reach_m_ = 0;
  std::vector<Sample> samples_;
  std::size_t last_ = 0;  // the sample that proved a cell last
  PoseCover out_;
};

}  // namespace

PoseCover coverPoses(const PartSurface& part, const Pose& X_WP, std::span<const Obstacle> obstacles,
                     const PoseSet& set, std::size_t most_work) {
  const auto hasInside = [](const PartSurface& of) { return of.isClosed() && !of.solid().isSheet(); };
  if (!hasInside(part)) return {};
  for (const Obstacle& obstacle : obstacles)
    if (!hasInside(*obstacle.surface)) return {};
  return CoverSearch(part, X_WP, obstacles, set, most_work).search();
}

}  // namespace vps::scenes
