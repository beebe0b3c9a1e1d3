// SPDX-License-Identifier: BSD-3-Clause
#include "vps/edge_crossing.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/mesh_edges.h"
#include "mesh/normals.h"
#include "query/features/curved_features.h"
#include "query/features/feature_pair.h"
#include "query/motion/edge_pair_search.h"
#include "query/motion/motion_tube.h"
#include "vps/contact_tolerances.h"

namespace vps {

namespace {

struct Face {
  Vec3 normal, apex;
  bool is_good;
};

Face faceOf(const Mesh& mesh, const Pose& X_MP, const HalfEdge& e) {
  const auto& t = mesh.triangles[e.triangle];
  Vec3 corner[3];
  for (int k = 0; k < 3; ++k) corner[k] = X_MP * mesh.vertices[t[static_cast<std::size_t>(k)]];
  const Vec3 n = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  return {n.normalized(), corner[(e.side + 2) % 3], hasArea(corner[0], corner[1], corner[2])};
}

// Marks the ends of two edges as joined where exactly these two edges meet and one continues the other.
void joinEnds(std::vector<EdgeEnd>& ends, std::vector<EdgeSegment>& segments) {
  forEachJoint(ends, [&](const EdgeEnd& a, const EdgeEnd& b) {
    const double cos = -a.away.dot(b.away);
    if (!(cos > kCosSameFace)) return;
    const bool is_curved = cos > kCosCurved && a.away.cross(b.away).norm() > kSinFlat;
    for (const EdgeEnd* e : {&a, &b}) {
      segments[e->edge].ends[e->end] = false;
      segments[e->edge].is_curved[e->end] = is_curved;
    }
  });
}

}  // namespace

void appendEdges(const Mesh& mesh, const Pose& X_MP, std::uint16_t owner, std::vector<EdgeSegment>& out) {
  const std::size_t first = out.size();
  std::vector<EdgeEnd> ends;
  forEachEdge(sortedHalfEdges(mesh), [&](std::span<const HalfEdge> same) {
    if (same.size() != 2 || same[0].is_forward == same[1].is_forward) return;
    EdgeSegment s;
    s.from = X_MP * mesh.vertices[same[0].low];
    s.to = X_MP * mesh.vertices[same[0].high];
    const Face face[2] = {faceOf(mesh, X_MP, same[0]), faceOf(mesh, X_MP, same[1])};
    if (!face[0].is_good || !face[1].is_good || !(face[0].normal.dot(face[1].normal) < kCosSameFace)) return;
    const Vec3 along = (s.to - s.from).normalized();
    for (int i = 0; i < 2; ++i) {
      const Vec3 way = face[i].apex - s.from;
      s.into[i] = (way - along * along.dot(way)).normalized();
    }
    if (!(face[0].normal.dot(s.into[1]) < 0)) return;  // a groove
    // The normals of a blade, whose faces are back to back, cancel; the direction away from both faces is
    // still outward.
    const Vec3 mean = face[0].normal + face[1].normal;
    s.outward = mean.norm() > kNoDirection ? mean.normalized() : Vec3(-(s.into[0] + s.into[1]).normalized());
    s.owner = owner;
    ends.push_back({same[0].low, static_cast<std::uint32_t>(out.size()), 0, along});
    ends.push_back({same[0].high, static_cast<std::uint32_t>(out.size()), 1, -along});
    out.push_back(s);
  });
  if (out.size() > first) joinEnds(ends, out);
}

EdgeSet::EdgeSet(std::vector<EdgeSegment> segments) : segments_(std::move(segments)) {
  std::vector<EdgeTree::Line> lines;
  for (const EdgeSegment& s : segments_) lines.push_back({s.from, s.to});
  tree_ = EdgeTree(std::move(lines));
}

namespace {

/// Finds the pairs of segments that can cross and come within reach_m while the segments of set 1 move in a
/// tube.
class CrossingSearch {
 public:
  CrossingSearch(const EdgeSet& edges0, const EdgeSet& edges1, const MotionTube& tube, double reach_m)
      : edges0_(edges0),
        edges1_(edges1),
        X_01_{tube.from(), tube.to()},
        turn_rad_(tube.turn_rad()),
        reach_m_(reach_m + tube.margin_m()) {}

  /// Calls found(i0, i1) for each pair.
  template <typename Visit>
  void run(const Visit& found) const {
    EdgePairSearch(edges0_.tree(), edges1_.tree(), X_01_, turn_rad_, reach_m_, kSinLean)
        .run([&](std::uint32_t i0, std::uint32_t i1) {
          const EdgeSegment &s0 = edges0_.segments()[i0], &s1 = edges1_.segments()[i1];
          if (mayCross(s0, s1) && comeNear(s0, s1)) found(i0, i1);
        });
  }

 private:
  // False if CrossingTest would reject the segments at every pose of the tube. A turn by t moves unit
  // vectors and their product by up to t.
  [[nodiscard]] bool mayCross(const EdgeSegment& s0, const EdgeSegment& s1) const {
    const Vec3 d0 = (s0.to - s0.from).normalized(), d1 = X_01_.from.R * (s1.to - s1.from).normalized();
    const Vec3 n = d0.cross(d1);
    const double sine = n.norm();
    if (sine + turn_rad_ <= kSinLean) return false;
    const double lean = kSinLean * (sine + turn_rad_) + 2 * turn_rad_;  // times the sine
    const Vec3 into1[2] = {X_01_.from.R * s1.into[0], X_01_.from.R * s1.into[1]};
    const auto isOutside = [&](double sign) {
      for (int k = 0; k < 2; ++k)
        if (-sign * n.dot(s0.into[k]) > lean || sign * n.dot(into1[k]) > lean) return false;
      return true;
    };
    return isOutside(1) || isOutside(-1);
  }

  [[nodiscard]] bool comeNear(const EdgeSegment& s0, const EdgeSegment& s1) const {
    Features f;  // the moving features first
    f.a_count = f.b_count = 2;
    f.own[0] = s1.from;
    f.own[1] = s1.to;
    f.b[0] = s0.from;
    f.b[1] = s0.to;
    f.moveFrom(X_01_.from, X_01_.to);
    Approach reach;
    reach.nearest = nearestOf(FeatureContact::Kind::EdgeOnEdge, f.a, f.b);
    const double distance_m = reach.nearest.distance_m();
    return distance_m <= reach_m_ ||
           findApproach(FeatureContact::Kind::EdgeOnEdge, f, reach_m_, distance_m, reach);
  }

  const EdgeSet &edges0_, &edges1_;
  const Sweep X_01_;
  double turn_rad_, reach_m_;
};

// Greatest distance of segments that cross with this gap: both points may lie past an end.
double reachOfCrossing_m(double gap_m) {
  return gap_m + 2 * (kSamePlace_m + kTanPastEnd * gap_m);
}

/// Tests pairs of segments.
class CrossingTest {
 public:
  CrossingTest(const EdgeSet& edges0, const EdgeSet& edges1, const Pose& X_01, const CrossingRange& range,
               std::vector<EdgeCrossing>& out)
      : segments0_(edges0.segments()),
        segments1_(edges1.segments()),
        X_01_(X_01),
        X_01_end_(range.X_01_end),
        cutoff_m_(range.cutoff_m),
        depth_m_(range.depth_m),
        out_(out) {}

  void cross(std::uint32_t i0, std::uint32_t i1) {
    const EdgeSegment &s0 = segments0_[i0], &s1 = segments1_[i1];
    const Vec3 from1 = X_01_ * s1.from;
    const Vec3 way0 = s0.to - s0.from, way1 = X_01_.R * (s1.to - s1.from);
    const double length0_m = way0.norm(), length1_m = way1.norm();
    const Vec3 d0 = way0 / length0_m, d1 = way1 / length1_m;
    EdgeCrossing c;
    c.n = d0.cross(d1);
    const double sine = c.n.norm();
    if (!(sine > kSinLean)) return;
    c.n *= (c.n.dot(X_01_.R * s1.outward) < 0 ? -1 : 1) / sine;
    const Vec3 r = s0.from - from1;
    c.gap_m = c.n.dot(r);
    if (!(c.gap_m >= -depth_m_) || (c.gap_m > cutoff_m_ && c.gap_m > cutoff_m_ + nearer_m(c.n, s1))) return;
    // The nearest points of two lines [Ericson 2005, section 5.1.8].
    const double b = d0.dot(d1), x0 = d0.dot(r), x1 = d1.dot(r);
    const double at0_m = (b * x1 - x0) / (sine * sine), at1_m = (x1 - b * x0) / (sine * sine);
    const double joint_m = kSamePlace_m + kTanPastEnd * std::abs(c.gap_m);
    const double end_m = kSamePlace_m + (c.gap_m >= 0 ? kSinLean * c.gap_m : c.gap_m);
    const auto isOn = [&](const EdgeSegment& s, double at_m, double length_m) {
      return at_m >= -(s.ends[0] ? end_m : joint_m) && at_m <= length_m + (s.ends[1] ? end_m : joint_m);
    };
    if (!isOn(s0, at0_m, length0_m) || !isOn(s1, at1_m, length1_m)) return;
    for (int k = 0; k < 2; ++k)
      if (-c.n.dot(s0.into[k]) > kSinLean || c.n.dot(X_01_.R * s1.into[k]) > kSinLean) return;
    if (c.gap_m > cutoff_m_ && !meetsInStep(s0, s1, c.n)) return;
    c.edge[0] = i0;
    c.edge[1] = i1;
    c.p[0] = s0.from + at0_m * d0;
    c.p[1] = from1 + at1_m * d1;
    out_.push_back(c);
  }

 private:
  // How much nearer any point of a segment of set 1 comes in the step.
  [[nodiscard]] double nearer_m(const Vec3& n, const EdgeSegment& s1) const {
    const Vec3 from = X_01_ * s1.from, to = X_01_ * s1.to;
    return std::max({0.0, n.dot(X_01_end_ * s1.from - from), n.dot(X_01_end_ * s1.to - to)});
  }
  // True for edges that overlap or are near after the step; false for edges that have passed each other's
  // ends.
  [[nodiscard]] bool meetsInStep(const EdgeSegment& s0, const EdgeSegment& s1, const Vec3& n) const {
    const Nearest then = nearestPointsOfSegments(s0.from, s0.to, X_01_end_ * s1.from, X_01_end_ * s1.to);
    const bool is_between = then.end[0] == Nearest::kBetween && then.end[1] == Nearest::kBetween;
    return (is_between && n.dot(then.p - then.q) < 0) || then.distance_m() <= reachOfCrossing_m(cutoff_m_);
  }

  const std::vector<EdgeSegment>&segments0_, &segments1_;
  const Pose &X_01_, &X_01_end_;
  double cutoff_m_, depth_m_;
  std::vector<EdgeCrossing>& out_;
};

/// A ball around all edges of a set.
Ball ballOf(const EdgeSet& edges) {
  const EdgeTree::Node& root = edges.tree().nodes()[0];
  return {root.center, root.radius_m};
}

void sortByEdges(std::vector<EdgeCrossing>& out, std::ptrdiff_t first) {
  std::sort(out.begin() + first, out.end(), [](const EdgeCrossing& a, const EdgeCrossing& b) {
    return a.edge[0] != b.edge[0] ? a.edge[0] < b.edge[0] : a.edge[1] < b.edge[1];
  });
}

}  // namespace

CrossingMemory::CrossingMemory() : tube_(std::make_unique<MotionTube>()) {}
CrossingMemory::~CrossingMemory() = default;
CrossingMemory::CrossingMemory(CrossingMemory&&) noexcept = default;
CrossingMemory& CrossingMemory::operator=(CrossingMemory&&) noexcept = default;

void CrossingMemory::search(const EdgeSet& edges0, const EdgeSet& edges1, double reach_m) {
  near_.clear();
  CrossingSearch(edges0, edges1, *tube_, reach_m).run([&](std::uint32_t i0, std::uint32_t i1) {
    near_.push_back({{i0, i1}});
  });
  reach_m_ = reach_m;
  is_valid_ = true;
}

void CrossingMemory::find(const EdgeSet& edges0, const EdgeSet& edges1, const Pose& X_01,
                          const Pose& X_01_end, double reach_m) {
  constexpr double kMore = 1.2;  // assumed: the cutoff grows with the speed
  if (is_valid_ && reach_m <= reach_m_ && tube_->holds(X_01) && tube_->holds(X_01_end))
    return tube_->see(X_01);
  const Pose last = is_valid_ ? tube_->seen() : X_01;
  const auto searchWithin = [&](double width) {
    *tube_ = MotionTube::following(ballOf(edges0), ballOf(edges1), last, X_01, X_01_end, width);
    search(edges0, edges1, kMore * reach_m);
  };
  searchWithin(tube_->nextWidth(near_.size()));
  if (tube_->isTooWide(near_.size())) searchWithin(1);
}

void findCrossings(const EdgeSet& edges0, const EdgeSet& edges1, const Pose& X_01, const CrossingRange& range,
                   std::vector<EdgeCrossing>& out, CrossingMemory* memory) {
  if (edges0.segments().empty() || edges1.segments().empty()) return;
  const auto first = static_cast<std::ptrdiff_t>(out.size());
  // The range of crossings that are near now, or at the end of the step.
  const double reach_m = reachOfCrossing_m(std::max(range.cutoff_m, range.depth_m));
  CrossingTest test(edges0, edges1, X_01, range, out);
  if (memory == nullptr) {
    const MotionTube once(ballOf(edges0), ballOf(edges1), X_01, range.X_01_end);
    CrossingSearch(edges0, edges1, once, reach_m).run([&](std::uint32_t i0, std::uint32_t i1) {
      test.cross(i0, i1);
    });
  } else {
    memory->find(edges0, edges1, X_01, range.X_01_end, reach_m);
    for (const CrossingMemory::Pair& pair : memory->near_) test.cross(pair.edge[0], pair.edge[1]);
  }
  sortByEdges(out, first);
}

}  // namespace vps
