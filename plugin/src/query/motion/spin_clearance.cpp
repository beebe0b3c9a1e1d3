// SPDX-License-Identifier: BSD-3-Clause
#include "vps/spin_clearance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "vps/bounding_volume_hierarchy.h"

namespace vps {

namespace {

// The least distance of a triangle's projection along the axis from the axis; 0 if the triangle surrounds the
// axis.
double leastRadius_m(const Eigen::Vector2d (&corner)[3]) {
  const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  double least_m = corner[0].norm();
  int left = 0, right = 0;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector2d &a = corner[k], &b = corner[(k + 1) % 3], way = b - a;
    const double side = cross(a, b), length2 = way.squaredNorm();
    left += side > 0 ? 1 : 0;
    right += side < 0 ? 1 : 0;
    const double share = length2 > 0 ? std::clamp(-a.dot(way) / length2, 0.0, 1.0) : 0;
    least_m = std::min(least_m, (a + share * way).norm());
  }
  return left == 3 || right == 3 ? 0 : least_m;
}

// The region that each facet sweeps about an axis: ranges of the radius and of the height above the place on
// the axis, as boxes without extent in the third direction.
std::vector<Box> sweptAbout(const FeatureSet& part, const Vec3& p, const Vec3& along) {
  const Vec3 u = along.unitOrthogonal(), v = along.cross(u);
  std::vector<Box> swept;
  swept.reserve(part.facets().size());
  const auto sweep = [&](const std::array<std::uint32_t, 3>& triangle) {
    Eigen::Vector2d corner[3];
    Box box;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 r = part.vertices()[triangle[k]] - p;
      corner[k] = {u.dot(r), v.dot(r)};
      box.add(Vec3(corner[k].norm(), along.dot(r), 0));
    }
    box.min.x() = leastRadius_m(corner);
    swept.push_back(box);
  };
  for (const auto& facet : part.facets()) sweep(facet);
  // Facets without area are left out, but their edges are not.
  for (const FeatureEdge& edge : part.edges())
    if (!edge.has_faces) sweep({edge.from, edge.to, edge.to});
  return swept;
}

// True if boxes of both parts come nearer than distance_m, in radius and in height. The tree holds `others`.
bool comeNear(const std::vector<Box>& boxes, const std::vector<Box>& others, const BoxTree& tree,
              double distance_m) {
  return std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) {
    return !tree.forEachOverlap(others, grown(box, distance_m), [](std::uint32_t) { return false; });
  });
}

// A lower bound, to within a sixteenth, of the distance between the regions that two parts sweep; 0 below
// most_m / 1024.
double clearance_m(const std::vector<Box>& a, const std::vector<Box>& b, double most_m) {
  const BoxTree tree(b);
  double near_m = most_m;
  for (int k = 0; comeNear(a, b, tree, near_m); ++k) {
    if (k == 10) return 0;
    near_m *= 0.5;
  }
  double far_m = 2 * near_m;
  for (int k = 0; k < 4 && near_m < most_m; ++k) {
    const double middle_m = 0.5 * (near_m + far_m);
    (comeNear(a, b, tree, middle_m) ? far_m : near_m) = middle_m;
  }
  return near_m;
}

}  // namespace

// Upper bound of the distance of any point of the smaller part from its place with the axes in line, on the
// way between two poses of the smaller part in the larger one. A rotation by less than half a turn takes the
// axis no farther from its first direction than its last direction is.
double SpinClearance::deviation_m(const Pose& start, const Pose& end) const {
  const Vec3 from = start * smaller_.p, to = end * smaller_.p;
  const Vec3 before = start.R * smaller_.along, after = end.R * smaller_.along;
  return (from - larger_.p).norm() + (to - from).norm() +
         lever_m_ * ((before - larger_.along).norm() + (after - before).norm());
}

// Finds the axis of the screw motion that takes the smaller part from one pose in the larger one to another,
// and the clearance between the regions that both parts sweep about it.
void SpinClearance::search(const FeatureSet& smaller, const FeatureSet& larger, const Pose& start,
                           const Pose& end, const Vec3& turn) {
  constexpr double kOfRadius = 0.1;  // share of the radius; assumed: a greater clearance is not needed
  larger_.along = turn.normalized();
  const Vec3 from = start * smaller.box().center(), way = end * smaller.box().center() - from;
  const Vec3 across = way - larger_.along.dot(way) * larger_.along;
  larger_.p = from + 0.5 * across + larger_.along.cross(across) / (2 * std::tan(0.5 * turn.norm()));
  smaller_ = {start.inverse() * larger_.p, start.R.transpose() * larger_.along};
  lever_m_ = 0;
  for (const Vec3& v : smaller.vertices()) lever_m_ = std::max(lever_m_, (v - smaller_.p).norm());
  clearance_m_ = clearance_m(sweptAbout(smaller, smaller_.p, smaller_.along),
                             sweptAbout(larger, larger_.p, larger_.along), kOfRadius * smaller.radius_m());
}

bool SpinClearance::staysApart(const FeatureSet& part0, const FeatureSet& part1, const Pose& start,
                               const Pose& end, double least_m) {
  if (part0.isEmpty() || part1.isEmpty()) return false;
  const bool is_first = part0.radius_m() <= part1.radius_m();
  const Pose from = is_first ? start.inverse() : start, to = is_first ? end.inverse() : end;
  const auto isApart = [&](const SpinClearance& known) {
    return known.clearance_m_ > 0 && known.deviation_m(from, to) + least_m < known.clearance_m_;
  };
  if (isApart(*this)) return true;
  const Vec3 turn = rotationVector(to.R * from.R.transpose());
  if (!(turn.squaredNorm() > kLeast_rad * kLeast_rad) || ++waits_ < wait_) return false;
  waits_ = 0;
  SpinClearance found;  // a known axis is kept if the new one does not help
  found.search(is_first ? part0 : part1, is_first ? part1 : part0, from, to, turn);
  const bool helps = isApart(found);
  if (helps) *this = found;
  wait_ = helps ? kWait : std::min(2 * wait_, kMostWait);
  return helps;
}

}  // namespace vps
