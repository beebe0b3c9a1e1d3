// SPDX-License-Identifier: BSD-3-Clause
#include "query/features/touch_search.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "query/features/direction_cone.h"
#include "vps/contact_tolerances.h"
#include "vps/feature_set.h"

namespace vps {

namespace {

const double kFlush_rad = std::acos(kCosSameFace);

/// The straight path of a point, in the frame of the facets.
struct Track {
  Vec3 from, to;

  Track(const Sweep& X, const Vec3& p) : from(X.from * p), to(X.to * p) {}
};

/// A node of the corners, in the frame of the facets.
struct Placed {
  Track center;
  Vec3 half;  ///< half size of a box around the corners at each point of the track
  Vec3 touch, faces[2];

  // A lower bound of the squared distance from a box during the motion; exact for a place that does not move.
  [[nodiscard]] double leastSquaredDistance(const Box& box) const {
    const Vec3 above = center.from.cwiseMin(center.to) - half - box.max,
               below = box.min - half - center.from.cwiseMax(center.to);
    return above.cwiseMax(below).cwiseMax(0.0).squaredNorm();
  }
  // True if the corners stay farther than margin_m from a slab along n.
  [[nodiscard]] bool isBeside(const Vec3& n, double low_m, double high_m, double radius_m,
                              double margin_m) const {
    const double a_m = n.dot(center.from), b_m = n.dot(center.to);
    const double reach_m = std::min(radius_m, n.cwiseAbs().dot(half)) + margin_m;
    return std::min(a_m, b_m) > high_m + reach_m || std::max(a_m, b_m) < low_m - reach_m;
  }
};

class TouchSearch {
 public:
  TouchSearch(const FeatureSet& with_corners, const FeatureSet& with_facets, const Sweep& X_fc,
              double margin_m, double slack_rad, std::vector<TouchPair>& found)
      : corners_of_(with_corners),
        facets_of_(with_facets),
        corners_(with_corners.cornerTree()),
        facets_(with_facets.facetTree()),
        X_(X_fc),
        margin_m_(margin_m),
        slack_rad_(slack_rad),
        surely_flush_(slack_rad < kFlush_rad ? -std::cos(kFlush_rad - slack_rad) : -2),
        found_(found) {}

  void run() {
    if (corners_.tree.nodes.empty() || facets_.tree.nodes.empty()) return;
    thread_local std::vector<std::uint32_t> list;
    list.assign(1, 0);
    visit(0, list, 0);
  }

 private:
  // Visits a node of corners. The nodes of facets that its corners may touch are in the list from `first` on,
  // or within these nodes. Appends the remaining nodes for the corners' children, and removes them again.
  void visit(std::uint32_t c, std::vector<std::uint32_t>& list, std::size_t first) {
    const CornerTree::Bounds& corner = corners_.bounds[c];
    const HierarchyNode& node = corners_.tree.nodes[c];
    const Mat3& R = X_.from.R;
    // Corners that move straight between two poses stay in the box that contains them at both.
    const Placed at{Track(X_, corner.center),
                    (R.cwiseAbs() * corner.half).cwiseMax(X_.to.R.cwiseAbs() * corner.half),
                    R * corner.touch.axis,
                    {R * corner.faces[0].axis, R * corner.faces[1].axis}};
    const std::size_t end = list.size();
    for (std::size_t i = first; i < end; ++i) descend(corner, at, node.isLeaf(), list[i], list);
    if (node.isLeaf()) {
      if (list.size() > end) addPairs(corners_.tree.order[node.first], std::span(list).subspan(end));
    } else if (list.size() > end) {
      visit(c + 1, list, end);
      visit(node.right, list, end);
    }
    list.resize(end);
  }

  // Appends the nodes within f that the corners may touch: leaves, or for several corners nodes as large as
  // theirs. The size of a node of facets is that of their centres: otherwise long facets beside each other,
  // as in a bore, would all be listed for each node of corners that is smaller than the facets' length.
  void descend(const CornerTree::Bounds& corner, const Placed& at, bool is_leaf, std::uint32_t f,
               std::vector<std::uint32_t>& list) const {
    const FacetTree::Bounds& facet = facets_.bounds[f];
    if (!canTouch(corner, at, facet)) return;
    const HierarchyNode& node = facets_.tree.nodes[f];
    if (node.isLeaf() || (!is_leaf && facet.spread_m <= 2 * corner.radius_m)) {
      list.push_back(f);
    } else {
      descend(corner, at, is_leaf, f + 1, list);
      descend(corner, at, is_leaf, node.right, list);
    }
  }

  [[nodiscard]] bool canTouch(const CornerTree::Bounds& corner, const Placed& at,
                              const FacetTree::Bounds& facet) const {
    if (!(at.leastSquaredDistance(facet.box) <= margin_m_ * margin_m_)) return false;
    if (at.isBeside(facet.normals.axis, facet.low_m, facet.high_m, corner.radius_m, margin_m_)) return false;
    if (areApart(corner.touch, at.touch, facet.normals, slack_rad_)) return false;
    if (!facet.is_curved) return true;
    for (const int k : {0, 1})
      if (areOpposite(corner.faces[k], at.faces[k], facet.normals, kFlush_rad - slack_rad_)) return false;
    return true;
  }

  void addPairs(std::uint32_t corner, std::span<const std::uint32_t> leaves) {
    surround(corner);
    for (const std::uint32_t leaf : leaves) {
      const std::uint32_t facet = facets_.tree.order[facets_.tree.nodes[leaf].first];
      if (canTouch(facet)) found_.push_back({corner, facet});
    }
  }

  void surround(std::uint32_t corner) {
    rays_.clear();
    for (const Vec3& ray : corners_of_.raysAt(corner)) rays_.push_back(X_.from.R * ray);
    faces_.clear();
    for (const std::uint32_t edge : corners_of_.edgesAt(corner))
      for (const Vec3& n : corners_of_.edges()[edge].normal) faces_.push_back(X_.from.R * n);
  }

  [[nodiscard]] bool canTouch(std::uint32_t facet) const {
    const Vec3& n = facets_of_.normal(facet);
    if (!facets_of_.isTwoSided(facet) && !risesFrom(rays_, n, kSinTouch + slack_rad_)) return false;
    return !facets_of_.isCurved(facet) || std::none_of(faces_.begin(), faces_.end(), [&](const Vec3& own) {
      return own.dot(n) < surely_flush_;
    });
  }

  const FeatureSet &corners_of_, &facets_of_;
  const CornerTree& corners_;
  const FacetTree& facets_;
  const Sweep& X_;
  double margin_m_, slack_rad_, surely_flush_;
  std::vector<TouchPair>& found_;
  // Directions around a corner, in the frame of the facets.
  std::vector<Vec3> rays_, faces_;
};

}  // namespace

void findTouchPairs(const FeatureSet& with_corners, const FeatureSet& with_facets, const Sweep& X_fc,
                    double margin_m, double slack_rad, std::vector<TouchPair>& found) {
  found.clear();
  TouchSearch(with_corners, with_facets, X_fc, margin_m, slack_rad, found).run();
}

}  // namespace vps
