// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/selection/contact_selection.h"

#include <algorithm>
#include <optional>

#include "narrowphase/refinement/curved_contact.h"
#include "narrowphase/refinement/surface_view.h"
#include "native_shapes/native_shape.h"
#include "native_shapes/native_shape_adapter.h"
#include "vps/contact_tolerances.h"

namespace vps::bullet {

namespace {

/// The shell of one side, and the distances of its points from the other side's surface.
class FarSide {
 public:
  FarSide(const PairView& pair, int i)
      : side_(pair.side(i)), other_(pair.side(1 - i)), X_NM_(other_.X_WM.inverse() * side_.X_WM) {
    const btCollisionShape& theirs = *pair.wrapper[1 - i]->getCollisionShape();
    if (isPrimitive(theirs))
      primitive_ = &unwrapped(theirs);
    else
      view_.emplace(side_, other_);
  }
  FarSide(const FarSide&) = delete;  // the view refers to both sides

  [[nodiscard]] const PointShell& shell() const { return *side_.shape->models().shell; }

  /// Lower bound of the distances of all points in a block; at least most_m if all are farther than most_m.
  [[nodiscard]] double leastOf(const ShellBlock& block, double most_m) {
    const Vec3 center(block.center[0], block.center[1], block.center[2]);
    const double center_m = primitive_ ? primitiveDistance(*primitive_, X_NM_ * center).distance_m
                                       : view_->leastDistance(center, most_m + block.radius_m);
    return center_m - block.radius_m;
  }

  /// Distance of one point; a value greater than most_m if the point is farther than most_m.
  [[nodiscard]] double at(std::uint32_t id, double most_m) const {
    const Vec3& p = shell().points[id];
    return primitive_ ? primitiveDistance(*primitive_, X_NM_ * p).distance_m
                      : view_->at(p, shell().inward[id], most_m).distance_m;
  }

 private:
  SideView side_, other_;
  Pose X_NM_;
  const btCollisionShape* primitive_ = nullptr;
  std::optional<SurfaceView> view_;
};

bool isMeasured(const PairView& pair, int i, const Settings& settings) {
  if (!queriesPoints(pair, i, settings.sides) || pair.shape[i]->models().shell->blocks.empty()) return false;
  return isPrimitive(*pair.wrapper[1 - i]->getCollisionShape()) ||
         (pair.shape[1 - i] && !pair.shape[1 - i]->models().surfaces.empty());
}

struct Waiting {
  double least_m;
  std::uint32_t block;
  int side;
  // std::push_heap() puts the greatest on top.
  bool operator<(const Waiting& other) const { return least_m > other.least_m; }
};

/// The least distance between a point of one body and the surface of the other, by branch and bound over the
/// spheres around the points, nearest first. Returns no value if the distance is greater than most_m.
std::optional<double> leastDistance(const PairView& pair, double most_m, Context& context) {
  std::optional<FarSide> sides[2];
  std::vector<Waiting> waiting;
  const auto visitLater = [&](int i, std::uint32_t block) {
    const double least_m = sides[i]->leastOf(sides[i]->shell().blocks[block], most_m);
    if (least_m > most_m) return;
    waiting.push_back({least_m, block, i});
    std::push_heap(waiting.begin(), waiting.end());
  };
  for (int i = 0; i < 2; ++i) {
    if (!isMeasured(pair, i, context.settings)) continue;
    sides[i].emplace(pair, i);
    visitLater(i, static_cast<std::uint32_t>(sides[i]->shell().blocks.size() - 1));
  }
  std::optional<double> least_m;
  std::size_t tested = 0;
  while (!waiting.empty() && waiting.front().least_m <= most_m) {
    const Waiting next = waiting.front();
    std::pop_heap(waiting.begin(), waiting.end());
    waiting.pop_back();
    const ShellBlock& block = sides[next.side]->shell().blocks[next.block];
    for (std::uint32_t k = block.first; k < block.first + block.count; ++k) {
      if (block.is_leaf == 0) {
        visitLater(next.side, k);
        continue;
      }
      ++tested;
      if (const double distance_m = sides[next.side]->at(k, most_m); distance_m <= most_m)
        least_m = most_m = distance_m;
    }
  }
  context.points_tested += tested;
  return least_m;
}

void findWithin(const PairView& pair, double distance_m, Context& context, std::vector<Candidate>& out) {
  std::size_t tested = 0;
  for (int i = 0; i < 2; ++i) {
    if (!isMeasured(pair, i, context.settings)) continue;
    const btCollisionShape& theirs = *pair.wrapper[1 - i]->getCollisionShape();
    if (isPrimitive(theirs))
      findPrimitiveCandidates(pair.side(i), theirs, pair.X_WS[1 - i], distance_m, context.settings, out,
                              tested);
    else
      findSurfaceCandidates(pair.side(i), pair.side(1 - i), distance_m, context.settings, out, tested);
  }
  context.points_tested += tested;
}

// Points that are farther than the nearest one by no more than this are reported too, so that a face that
// lies opposite a face gets several points.
double beyond_m(const PairView& pair) {
  double spacing_m = 0;
  for (const Shape* shape : pair.shape)
    if (shape && shape->models().shell) spacing_m = std::max(spacing_m, shape->models().shell->spacing_m);
  return kBeyondShare * spacing_m + kRounding_m;
}

/// Moves the points of a candidate to the nearest places of both surfaces: each point in turn moves to the
/// place nearest to the other point.
Candidate polished(Candidate c, const PairView& pair) {
  const int i = c.side, j = 1 - i;
  if (!pair.shape[i] || !pair.shape[j] || isPrimitive(*pair.wrapper[j]->getCollisionShape())) return c;
  const double sign = i == 0 ? 1 : -1;
  for (int k = 0; k < kMostIterations && c.distance_m > kRounding_m; ++k) {
    const double before_m = c.distance_m;
    const Vec3 q_W = c.p_W - sign * c.distance_m * c.n_W;
    moveToClosest(c, pair.side(i), c.p_W - q_W);
    Candidate foot = c;
    foot.p_W = q_W;
    foot.side = static_cast<std::uint8_t>(j);
    moveToClosest(foot, pair.side(j), q_W - c.p_W);
    c.distance_m = foot.distance_m;
    c.n_W = foot.n_W;
    if (before_m - c.distance_m < kRoundingShare * before_m) break;
  }
  return c;
}

bool isNearer(const Candidate& a, const Candidate& b) {
  return a.distance_m < b.distance_m;
}

}  // namespace

std::vector<Candidate> nearestFarPoints(const PairView& pair, double wanted_m, Context& context) {
  std::vector<Candidate> points;
  const std::optional<double> least_m = leastDistance(pair, wanted_m, context);
  if (!least_m) return points;
  RelativeMotion still;
  still.contact_margin_m = std::min(wanted_m, *least_m + beyond_m(pair));
  findWithin(pair, still.contact_margin_m, context, points);
  dropUnreachable(still, points);
  if (points.empty()) return points;
  // Far points are not refined as contacts are: the distance from a curved face's plane is not the distance
  // from the face if the point is far away.
  const auto limit = static_cast<std::size_t>(context.settings.contact_limit);
  const double radius_m = pair.radius_m();
  const Pose X_GW = pair.X_WS[1].inverse();
  reduceByCell(points, 4 * limit, radius_m / 16, radius_m, X_GW);
  reduceBySpread(points, limit, radius_m, still.contact_margin_m, X_GW.R);
  Candidate& first = *std::min_element(points.begin(), points.end(), isNearer);
  first = polished(first, pair);
  return points;
}

}  // namespace vps::bullet
