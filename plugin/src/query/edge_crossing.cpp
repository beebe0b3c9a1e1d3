// SPDX-License-Identifier: BSD-3-Clause
#include "vps/edge_crossing.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "mesh/directions.h"
#include "mesh/mesh_edges.h"
#include "query/edge_joints.h"
#include "query/feature_angles.h"
#include "query/feature_points.h"
#include "query/motion_tube.h"
#include "query/moving_features.h"

namespace vps::inline v0 {

namespace {

constexpr double kMinSine = 0.087;  // 5 degrees: below it the crossing of lines is mostly rounding
/// How far the plane may lean into a face, as a sine: so an edge that passes from one edge of a fine polygon
/// to the next stays a crossing meanwhile. Assumed.
constexpr double kLean = 0.02;
/// How far beyond its end a segment still crosses, as a share of the gap: at the joints of a curved edge the
/// crossing falls between two segments, by the gap times the tangent of half their turn, of at most 20
/// degrees. At a true end, separating along the edge must not be shorter than separating across: the rim of a
/// square peg in a square hole has long passed the hole's rim.
constexpr double kPast_m = 1e-6, kPastShare = 0.18;
/// The same at a true end, before the edges touch. assumed.
constexpr double kEndShare = 0.1;

/// Of a coordinate, a radius and the square of a distance in floats, with room to spare: 2^-21.
constexpr double kFloatRounding = 4.8e-7;
/// Halves by count limit the depth to 32, with one waiting half on each level.
constexpr int kStack = 64;

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

// Two edges that meet in a line with no third are one edge.
void joinEnds(std::vector<EdgeEnd>& ends, std::vector<EdgeSegment>& segments) {
  forEachJoint(ends, [&](const EdgeEnd& a, const EdgeEnd& b) {
    const double cos = -a.away.dot(b.away);
    if (!(cos > kCosSharp)) return;
    const bool is_curved = cos > kCosCurved && a.away.cross(b.away).norm() > kFlat;
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
    if (!face[0].is_good || !face[1].is_good || !(face[0].normal.dot(face[1].normal) < kCosSharp)) return;
    const Vec3 along = (s.to - s.from).normalized();
    for (int i = 0; i < 2; ++i) {
      const Vec3 way = face[i].apex - s.from;
      s.into[i] = (way - along * along.dot(way)).normalized();
    }
    if (!(face[0].normal.dot(s.into[1]) < 0)) return;  // a groove
    // The normals of a blade with faces back to back cancel; the direction away from both faces is still
    // outward.
    const Vec3 mean = face[0].normal + face[1].normal;
    s.outward = mean.norm() > 1e-6 ? mean.normalized() : Vec3(-(s.into[0] + s.into[1]).normalized());
    s.owner = owner;
    ends.push_back({same[0].low, static_cast<std::uint32_t>(out.size()), 0, along});
    ends.push_back({same[0].high, static_cast<std::uint32_t>(out.size()), 1, -along});
    out.push_back(s);
  });
  if (out.size() > first) joinEnds(ends, out);
}

EdgeSet::EdgeSet(std::vector<EdgeSegment> segments) : segments_(std::move(segments)) {
  if (!segments_.empty()) build();
}

// The direction of a node's segments, and the line along it that they are near to.
void EdgeSet::bound(Node& node, std::span<const std::uint32_t> own) const {
  const auto along = [&](std::uint32_t i) {
    return Vec3((segments_[i].to - segments_[i].from).normalized());
  };
  Vec3 middle = Vec3::Zero();
  for (const std::uint32_t i : own) {
    const Vec3 d = along(i);
    node.along += node.along.dot(d) < 0 ? Vec3(-d) : d;
    middle += 0.5 / static_cast<double>(own.size()) * (segments_[i].from + segments_[i].to);
  }
  node.along.normalize();
  double first_m = 0, last_m = 0;
  for (const std::uint32_t i : own) {
    node.spread_rad = std::max(node.spread_rad, std::acos(std::min(1.0, std::abs(node.along.dot(along(i))))));
    for (const Vec3& end : {segments_[i].from, segments_[i].to}) {
      const double at_m = node.along.dot(end - middle);
      first_m = std::min(first_m, at_m);
      last_m = std::max(last_m, at_m);
      node.width_m = std::max(node.width_m, (end - middle - at_m * node.along).norm());
    }
  }
  node.from = middle + first_m * node.along;
  node.to = middle + last_m * node.along;
}

void EdgeSet::build() {
  struct Range {
    std::uint32_t node, first, count;
  };
  std::vector<std::uint32_t> order(segments_.size());
  std::iota(order.begin(), order.end(), 0u);
  nodes_.reserve(2 * segments_.size());
  nodes_.emplace_back();
  std::vector<Range> waiting{{0, 0, static_cast<std::uint32_t>(segments_.size())}};
  while (!waiting.empty()) {
    const Range range = waiting.back();
    waiting.pop_back();
    const std::span<std::uint32_t> own(order.data() + range.first, range.count);
    Box box;
    for (const std::uint32_t i : own) {
      box.add(segments_[i].from);
      box.add(segments_[i].to);
    }
    Node node;
    bound(node, own);
    node.center = box.center();
    for (const std::uint32_t i : own)
      node.radius_m = std::max(
          {node.radius_m, (segments_[i].from - node.center).norm(), (segments_[i].to - node.center).norm()});
    node.is_leaf = range.count == 1 ? 1 : 0;
    node.first = node.is_leaf != 0 ? own[0] : static_cast<std::uint32_t>(nodes_.size());
    nodes_[range.node] = node;
    if (node.is_leaf != 0) continue;
    int axis = 0;
    box.size().maxCoeff(&axis);
    const std::uint32_t half = range.count / 2;
    std::nth_element(own.begin(), own.begin() + half, own.end(), [&](std::uint32_t a, std::uint32_t b) {
      const double at_a = segments_[a].from[axis] + segments_[a].to[axis],
                   at_b = segments_[b].from[axis] + segments_[b].to[axis];
      return at_a != at_b ? at_a < at_b
                          : a < b;  // a strict order, so that the tree is the same with every library
    });
    nodes_.emplace_back();
    nodes_.emplace_back();
    waiting.push_back({node.first, range.first, half});
    waiting.push_back({node.first + 1, range.first + half, range.count - half});
  }
  for (const Node& node : nodes_) {
    const double rounding_m = kFloatRounding * (node.center.cwiseAbs().maxCoeff() + node.radius_m);
    balls_.push_back({node.center.cast<float>(), static_cast<float>(node.radius_m + rounding_m), node.first,
                      node.is_leaf});
  }
}

bool EdgeSet::isNear(std::uint32_t segment, const Vec3& p, double radius_m) const noexcept {
  const EdgeSegment& s = segments_[segment];
  const Vec3 way = s.to - s.from;
  const double share = std::clamp((p - s.from).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (p - s.from - share * way).norm() <= radius_m;
}

bool EdgeSet::isAnyNear(const Vec3& p, double radius_m) const noexcept {
  if (balls_.empty()) return false;
  const Eigen::Vector3f at = p.cast<float>();
  const auto reach_m =
      static_cast<float>(radius_m + kFloatRounding * (p.cwiseAbs().maxCoeff() + std::abs(radius_m)));
  std::uint32_t stack[kStack];
  int waiting = 0;
  stack[waiting++] = 0;
  while (waiting > 0) {
    const Ball& ball = balls_[stack[--waiting]];
    const float within_m = ball.radius_m + reach_m;
    if ((at - ball.center).squaredNorm() > within_m * within_m) continue;
    if (ball.is_leaf == 0) {
      stack[waiting++] = ball.first + 1;
      stack[waiting++] = ball.first;
    } else if (isNear(ball.first, p, radius_m)) {
      return true;
    }
  }
  return false;
}

/// Descends both hierarchies at once; calls visit(i0, i1) for each pair of segments that can cross and come
/// within reach_m while those of set 1 move in a tube.
class EdgePairSearch {
 public:
  EdgePairSearch(const EdgeSet& edges0, const EdgeSet& edges1, const MotionTube& tube, double reach_m)
      : edges0_(edges0),
        edges1_(edges1),
        from_01_(tube.from()),
        to_01_(tube.to()),
        turn_rad_(tube.turn_rad()),
        reach_m_(reach_m + tube.margin_m()) {}

  template <typename Visit>
  void run(const Visit& found) const {
    if (edges0_.nodes_.empty() || edges1_.nodes_.empty()) return;
    Placed root = place(edges1_.nodes_[0]);
    visit(edges0_.nodes_[0], root, found);
  }

 private:
  using Node = EdgeSet::Node;

  /// A node of set 1 in the frame of set 0.
  struct Placed {
    const Node& node;
    Vec3 center, way;  ///< of the sphere's centre
    double way2_m2;
    // Computed when first needed: most nodes are far away.
    bool has_line = false;
    Vec3 from, to;       ///< of the line, at the start
    double reach_m = 0;  ///< how far from it any place comes, and what counts as near
  };
  [[nodiscard]] Placed place(const Node& b) const {
    Placed at{b, from_01_ * b.center, Vec3(), 0, false, Vec3(), Vec3(), 0};
    at.way = to_01_ * b.center - at.center;
    at.way2_m2 = at.way.squaredNorm();
    return at;
  }

  // Depth: both trees halve by count, so at most some 2 x 32 deep.
  template <typename Visit>
  void visit(const Node& a, Placed& at, const Visit& found) const {
    const Node& b = at.node;
    if (!spheresComeNear(a, at) || areParallel(a, b) || !linesComeNear(a, at)) return;
    if (a.is_leaf != 0 && b.is_leaf != 0) {
      const EdgeSegment &s0 = edges0_.segments_[a.first], &s1 = edges1_.segments_[b.first];
      if (mayCross(s0, s1) && comeNear(s0, s1)) found(a.first, b.first);
    } else if (b.is_leaf != 0 || (a.is_leaf == 0 && a.radius_m >= b.radius_m)) {
      for (std::uint32_t i = 0; i < 2; ++i) visit(edges0_.nodes_[a.first + i], at, found);
    } else {
      for (std::uint32_t i = 0; i < 2; ++i) {
        Placed child = place(edges1_.nodes_[b.first + i]);
        visit(a, child, found);
      }
    }
  }

  [[nodiscard]] bool spheresComeNear(const Node& a, const Placed& at) const {
    const Vec3 off = a.center - at.center;
    const double share = at.way2_m2 > 0 ? std::clamp(off.dot(at.way) / at.way2_m2, 0.0, 1.0) : 0;
    const double near_m = a.radius_m + at.node.radius_m + reach_m_;
    return (off - share * at.way).squaredNorm() <= near_m * near_m;
  }
  // The sphere of a long segment, or of an arc, contains much space that is far from it.
  [[nodiscard]] bool linesComeNear(const Node& a, Placed& at) const {
    const Node& b = at.node;
    constexpr double kThin = 0.5;  // assumed; wider nodes are hardly ever told apart so
    if (a.width_m + b.width_m + reach_m_ > kThin * (a.radius_m + b.radius_m + reach_m_)) return true;
    if (!at.has_line) {
      at.has_line = true;
      at.from = at.center + from_01_.R * (b.from - b.center);
      at.to = at.center + from_01_.R * (b.to - b.center);
      // No place moves farther than the centre, and by the turn around it.
      at.reach_m = std::sqrt(at.way2_m2) + turn_rad_ * b.radius_m + b.width_m + reach_m_;
    }
    const double near_m = a.width_m + at.reach_m;
    const Nearest nearest = nearestOfSegments(a.from, a.to, at.from, at.to);
    return (nearest.p - nearest.q).squaredNorm() <= near_m * near_m;
  }

  // True if no two of the nodes' segments are far enough from parallel at any pose of the tube: as for two
  // segments in mayCross(), since the sine of a sum is at most the sine of one angle plus the others.
  [[nodiscard]] bool areParallel(const Node& a, const Node& b) const {
    const double least = kMinSine - turn_rad_ - a.spread_rad - b.spread_rad;
    return least > 0 && a.along.cross(from_01_.R * b.along).squaredNorm() <= least * least;
  }

  // False if no pose of the tube turns the segments so that CrossingTest takes them for a crossing. A turn by
  // t moves unit vectors and their product by up to t.
  [[nodiscard]] bool mayCross(const EdgeSegment& s0, const EdgeSegment& s1) const {
    const Vec3 d0 = (s0.to - s0.from).normalized(), d1 = from_01_.R * (s1.to - s1.from).normalized();
    const Vec3 n = d0.cross(d1);
    const double sine = n.norm();
    if (sine + turn_rad_ <= kMinSine) return false;
    const double lean = kLean * (sine + turn_rad_) + 2 * turn_rad_;  // times the sine
    const Vec3 into1[2] = {from_01_.R * s1.into[0], from_01_.R * s1.into[1]};
    const auto isOutside = [&](double sign) {
      for (int k = 0; k < 2; ++k)
        if (-sign * n.dot(s0.into[k]) > lean || sign * n.dot(into1[k]) > lean) return false;
      return true;
    };
    return isOutside(1) || isOutside(-1);
  }

  [[nodiscard]] bool comeNear(const EdgeSegment& s0, const EdgeSegment& s1) const {
    Features f;  // the moving ones first
    f.a_count = f.b_count = 2;
    f.own[0] = s1.from;
    f.own[1] = s1.to;
    f.b[0] = s0.from;
    f.b[1] = s0.to;
    f.moveFrom(from_01_, to_01_);
    Reach reach;
    reach.nearest = nearestOf(FeatureContact::Kind::EdgeOnEdge, f.a, f.b);
    const double distance_m = reach.nearest.distance_m();
    return distance_m <= reach_m_ ||
           findReach(FeatureContact::Kind::EdgeOnEdge, f, reach_m_, distance_m, reach);
  }

  const EdgeSet &edges0_, &edges1_;
  const Pose &from_01_, &to_01_;
  double turn_rad_, reach_m_;
};

namespace {

// Segments that cross with this gap are within this distance of each other: both points may lie past an end.
double reachOfCrossing_m(double gap_m) {
  return gap_m + 2 * (kPast_m + kPastShare * gap_m);
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
    if (!(sine > kMinSine)) return;
    c.n *= (c.n.dot(X_01_.R * s1.outward) < 0 ? -1 : 1) / sine;
    const Vec3 r = s0.from - from1;
    c.gap_m = c.n.dot(r);
    if (!(c.gap_m >= -depth_m_) || (c.gap_m > cutoff_m_ && c.gap_m > cutoff_m_ + nearer_m(c.n, s1))) return;
    // The nearest points of two lines [Ericson 2005, section 5.1.8].
    const double b = d0.dot(d1), x0 = d0.dot(r), x1 = d1.dot(r);
    const double at0_m = (b * x1 - x0) / (sine * sine), at1_m = (x1 - b * x0) / (sine * sine);
    const double joint_m = kPast_m + kPastShare * std::abs(c.gap_m);
    const double end_m = kPast_m + (c.gap_m >= 0 ? kEndShare * c.gap_m : c.gap_m);
    const auto isOn = [&](const EdgeSegment& s, double at_m, double length_m) {
      return at_m >= -(s.ends[0] ? end_m : joint_m) && at_m <= length_m + (s.ends[1] ? end_m : joint_m);
    };
    if (!isOn(s0, at0_m, length0_m) || !isOn(s1, at1_m, length1_m)) return;
    for (int k = 0; k < 2; ++k)
      if (-c.n.dot(s0.into[k]) > kLean || c.n.dot(X_01_.R * s1.into[k]) > kLean) return;
    if (c.gap_m > cutoff_m_ && !meetsInStep(s0, s1, c.n)) return;
    c.edge[0] = i0;
    c.edge[1] = i1;
    c.p[0] = s0.from + at0_m * d0;
    c.p[1] = from1 + at1_m * d1;
    out_.push_back(c);
  }

 private:
  // How far any place of a segment of set 1 comes nearer in the step.
  [[nodiscard]] double nearer_m(const Vec3& n, const EdgeSegment& s1) const {
    const Vec3 from = X_01_ * s1.from, to = X_01_ * s1.to;
    return std::max({0.0, n.dot(X_01_end_ * s1.from - from), n.dot(X_01_end_ * s1.to - to)});
  }
  // True for edges that overlap then, or are near: not for those that have passed each other's ends.
  [[nodiscard]] bool meetsInStep(const EdgeSegment& s0, const EdgeSegment& s1, const Vec3& n) const {
    const Nearest then = nearestOfSegments(s0.from, s0.to, X_01_end_ * s1.from, X_01_end_ * s1.to);
    const bool is_between = then.end[0] == Nearest::kBetween && then.end[1] == Nearest::kBetween;
    return (is_between && n.dot(then.p - then.q) < 0) || then.distance_m() <= reachOfCrossing_m(cutoff_m_);
  }

  const std::vector<EdgeSegment>&segments0_, &segments1_;
  const Pose &X_01_, &X_01_end_;
  double cutoff_m_, depth_m_;
  std::vector<EdgeCrossing>& out_;
};

/// Around all edges of a set.
template <typename Node>
Ball ballOf(const Node& root) {
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
  EdgePairSearch(edges0, edges1, *tube_, reach_m).run([&](std::uint32_t i0, std::uint32_t i1) {
    near_.push_back({{i0, i1}});
  });
  reach_m_ = reach_m;
  is_valid_ = true;
}

void CrossingMemory::find(const EdgeSet& edges0, const EdgeSet& edges1, const Pose& X_01,
                          const Pose& X_01_end, double reach_m) {
  constexpr double kMore = 1.2;  // assumed: the cutoff follows the speed
  if (is_valid_ && reach_m <= reach_m_ && tube_->holds(X_01) && tube_->holds(X_01_end))
    return tube_->see(X_01);
  const Pose last = is_valid_ ? tube_->seen() : X_01;
  const auto searchWithin = [&](double width) {
    *tube_ = MotionTube::following(ballOf(edges0.nodes_[0]), ballOf(edges1.nodes_[0]), last, X_01, X_01_end,
                                   width);
    search(edges0, edges1, kMore * reach_m);
  };
  searchWithin(tube_->nextWidth(near_.size()));
  if (tube_->isTooWide(near_.size())) searchWithin(1);
}

void findCrossings(const EdgeSet& edges0, const EdgeSet& edges1, const Pose& X_01, const CrossingRange& range,
                   std::vector<EdgeCrossing>& out, CrossingMemory* memory) {
  if (edges0.segments().empty() || edges1.segments().empty()) return;
  const auto first = static_cast<std::ptrdiff_t>(out.size());
  // Near now, or at the end of the step.
  const double reach_m = reachOfCrossing_m(std::max(range.cutoff_m, range.depth_m));
  CrossingTest test(edges0, edges1, X_01, range, out);
  if (memory == nullptr) {
    const MotionTube once(ballOf(edges0.nodes_[0]), ballOf(edges1.nodes_[0]), X_01, range.X_01_end);
    EdgePairSearch(edges0, edges1, once, reach_m).run([&](std::uint32_t i0, std::uint32_t i1) {
      test.cross(i0, i1);
    });
  } else {
    memory->find(edges0, edges1, X_01, range.X_01_end, reach_m);
    for (const CrossingMemory::Pair& pair : memory->near_) test.cross(pair.edge[0], pair.edge[1]);
  }
  sortByEdges(out, first);
}

}  // namespace vps::inline v0
