// SPDX-License-Identifier: BSD-3-Clause
#include "pair/pair_measures.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "surface/surface_piece.h"
#include "vps/stoppable.h"

namespace vps::scenes {

namespace {

/// Work of a query for the nearest point, in units of visited nodes.
constexpr std::size_t kQueryWork = 200;
/// Limit of the work of one search: half a second, or some seconds where many facets are equally far.
constexpr std::size_t kMostWork = 60'000'000;
/// Directions count as equal if their cosine is greater than this (6 degrees).
constexpr double kOneWay = 0.995;

/// Depths that differ by less count as equal; the first one found is kept.
constexpr double kSame_m = 1e-9;

/// The state of a search, which all surfaces share.
struct Search {
  OverlapDepth best;
  double certain_m = 0;  ///< tolerance: enough_m() is to be proven an upper bound
  std::size_t work = 0;  ///< work of the current search
  [[nodiscard]] double enough_m() const { return best.depth_m + certain_m; }
  [[nodiscard]] bool isSpent() const { return work >= kMostWork; }
};

/// Whether a facet is narrower than rounding. Such a facet has no certain plane; its points belong to the
/// adjacent facets.
bool isSliver(const Triangle& t) {
  constexpr double kNarrow_m = 1e-10;
  const double longest_m = std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
  return !((t[1] - t[0]).cross(t[2] - t[0]).norm() > kNarrow_m * longest_m);
}

using Halves = std::array<SurfacePiece, 2>;

Halves cut(const SurfacePiece& piece, const Vec3& n, double level) {
  return {below(piece, n, level), below(piece, -n, -level)};
}

bool areWhole(const Halves& halves, const SurfacePiece& of) {
  const std::size_t least = std::min<std::size_t>(of.size(), 3);
  return halves[0].size() >= least && halves[1].size() >= least;
}

/// Cuts a piece in the middle of its extent along a direction.
Halves cutAcross(const SurfacePiece& piece, const Vec3& along) {
  double lowest = along.dot(piece[0]), highest = lowest;
  for (const Vec3& p : piece) {
    lowest = std::min(lowest, along.dot(p));
    highest = std::max(highest, along.dot(p));
  }
  return cut(piece, along, 0.5 * (lowest + highest));
}

Halves cutLongest(const SurfacePiece& piece) {
  Vec3 longest = Vec3::Zero();
  for (std::size_t i = 0; i < piece.size(); ++i)
    for (std::size_t k = i + 1; k < piece.size(); ++k)
      if ((piece[k] - piece[i]).squaredNorm() > longest.squaredNorm()) longest = piece[k] - piece[i];
  return cutAcross(piece, longest);
}

/// The shortest way out of a solid: unit direction `out` to the nearest point q of its surface.
struct WayOut {
  Vec3 out, q;
};

/// Divides a piece. At three of four levels, the piece is cut where two ways out are equally long, or else
/// across the direction in which the distance changes. Distances often do not change along the perpendicular
/// direction, so that cuts across this direction would make many small pieces.
/// @param n normal of the piece's plane
Halves divided(const SurfacePiece& piece, int level, const Vec3& n, const WayOut& middle,
               const WayOut& other) {
  if (level % 4 != 3) {
    if (other.out.dot(middle.out) < kOneWay) {
      const Halves halves =
          cut(piece, middle.out - other.out, middle.q.dot(middle.out) - other.q.dot(other.out));
      if (areWhole(halves, piece)) return halves;
    }
    constexpr double kLeastSlope = 1e-3;
    const Vec3 slope = middle.out - middle.out.dot(n) * n;
    if (slope.norm() > kLeastSlope)
      if (const Halves halves = cutAcross(piece, slope); areWhole(halves, piece)) return halves;
  }
  return cutLongest(piece);
}

/// Searches the surface of one part (`of`) for the deepest point inside another part (`in`), in the frame of
/// `in`.
class DepthSearch {
 public:
  DepthSearch(const PlacedSurface& in, const PlacedSurface& of, Search& search)
      : in_(*in.surface),
        of_(*of.surface),
        X_WI_(in.X_WP),
        X_IO_(in.X_WP.inverse() * of.X_WP),
        search_(search) {}

  /// Returns an upper bound of the depth: enough_m(), or more if the limit of work was reached.
  double run() {
    search_.work = 0;
    if (!of_.tree().nodes().empty()) addNode(0);
    while (!waiting_.empty() && waiting_.top().bound_m > search_.enough_m()) {
      pollStop();
      if (search_.isSpent()) return waiting_.top().bound_m;
      const Waiting next = waiting_.top();
      waiting_.pop();
      if (next.piece.empty())
        openNode(next.node);
      else
        divide(next);
    }
    return search_.enough_m();
  }

 private:
  /// A node of the tree, or a piece of a facet.
  struct Waiting {
    double bound_m;
    std::uint32_t node = 0;  ///< index of the node, or of the facet that has the piece
    SurfacePiece piece = {};
    int level = 0;
    bool operator<(const Waiting& other) const { return bound_m < other.bound_m; }
  };
  /// A sample of a piece: the depth of a point, the direction out of the part, and the nearest surface point.
  struct Sample {
    double depth_m;
    Vec3 out, q;
  };

  Sample sample(const Vec3& p) {
    search_.work += kQueryWork;
    const Solid::Closest nearest = in_.solid().closest(p);
    const Vec3 to = nearest.q - p;
    const bool is_inside = nearest.normal.dot(to) > 0;
    const double depth_m = is_inside ? nearest.distance_m : -nearest.distance_m;
    if (depth_m > search_.best.depth_m + kSame_m) search_.best = {depth_m, depth_m, X_WI_ * p, false};
    Vec3 out = nearest.normal;
    if (nearest.distance_m > 1e-9) out = (is_inside ? 1 : -1) * to / nearest.distance_m;
    return {depth_m, out, nearest.q};
  }

  void addNode(std::uint32_t node) {
    const Box& box = of_.tree().nodes()[node].box;
    search_.work += kQueryWork;
    const double depth_m = -in_.solid().signedDistance(X_IO_ * box.center());
    const double bound_m = depth_m + 0.5 * box.size().norm();
    if (bound_m > search_.enough_m()) waiting_.push({bound_m, node, {}, 0});
  }

  void openNode(std::uint32_t index) {
    const BoxTree::Node& node = of_.tree().nodes()[index];
    if (!node.isLeaf()) {
      addNode(index + 1);
      addNode(node.right);
      return;
    }
    for (std::uint32_t i = node.first; i < node.end; ++i) {
      const std::uint32_t facet = of_.tree().order()[i];
      const Triangle t = of_.triangle(facet);
      if (!isSliver(t)) addPiece(facet, {X_IO_ * t[0], X_IO_ * t[1], X_IO_ * t[2]}, 0);
    }
  }

  void addPiece(std::uint32_t facet, SurfacePiece piece, int level) {
    const Vec3 middle = middleOf(piece);
    const Sample at = sample(middle);
    const double bound_m = at.depth_m + reachFrom(middle, piece);
    if (bound_m > search_.enough_m()) waiting_.push({bound_m, facet, std::move(piece), level});
  }

  /// Whether a move by enough_m() along a direction takes the whole piece out of the part.
  bool leaves(const Waiting& next, const Vec3& out) {
    return isOutside(shifted(next.piece, search_.enough_m() * out), X_IO_.R * of_.normal(next.node), in_,
                     search_.work);
  }

  void divide(const Waiting& next) {
    const Sample middle = sample(middleOf(next.piece));
    if (leaves(next, middle.out)) return;
    // Finds the corner whose way out differs most from that of the middle.
    Sample other = middle;
    for (const Vec3& corner : next.piece) {
      const Sample at = sample(corner);
      if (at.out.dot(middle.out) < other.out.dot(middle.out)) other = at;
    }
    if (other.out.dot(middle.out) < kOneWay && leaves(next, other.out)) return;
    const Halves halves = divided(next.piece, next.level, X_IO_.R * of_.normal(next.node),
                                  {middle.out, middle.q}, {other.out, other.q});
    if (!areWhole(halves, next.piece)) return;  // the piece is as small as rounding
    for (const SurfacePiece& half : halves) addPiece(next.node, half, next.level + 1);
  }

  const PartSurface &in_, &of_;
  Pose X_WI_, X_IO_;
  Search& search_;
  std::priority_queue<Waiting> waiting_;
};

/// Searches for balls that lie in both parts and touch the surface of one of them, in the frame of that part.
class TouchSearch {
 public:
  TouchSearch(const PlacedSurface& touched, const PlacedSurface& other, Search& search)
      : touched_(*touched.surface),
        other_(*other.surface),
        X_OT_(other.X_WP.inverse() * touched.X_WP),
        balls_(touched, other),
        search_(search) {}

  /// Returns whether enough_m() is proven to be an upper bound; false if the limit of work was reached.
  bool run() {
    search_.work = 0;
    waiting_.clear();
    const Box box_T = grown(moved(other_.box(), X_OT_.inverse()), kOverlapCertain_m);
    touched_.tree().forEach([&](const Box& node) { return distance2(node, box_T) == 0; },
                            [&](std::uint32_t facet) { addFacet(facet, box_T); });
    addCorners(box_T);
    while (!waiting_.empty()) {
      pollStop();
      if (search_.isSpent()) return false;
      const Touch next = std::move(waiting_.back());
      waiting_.pop_back();
      if (!isSettled(next, search_.enough_m())) divide(next);
    }
    return true;
  }

 private:
  /// Points of the surface, and the cone of directions out of the part in which a ball may touch these
  /// points.
  struct Touch {
    SurfacePiece piece;
    std::vector<Vec3> directions;
    Vec3 n;  ///< normal of the piece's plane
    int level = 0;
  };

  void addFacet(std::uint32_t facet, const Box& box_T) {
    const Triangle t = touched_.triangle(facet);
    if (isSliver(t)) return;
    const Vec3 n = touched_.normal(facet);
    SurfacePiece piece(t.begin(), t.end());
    for (int axis = 0; axis < 3 && !piece.empty(); ++axis) {
      piece = below(piece, Vec3::Unit(axis), box_T.max[axis]);
      if (!piece.empty()) piece = below(piece, -Vec3::Unit(axis), -box_T.min[axis]);
    }
    if (piece.empty()) return;
    waiting_.push_back({piece, {n}, n});
    for (std::size_t e = 0; e < 3; ++e) {
      const std::uint32_t next = touched_.neighbours()[facet][e];
      if (next == kNoFacet || next < facet || !isReflex(facet, next, t[e], t[(e + 1) % 3])) continue;
      waiting_.push_back({{t[e], t[(e + 1) % 3]}, {n, touched_.normal(next)}, n});
    }
  }

  /// Whether the material covers more than half a turn around an edge.
  [[nodiscard]] bool isReflex(std::uint32_t facet, std::uint32_t next, const Vec3& a, const Vec3& b) const {
    constexpr double kLeast_rad = 1e-9;
    const double turn = touched_.normal(facet).cross(touched_.normal(next)).dot((b - a).normalized());
    return turn < -kLeast_rad || touched_.normal(facet).dot(touched_.normal(next)) < -0.999;
  }

  void addCorners(const Box& box_T) {
    std::vector<std::uint8_t> is_reflex(touched_.mesh().vertices.size());
    for (std::uint32_t facet = 0; facet < touched_.mesh().triangles.size(); ++facet) {
      const std::array<std::uint32_t, 3>& v = touched_.mesh().triangles[facet];
      for (std::size_t e = 0; e < 3; ++e) {
        const std::uint32_t next = touched_.neighbours()[facet][e], to = v[(e + 1) % 3];
        const Vec3 &a = touched_.mesh().vertices[v[e]], &b = touched_.mesh().vertices[to];
        if (next == kNoFacet || next < facet || !isReflex(facet, next, a, b)) continue;
        is_reflex[v[e]] = is_reflex[to] = 1;
      }
    }
    for (std::uint32_t v = 0; v < is_reflex.size(); ++v)
      if (is_reflex[v] != 0 && isWithin(touched_.mesh().vertices[v], box_T)) addCorner(v);
  }

  /// Adds the touches of a corner. The directions of such touches are in the cone of the normals around the
  /// corner; triangles cover the cone.
  void addCorner(std::uint32_t vertex) {
    const std::span<const Vec3> around = touched_.normalsAround(vertex);
    Vec3 middle = Vec3::Zero();
    for (const Vec3& n : around) middle += n;
    middle = middle.norm() > 1e-6 ? middle.normalized() : around[0];
    for (std::size_t i = 0; i < around.size(); ++i)
      for (std::size_t k = i + 1; k < around.size(); ++k)
        waiting_.push_back({{touched_.mesh().vertices[vertex]}, {middle, around[i], around[k]}, middle});
  }

  struct Cone {
    Vec3 middle;
    double half_rad;
  };
  static Cone coneOf(const Touch& touch) {
    Cone cone{middleOf(touch.directions), 0};
    const double length = cone.middle.norm();
    if (length < 1e-6)
      return {touch.directions[0], 4.0};  // opposite directions: the cone contains all directions
    cone.middle /= length;
    for (const Vec3& m : touch.directions)
      cone.half_rad = std::max(cone.half_rad, std::acos(std::clamp(m.dot(cone.middle), -1.0, 1.0)));
    return cone;
  }

  [[nodiscard]] bool isOutsideOf(bool is_other, const SurfacePiece& piece_T, const Vec3& n_T) {
    return is_other ? isOutside(placed(piece_T, X_OT_), X_OT_.R * n_T, other_, search_.work)
                    : isOutside(piece_T, n_T, touched_, search_.work);
  }

  /// Whether it is proven that no ball with a greater diameter touches the piece.
  bool isSettled(const Touch& touch, double diameter_m) {
    const Cone cone = coneOf(touch);
    if (cone.half_rad >= 1.5) return false;
    const SurfacePiece ends = shifted(touch.piece, -diameter_m * std::cos(cone.half_rad) * cone.middle);
    if (isOutsideOf(false, ends, touch.n) || isOutsideOf(true, ends, touch.n)) return true;
    const Vec3 middle = middleOf(touch.piece);
    const double radius_m = 0.5 * diameter_m;
    const double spread_m = reachFrom(middle, touch.piece) + 2 * radius_m * std::sin(0.5 * cone.half_rad);
    const Vec3 centre_T = middle - radius_m * cone.middle;
    search_.work += 2 * kQueryWork;
    const SharedBalls::Limit limit = balls_.limitAt(centre_T);
    if (limit.radius_m + spread_m <= radius_m) return true;
    if (2 * limit.radius_m > search_.best.depth_m + kSame_m) keep(centre_T, limit.radius_m);
    return areCentresNear(touch, cone, radius_m, limit);
  }

  /// Whether a move by at most the radius along one direction takes the centres of all balls of a touch out
  /// of a solid.
  bool areCentresNear(const Touch& touch, const Cone& cone, double radius_m,
                      const SharedBalls::Limit& limit) {
    SurfacePiece centres;
    if (touch.directions.size() == 1 || touch.piece.size() == 1) {
      for (const Vec3& m : touch.directions)
        for (const Vec3& p : touch.piece) centres.push_back(p - radius_m * m);
    } else {
      const Vec3 one = radius_m * touch.directions[0], two = radius_m * touch.directions[1];
      centres = {touch.piece[0] - one, touch.piece[1] - one, touch.piece[1] - two, touch.piece[0] - two};
    }
    // The centres for a cone lie on a cylinder or a ball, above the flat piece between the cone's directions
    // by at most above_m.
    const double above_m = radius_m * (1 - std::cos(cone.half_rad));
    const Vec3 n = touch.directions.size() == 1
                       ? touch.n
                       : Vec3((centres[1] - centres[0]).cross(centres.back() - centres[0]).normalized());
    return isOutsideOf(limit.is_of_b, shifted(centres, (radius_m - above_m) * limit.out), n);
  }

  void keep(const Vec3& centre_T, double radius_m) {
    search_.work += 27 * 60 * 2 * kQueryWork;
    const Overlap ball = balls_.grownFrom(centre_T, 0.5 * radius_m);
    search_.best = {2 * ball.depth_m, 2 * ball.depth_m, ball.p_W, true};
  }

  void divide(const Touch& touch) {
    const Cone cone = coneOf(touch);
    const double size_m = reachFrom(middleOf(touch.piece), touch.piece);
    if (touch.directions.size() > 1 && 0.5 * search_.enough_m() * cone.half_rad >= size_m)
      return divideCone(touch);
    const Vec3 to_centre = -0.5 * search_.enough_m() * cone.middle;
    const SharedBalls::Limit middle = balls_.limitAt(middleOf(touch.piece) + to_centre);
    SharedBalls::Limit other = middle;
    search_.work += 2 * kQueryWork * (touch.piece.size() + 1);
    for (const Vec3& corner : touch.piece) {
      const SharedBalls::Limit at = balls_.limitAt(corner + to_centre);
      if (at.out.dot(middle.out) < other.out.dot(middle.out)) other = at;
    }
    const Halves halves = divided(touch.piece, touch.level, touch.n, {middle.out, middle.q - to_centre},
                                  {other.out, other.q - to_centre});
    if (!areWhole(halves, touch.piece)) return;  // the piece is as small as rounding
    for (const SurfacePiece& half : halves)
      waiting_.push_back({half, touch.directions, touch.n, touch.level + 1});
  }

  /// Divides a cone between the two directions that differ most.
  void divideCone(const Touch& touch) {
    std::size_t from = 0, to = 1;
    for (std::size_t i = 0; i < touch.directions.size(); ++i)
      for (std::size_t k = i + 1; k < touch.directions.size(); ++k)
        if (touch.directions[i].dot(touch.directions[k]) < touch.directions[from].dot(touch.directions[to])) {
          from = i;
          to = k;
        }
    Vec3 between = touch.directions[from] + touch.directions[to];
    if (between.norm() < 1e-6) between = touch.directions[from].unitOrthogonal();
    between.normalize();
    for (const std::size_t moved : {from, to}) {
      Touch half = touch;
      half.directions[moved] = between;
      waiting_.push_back(std::move(half));
    }
  }

  const PartSurface &touched_, &other_;
  Pose X_OT_;
  SharedBalls balls_;
  Search& search_;
  std::vector<Touch> waiting_;
};

}  // namespace

OverlapDepth overlapDepth(const PlacedSurface& a, const PlacedSurface& b, const OverlapDepth& known) {
  Search search{known};
  if (const Overlap ball = SharedBalls(a, b).greatest();
      2 * ball.depth_m > search.best.depth_m + kOverlapCertain_m)
    search.best = {2 * ball.depth_m, 2 * ball.depth_m, ball.p_W, true};
  const auto certain_m = [&](double share) {
    return std::max(kOverlapCertain_m, share * search.best.depth_m);
  };
  constexpr double kLeastShare = 1e-4;
  search.certain_m = certain_m(kLeastShare);
  const double in_a_m = DepthSearch(a, b, search).run(), in_b_m = DepthSearch(b, a, search).run();
  // A ball is no thicker than the smaller box. The finest tolerance is tried first. If the limit of work does
  // not suffice for the finest tolerance, tolerances from coarse to fine follow, so that a bound is proven in
  // any case.
  double thickness_m = std::min(a.surface->box().size().minCoeff(), b.surface->box().size().minCoeff());
  TouchSearch of_a(a, b, search), of_b(b, a, search);
  for (const double share : {kLeastShare, 1.0, 0.1, 0.01, 1e-3}) {
    search.certain_m = certain_m(share);
    if (thickness_m <= search.enough_m()) continue;
    const bool is_proven = of_a.run() && of_b.run();
    if (is_proven) thickness_m = search.enough_m();
    if (share == kLeastShare ? is_proven : !is_proven) break;
  }
  OverlapDepth found = search.best;
  found.most_m = std::max({found.depth_m + certain_m(kLeastShare), in_a_m, in_b_m, thickness_m});
  return found;
}

}  // namespace vps::scenes
