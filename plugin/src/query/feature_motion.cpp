// SPDX-License-Identifier: BSD-3-Clause
#include "vps/feature_motion.h"

#include <algorithm>
#include <cmath>

#include "query/feature_points.h"
#include "query/flush_features.h"
#include "query/kept_list.h"

namespace vps::inline v0 {

namespace {

using Kind = FeatureContact::Kind;

/// Points of part 0 and part 1, in the frame of part 1. Those of part 0 move.
struct Features {
  Vec3 own[3];  ///< of part 0, in its own frame
  Vec3 a[3], way[3], b[3];
  int a_count = 0, b_count = 0;

  void moveTo(double share, Vec3 (&at)[3]) const {
    for (int i = 0; i < a_count; ++i) at[i] = a[i] + share * way[i];
  }
};

/// Where features reach a distance.
struct Reach {
  double share = 0;
  Nearest nearest;
};

// Up to which share of the step the slab between both features along n stays wider than least_m.
double slabShare(const Features& f, const Vec3& n, double least_m) {
  double top = n.dot(f.b[0]);
  for (int i = 1; i < f.b_count; ++i) top = std::max(top, n.dot(f.b[i]));
  double share = 2;
  for (int i = 0; i < f.a_count; ++i) {
    const double speed = n.dot(f.way[i]);
    if (speed < 0) share = std::min(share, (top + least_m - n.dot(f.a[i])) / speed);
  }
  return share;
}

/// A vector that changes linearly between two shares.
struct Linear {
  Vec3 from, to;
};

// The vectors whose product C = A x B is across both edges, or across the facet, and r between them.
void vectorsOf(Kind kind, const Features& f, double from, double to, Linear& A, Linear& B, Linear& r) {
  Vec3 at[2][3];
  f.moveTo(from, at[0]);
  f.moveTo(to, at[1]);
  const auto of = [&](Linear& out, const auto& get) { out = {get(at[0]), get(at[1])}; };
  using Points = Vec3[3];
  if (kind == Kind::EdgeOnEdge) {
    of(A, [](const Points& a) { return Vec3(a[1] - a[0]); });
    B = {f.b[1] - f.b[0], f.b[1] - f.b[0]};
    of(r, [&](const Points& a) { return Vec3(a[0] - f.b[0]); });
  } else if (kind == Kind::CornerOnFacet) {
    A = {f.b[1] - f.b[0], f.b[1] - f.b[0]};
    B = {f.b[2] - f.b[0], f.b[2] - f.b[0]};
    of(r, [&](const Points& a) { return Vec3(a[0] - f.b[0]); });
  } else {
    of(A, [](const Points& a) { return Vec3(a[1] - a[0]); });
    of(B, [](const Points& a) { return Vec3(a[2] - a[0]); });
    of(r, [&](const Points& a) { return Vec3(f.b[0] - a[0]); });
  }
}

// True if the lines of both edges, or the corner and the facet's plane, stay farther apart than least_m
// between two shares: C . r is a cubic polynomial, which lies between its Bernstein coefficients.
bool staysApart(Kind kind, const Features& f, double from, double to, double least_m) {
  Linear A, B, r;
  vectorsOf(kind, f, from, to, A, B, r);
  const Vec3 C[3] = {A.from.cross(B.from), 0.5 * (A.from.cross(B.to) + A.to.cross(B.from)), A.to.cross(B.to)};
  const double h[4] = {C[0].dot(r.from), (C[0].dot(r.to) + 2 * C[1].dot(r.from)) / 3,
                       (2 * C[1].dot(r.to) + C[2].dot(r.from)) / 3, C[2].dot(r.to)};
  const double limit = least_m * std::max({C[0].norm(), C[1].norm(), C[2].norm()});
  const double sign = h[0] < 0 ? -1 : 1;
  return sign * h[0] > limit && sign * h[1] > limit && sign * h[2] > limit && sign * h[3] > limit;
}

// The share up to which they are known to stay apart in that sense; at least `least_share`.
double planeShare(Kind kind, const Features& f, double from, double least_share, double least_m) {
  constexpr int kMost = 6;
  double to = 1;
  for (int k = 0; k < kMost && to > least_share; ++k, to = 0.5 * (from + to))
    if (staysApart(kind, f, from, to, least_m)) return to;
  return least_share;
}

/// False: they stay farther apart than least_m.
/// @param reach  holds their nearest points at the start
bool findReach(Kind kind, const Features& f, double least_m, double start_m, Reach& reach) {
  constexpr int kMost = 60;  // assumed; most need two or three
  const double near_m = 1.1 * least_m;
  double distance_m = start_m;
  double fastest_m = 0;
  for (int i = 0; i < f.a_count; ++i) fastest_m = std::max(fastest_m, f.way[i].norm());
  for (int k = 0; k < kMost; ++k) {
    const Vec3 n = (reach.nearest.p - reach.nearest.q) / distance_m;
    // The slab is as wide as the distance, so it lasts at least as long as the fastest point needs for that.
    const double least_step = fastest_m > 0 ? (distance_m - least_m) / fastest_m : 2;
    const double slab = std::max(slabShare(f, n, least_m), reach.share + least_step);
    if (!(slab < 1)) return false;
    // A long edge that turns leaves its slab soon, though the edges stay apart where they are nearest.
    reach.share = planeShare(kind, f, reach.share, slab, least_m);
    if (!(reach.share < 1)) return false;
    Vec3 at[3];
    f.moveTo(reach.share, at);
    reach.nearest = nearestOf(kind, at, f.b);
    distance_m = (reach.nearest.p - reach.nearest.q).norm();
    if (distance_m <= near_m) return true;
  }
  return true;
}

// The corner of a facet that another does not have, as a place.
Vec3 apexOf(const FeatureSet& part, std::uint32_t facet, std::uint32_t other) {
  const auto &t = part.facets()[facet], &u = part.facets()[other];
  const auto* apex = std::find_if(
      t.begin(), t.end() - 1, [&](std::uint32_t v) { return std::find(u.begin(), u.end(), v) == u.end(); });
  return part.vertices()[*apex];
}

// True if a facet's neighbour is nearer than the facet's nearest point p, which then lies on its border; so
// the neighbour's own contact counts. A nut's corner that slides on a flank passes below the crest's facets,
// which end there, and does not touch them.
bool isNeighbourNearer(const FeatureSet& part, std::uint32_t facet, const Vec3& p, const Vec3& n) {
  constexpr double kLean = 0.1, kOn_m = 1e-9;  // assumed: as for edges; far below the rest gap
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t other = part.neighbours(facet)[k];
    if (other == FeatureSet::kNone || distanceToSide(part, facet, k, p) > kOn_m) continue;
    const Vec3 into = apexOf(part, other, facet) - p;
    if (n.dot(into) > kLean * into.norm()) return true;
  }
  return false;
}

// A facet is met from outside, an edge from between its facets. Other pairs are nearest through the solid,
// behind a feature that is met first.
// @param p  the nearest point, in the part's frame
bool isMetFromOutside(const FeatureSet& part, Kind kind, int i, std::uint32_t feature, const Vec3& p,
                      const Vec3& n) {
  constexpr double kLean = 0.1;         // assumed; while the features touch, other features may be as near
  const double sign = i == 1 ? 1 : -1;  // n points out of part 1 and into part 0
  if (kind == Kind::EdgeOnEdge) {
    const FeatureEdge& edge = part.edges()[feature];
    return !edge.has_faces || (sign * n.dot(edge.into[0]) <= kLean && sign * n.dot(edge.into[1]) <= kLean);
  }
  if ((kind == Kind::CornerOnFacet) == (i == 0) || part.isTwoSided(feature)) return true;
  return sign * n.dot(part.normal(feature)) > 0 && !isNeighbourNearer(part, feature, p, sign * n);
}

Ball ballAround(const FeatureSet& part) {
  return {part.box().center(), part.radius_m()};
}

}  // namespace

double travel_m(const FeatureSet& part0, const FeatureSet& part1, const Pose& X_01_start,
                const Pose& X_01_end) {
  return travel_m(ballAround(part0), ballAround(part1), X_01_start, X_01_end);
}

Vec3 FeatureContact::normal_0(const Pose& X_01) const {
  const Vec3 fixed = plane_of == 0 ? n : Vec3(X_01.R * n);
  if (kind != Kind::EdgeOnEdge) return fixed;
  const Vec3 across = along[0].cross(X_01.R * along[1]);
  constexpr double kParallel = 1e-3;  // assumed: edges in line have no plane of their own
  if (!(across.norm() > kParallel)) return fixed;
  return (across.dot(fixed) < 0 ? -1 : 1) * across.normalized();
}

double FeatureContact::gap_m(const Pose& X_01) const {
  return normal_0(X_01).dot(p[0] - X_01 * p[1]);
}

double FeatureMotion::rest_m(const FeatureSet& part0, const FeatureSet& part1) {
  constexpr double kShareOfRadius = 1e-3;  // assumed
  return std::min(kRest_m, kShareOfRadius * std::min(part0.radius_m(), part1.radius_m()));
}

namespace {

// The same point of part 0 in its own frame, by its weights among the feature's vertices.
Vec3 inOwnFrame(Kind kind, const Vec3 (&own)[3], const Vec3 (&at)[3], const Vec3& p) {
  if (kind == Kind::CornerOnFacet) return own[0];
  if (kind == Kind::EdgeOnEdge) {
    const Vec3 way = at[1] - at[0];
    return own[0] + (p - at[0]).dot(way) / way.squaredNorm() * (own[1] - own[0]);
  }
  const Vec3 u = at[1] - at[0], v = at[2] - at[0], r = p - at[0];
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), det = uu * vv - uv * uv;
  const double s = (vv * r.dot(u) - uv * r.dot(v)) / det, t = (uu * r.dot(v) - uv * r.dot(u)) / det;
  return own[0] + s * (own[1] - own[0]) + t * (own[2] - own[0]);
}

// The plane in which features touch that were carried a share of their way.
FeatureContact contactAt(Kind kind, const std::uint32_t (&feature)[2], const Features& f,
                         const Reach& reach) {
  FeatureContact contact;
  contact.kind = kind;
  for (int i = 0; i < 2; ++i) contact.feature[i] = feature[i];
  Vec3 at[3];
  f.moveTo(reach.share, at);
  contact.p[0] = inOwnFrame(kind, f.own, at, reach.nearest.p);
  contact.p[1] = reach.nearest.q;
  if (kind == Kind::EdgeOnEdge) {
    contact.along[0] = (f.own[1] - f.own[0]).normalized();
    contact.along[1] = (f.b[1] - f.b[0]).normalized();
  }
  return contact;
}

/// The way between two poses: the smaller part's centre moves on a straight line, and it turns evenly.
class Way {
 public:
  Way(const FeatureSet& part0, const FeatureSet& part1, const Pose& start, const Pose& end)
      : is_first_(part0.radius_m() <= part1.radius_m()),
        from_(is_first_ ? start.inverse() : start),
        to_(is_first_ ? end.inverse() : end),
        turn_(rotationVector(to_.R * from_.R.transpose())),
        center_((is_first_ ? part0 : part1).box().center()),
        radius_m_((is_first_ ? part0 : part1).radius_m()) {}

  /// Of part 0 in part 1.
  [[nodiscard]] Pose at(double share) const {
    const Vec3 c_from = from_ * center_, c_to = to_ * center_;
    Pose X = share < 1 ? from_ : to_;
    if (share > 0 && share < 1) {
      X.R = rotationFromVector(share * turn_) * from_.R;
      X.p = c_from + share * (c_to - c_from) - X.R * center_;
    }
    return is_first_ ? X : X.inverse();
  }

  /// Poses between which vertices move on nearly straight lines.
  void divide(std::vector<Pose>& way_10) const {
    constexpr double kSagitta_m = 0.05e-6;  // assumed: a quarter of what is looked at
    constexpr double kMost = 128;           // assumed: a part of 20 mm at 8000 rpm, in steps of 1 ms
    const double sagitta_m = turn_.squaredNorm() * radius_m_ / 8;
    const int pieces = static_cast<int>(std::clamp(std::ceil(std::sqrt(sagitta_m / kSagitta_m)), 1.0, kMost));
    way_10.clear();
    for (int k = 0; k <= pieces; ++k) way_10.push_back(at(static_cast<double>(k) / pieces));
  }

 private:
  bool is_first_;
  Pose from_, to_;  // of the smaller part in the other
  Vec3 turn_, center_;
  double radius_m_;
};

double distanceAt(const FeatureSet& part0, const FeatureSet& part1, const FeatureContact& contact,
                  const Pose& X_01) {
  Vec3 a[3], b[3];
  const int count = pointsOf(part0, contact.kind, 0, contact.feature[0], a);
  pointsOf(part1, contact.kind, 1, contact.feature[1], b);
  const Pose X_10 = X_01.inverse();
  for (int k = 0; k < count; ++k) a[k] = X_10 * a[k];
  const Nearest nearest = nearestOf(contact.kind, a, b);
  return (nearest.p - nearest.q).norm();
}

/// The piece of the way in which features reach a distance first.
struct Met {
  std::size_t piece = 0;
  Features features;
  Reach reach;
};

void placeAt(Features& f, const std::vector<Pose>& way_10, std::size_t piece) {
  for (int v = 0; v < f.a_count; ++v) {
    f.a[v] = way_10[piece] * f.own[v];
    f.way[v] = way_10[piece + 1] * f.own[v] - f.a[v];
  }
}

bool findFirst(Kind kind, const std::vector<Pose>& way_10, double least_m, double distance_m, Met& met) {
  Features& f = met.features;
  for (std::size_t k = 0; k + 1 < way_10.size(); ++k) {
    placeAt(f, way_10, k);
    if (k > 0) {
      met.reach.nearest = nearestOf(kind, f.a, f.b);
      distance_m = (met.reach.nearest.p - met.reach.nearest.q).norm();
    }
    met.piece = k;
    met.reach.share = 0;
    if (findReach(kind, f, least_m, distance_m, met.reach)) return true;
  }
  return false;
}

}  // namespace

void FeatureMotion::check(const FeatureSet& part0, const FeatureSet& part1, const Pose& start,
                          const Pose& end, bool holds_close, std::vector<FeatureContact>& out) {
  const double stretch_m = longestStretch_m(ballAround(part0), ballAround(part1));
  constexpr double kMost = 1e4;         // assumed: some metres of a small part
  constexpr std::size_t kEnough = 256;  // assumed: more than a solver adds at once
  const int stretches =
      static_cast<int>(std::clamp(std::ceil(travel_m(part0, part1, start, end) / stretch_m), 1.0, kMost));
  if (stretches == 1) return checkStretch(part0, part1, start, end, end, holds_close, out);
  const Way way(part0, part1, start, end);
  const std::size_t first = out.size();
  Pose from = start;
  for (int k = 0; k < stretches && out.size() < first + kEnough; ++k) {
    const Pose to = k + 1 < stretches ? way.at((k + 1.0) / stretches).inverse() : end;
    const std::size_t found = out.size();
    checkStretch(part0, part1, from, to, end, holds_close && k == 0, out);
    from = to;
    for (std::size_t i = found; i < out.size(); ++i) {
      out[i].share = (k + out[i].share) / stretches;
      out[i].start_m = distanceAt(part0, part1, out[i], start);
    }
  }
}

// @param end  of the whole step; a contact counts if the gap is too small there
void FeatureMotion::checkStretch(const FeatureSet& part0, const FeatureSet& part1, const Pose& start,
                                 const Pose& to, const Pose& end, bool holds_close,
                                 std::vector<FeatureContact>& out) {
  constexpr double kRounding_m = 1e-9;  // assumed: far below the rest gap
  constexpr double kHeldShare = 0.2;    // assumed: half of what is looked at on the way
  constexpr double kTouching_m = 1e-9;  // below this the direction between the features is not known
  const double step_m = travel_m(part0, part1, start, to);
  const double gap_m = rest_m(part0, part1), looked_at_m = kLeastShare * gap_m;
  if (is_valid_) path_m_ += travel_m(part0, part1, last_, start);
  if (!is_valid_ || travel_m(part0, part1, searched_at_, start) + step_m + looked_at_m > margin_m_)
    search(part0, part1, start, searchMargin_m(step_m, ballAround(part0), ballAround(part1)));
  is_valid_ = true;
  last_ = start;
  way_10_.clear();
  const Pose start_10 = start.inverse();
  for (Near& near : near_) {
    if (near.distance_m - (path_m_ - near.path_m) > step_m + looked_at_m) continue;
    Met met;
    Features& f = met.features;
    f.a_count = pointsOf(part0, near.kind, 0, near.feature[0], f.own);
    f.b_count = pointsOf(part1, near.kind, 1, near.feature[1], f.b);
    for (int k = 0; k < f.a_count; ++k) f.a[k] = start_10 * f.own[k];
    Nearest& nearest = met.reach.nearest;
    nearest = nearestOf(near.kind, f.a, f.b);
    near.distance_m = (nearest.p - nearest.q).norm();
    near.path_m = path_m_;
    if (near.distance_m > step_m + looked_at_m || near.distance_m < kTouching_m) continue;
    if (way_10_.empty()) Way(part0, part1, start, to).divide(way_10_);
    const double least_m = std::min(looked_at_m, 0.5 * near.distance_m);
    const bool is_held = holds_close && near.distance_m < kHeldShare * gap_m;
    const Nearest at_start = nearest;
    if (!findFirst(near.kind, way_10_, least_m, near.distance_m, met)) {
      if (!is_held) continue;
      placeAt(f, way_10_, 0);
      met.piece = 0;
      met.reach = {0, at_start};
    }
    if (near.kind == Kind::EdgeOnEdge && nearest.is_end) continue;  // a corner and a facet
    // Within a piece the rotation changes little; the plane is that of its start.
    const Mat3& R_10 = way_10_[met.piece].R;
    const Vec3 n_1 = (nearest.p - nearest.q).normalized(), n_0 = R_10.transpose() * n_1;
    FeatureContact contact = contactAt(near.kind, near.feature, f, met.reach);
    if (!isMetFromOutside(part0, near.kind, 0, near.feature[0], contact.p[0], n_0) ||
        !isMetFromOutside(part1, near.kind, 1, near.feature[1], contact.p[1], n_1))
      continue;
    if (isLeftToPoints(part0, part1, contact, R_10, n_1)) continue;
    contact.share =
        (static_cast<double>(met.piece) + met.reach.share) / static_cast<double>(way_10_.size() - 1);
    contact.start_m = near.distance_m;
    contact.plane_of = near.kind == Kind::FacetOnCorner ? 0 : 1;
    contact.n = contact.plane_of == 0 ? n_0 : n_1;
    if (is_held || contact.gap_m(end) < std::min(gap_m, near.distance_m) - kRounding_m)
      out.push_back(contact);
  }
}

}  // namespace vps::inline v0
