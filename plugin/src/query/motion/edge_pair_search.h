// SPDX-License-Identifier: BSD-3-Clause
// Finds the edges of two parts that come near each other during a motion.
#pragma once

#include <algorithm>
#include <cmath>

#include "query/features/feature_pair.h"
#include "vps/edge_tree.h"

namespace vps {

/// Two poses of a part in another. The part's points move on straight lines from the first pose to the
/// second.
struct Sweep {
  Pose from, to;
};

/// Descends the trees of two parts at once. The edges of part 1 move, and turn by at most turn_rad from their
/// first pose.
class EdgePairSearch {
 public:
  /// @param reach_m  distance below which edges count as near
  /// @param least_sine  pairs whose directions differ by less than this at every pose are left out; 0: no
  /// pair is left out
  EdgePairSearch(const EdgeTree& edges0, const EdgeTree& edges1, const Sweep& X_01, double turn_rad,
                 double reach_m, double least_sine = 0)
      : edges0_(edges0),
        edges1_(edges1),
        X_(X_01),
        turn_rad_(turn_rad),
        reach_m_(reach_m),
        least_sine_(least_sine) {}

  /// Calls found(i0, i1) for each pair that may be near, in a fixed order: all near pairs, and some more.
  /// Cost: about 50 ns for each pair of nodes that is tested.
  template <typename Visit>
  void run(const Visit& found) const {
    if (edges0_.nodes().empty() || edges1_.nodes().empty()) return;
    Placed root = place(edges1_.nodes()[0]);
    visit(edges0_.nodes()[0], root, found);
  }

 private:
  using Node = EdgeTree::Node;

  /// A node of part 1 in the frame of part 0.
  struct Placed {
    const Node& node;
    Vec3 center, way;  ///< start and displacement of the sphere's centre
    double way2_m2;
    // The members below are computed when first needed, since most nodes are far away.
    bool has_line = false;
    Vec3 from, to;  ///< ends of the line, at the start
    double reach_m =
        0;  ///< greatest distance of an edge from the line during the motion, plus the search's reach
  };
  [[nodiscard]] Placed place(const Node& b) const {
    Placed at{b, X_.from * b.center, Vec3(), 0, false, Vec3(), Vec3(), 0};
    at.way = X_.to * b.center - at.center;
    at.way2_m2 = at.way.squaredNorm();
    return at;
  }

  // Recursion depth: both trees halve by count, so at most about 2 x 32.
  template <typename Visit>
  void visit(const Node& a, Placed& at, const Visit& found) const {
    const Node& b = at.node;
    if (!spheresComeNear(a, at) || areParallel(a, b) || !linesComeNear(a, at)) return;
    if (a.isLeaf() && b.isLeaf()) {
      found(edges0_.edge(a), edges1_.edge(b));
    } else if (b.isLeaf() || (!a.isLeaf() && a.radius_m >= b.radius_m)) {
      for (const Node* child : edges0_.children(a)) visit(*child, at, found);
    } else {
      for (const Node* child : edges1_.children(b)) {
        Placed placed = place(*child);
        visit(a, placed, found);
      }
    }
  }

  [[nodiscard]] bool spheresComeNear(const Node& a, const Placed& at) const {
    const Vec3 off = a.center - at.center;
    const double share = at.way2_m2 > 0 ? std::clamp(off.dot(at.way) / at.way2_m2, 0.0, 1.0) : 0;
    const double near_m = a.radius_m + at.node.radius_m + reach_m_;
    return (off - share * at.way).squaredNorm() <= near_m * near_m;
  }
  // Tested because the sphere of a long edge, or of an arc, contains much space that is far from the edge.
  [[nodiscard]] bool linesComeNear(const Node& a, Placed& at) const {
    const Node& b = at.node;
    constexpr double kThin = 0.5;  // assumed; this test hardly ever separates wider nodes
    if (a.width_m + b.width_m + reach_m_ > kThin * (a.radius_m + b.radius_m + reach_m_)) return true;
    if (!at.has_line) {
      at.has_line = true;
      at.from = at.center + X_.from.R * (b.from - b.center);
      at.to = at.center + X_.from.R * (b.to - b.center);
      // No point moves farther than the centre's path plus the point's own rotation about the centre.
      at.reach_m = std::sqrt(at.way2_m2) + turn_rad_ * b.radius_m + b.width_m + reach_m_;
    }
    const double near_m = a.width_m + at.reach_m;
    const Nearest nearest = nearestPointsOfSegments(a.from, a.to, at.from, at.to);
    return (nearest.p - nearest.q).squaredNorm() <= near_m * near_m;
  }

  // True if all pairs of the nodes' edges are left out: the sine of a sum of angles is at most the sine of
  // one plus the others.
  [[nodiscard]] bool areParallel(const Node& a, const Node& b) const {
    const double least = least_sine_ - turn_rad_ - a.spread_rad - b.spread_rad;
    return least > 0 && a.along.cross(X_.from.R * b.along).squaredNorm() <= least * least;
  }

  const EdgeTree &edges0_, &edges1_;
  const Sweep& X_;
  double turn_rad_, reach_m_, least_sine_;
};

}  // namespace vps
