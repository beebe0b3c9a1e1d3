// SPDX-License-Identifier: BSD-3-Clause
#include "vps/feature_motion.h"

#include <algorithm>
#include <cmath>

#include "query/features/feature_contact.h"
#include "query/features/feature_pair.h"
#include "query/features/touch_search.h"
#include "query/motion/motion_tube.h"
#include "vps/contact_tolerances.h"

namespace vps {

namespace {

using Kind = FeatureContact::Kind;

Ball ballAround(const FeatureSet& part) {
  return {part.box().center(), part.radius_m()};
}

}  // namespace

double travel_m(const FeatureSet& part0, const FeatureSet& part1, const Pose& X_01_start,
                const Pose& X_01_end) {
  return travel_m(ballAround(part0), ballAround(part1), X_01_start, X_01_end);
}

double FeatureMotion::rest_m(const FeatureSet& part0, const FeatureSet& part1) {
  return std::min(kRest_m, 1e-3 * std::min(part0.radius_m(), part1.radius_m()));
}

namespace {

// The distance at the start. For a contact in a face's plane the distance is the height above the plane,
// since a corner may be far away and slide onto the face.
double startOf(const FeatureSet& part0, const FeatureSet& part1, const FeatureContact& contact,
               double distance_m, const Pose& start) {
  if (contact.kind == Kind::EdgeOnEdge) return distance_m;
  const Vec3& n = contact.plane_of == 1 ? part1.normal(contact.feature[1]) : part0.normal(contact.feature[0]);
  if (contact.n != n && contact.n != -n) return distance_m;
  return std::min(distance_m, std::max(contact.gap_m(start), kRounding_m));
}

/// The first piece of the motion in which features come within a distance.
struct Met {
  std::size_t piece = 0;
  Features features;
  Approach reach;
};

void placeAt(Features& f, const std::vector<Pose>& way_10, std::size_t piece) {
  f.moveFrom(way_10[piece], way_10[piece + 1]);
}

// Rotation from part 0 to part 1 at the place where the features met.
Mat3 rotationAt(const std::vector<Pose>& way_10, const Met& met) {
  const Mat3 &from = way_10[met.piece].R, &to = way_10[met.piece + 1].R;
  return rotationFromVector(met.reach.share * rotationVector(to * from.transpose())) * from;
}

bool findFirst(Kind kind, const std::vector<Pose>& way_10, double least_m, double distance_m, Met& met) {
  Features& f = met.features;
  for (std::size_t k = 0; k + 1 < way_10.size(); ++k) {
    placeAt(f, way_10, k);
    if (k > 0) {
      met.reach.nearest = nearestOf(kind, f.a, f.b);
      distance_m = met.reach.nearest.distance_m();
    }
    met.piece = k;
    met.reach.share = 0;
    if (findApproach(kind, f, least_m, distance_m, met.reach)) return true;
  }
  return false;
}

constexpr int kHalvings = 40;  // accurate to a picometre on a path of a metre

Nearest nearestAt(const Features& f, double share) {
  Vec3 at[3];
  f.moveTo(share, at);
  return nearestOf(Kind::EdgeOnEdge, at, f.b);
}

// True if the distance of two edges grows at this share, by more than rounding error.
bool opensAt(const Features& f, double share, Nearest& nearest) {
  Vec3 at[3];
  f.moveTo(share, at);
  nearest = nearestOf(Kind::EdgeOnEdge, at, f.b);
  const Vec3 along = at[1] - at[0], apart = nearest.p - nearest.q;
  const double t = std::clamp(along.dot(nearest.p - at[0]) / along.squaredNorm(), 0.0, 1.0);
  const Vec3 way = f.way[0] + t * (f.way[1] - f.way[0]);
  return apart.dot(way) > kRoundingShare * apart.norm() * way.norm();
}

// Signed distance of the lines of two edges; zero if they are parallel.
double lineGap_m(const Features& f, double share) {
  Vec3 at[3];
  f.moveTo(share, at);
  const Vec3 across = (at[1] - at[0]).cross(f.b[1] - f.b[0]);
  return across.isZero(0) ? 0 : across.normalized().dot(at[0] - f.b[0]);
}

// True if a contact's gap at the end is less than the rest gap, and less than at the start.
bool endsTooNear(const FeatureContact& contact, const Pose& end, double rest_m) {
  return contact.gap_m(end) < std::min(rest_m, contact.start_m) - FeatureMotion::kMissedShare * rest_m;
}

bool isBetweenEnds(const Nearest& at) {
  return at.end[0] == Nearest::kBetween && at.end[1] == Nearest::kBetween;
}

// True if two edges meet at the place where their lines cross within a range of shares: between their ends,
// or within rounding of an end. The tolerance at the ends is needed where two edges of one part meet in a
// corner, since each of the two may miss the other part's edge by rounding. The place is then moved back to
// where both edges are nearest between their ends, because the direction from an end is still oblique.
bool doMeet(const Features& f, double last, Approach& reach) {
  const double before_m = lineGap_m(f, reach.share);
  if (before_m == 0 || before_m * lineGap_m(f, last) > 0) return false;
  double low = reach.share, high = last;
  for (int k = 0; k < kHalvings; ++k) {
    const double share = 0.5 * (low + high);
    (before_m * lineGap_m(f, share) > 0 ? low : high) = share;
  }
  if (const Nearest there = nearestAt(f, low); !isBetweenEnds(there) && there.distance_m() > 2 * kRounding_m)
    return false;
  double rest = low - reach.share;
  for (int k = 0; k < kMostPlaces && !isBetweenEnds(reach.nearest); ++k, rest *= 0.5)
    if (const Nearest here = nearestAt(f, low - rest); isBetweenEnds(here) && here.distance_m() > kRounding_m)
      reach = {low - rest, here};
  return true;
}

// Moves the place of contact of two edges. Edges that pass each other at a distance touch where they are
// nearest: where they first come near, the direction between them still leans against the motion, and over
// the rest of a fast step a plane that leans would throw them apart. Edges that meet keep the place where
// they come near first. The nearest place may be beyond the end of the piece, since the next piece continues
// in nearly the same direction.
void moveToTouch(Met& met) {
  Nearest after;
  double closes = met.reach.share, opens = 1;
  if (!opensAt(met.features, opens, after) && !opensAt(met.features, opens = 2, after)) return;
  if (doMeet(met.features, opens, met.reach)) return;
  for (int k = 0; k < kHalvings; ++k) {
    const double share = 0.5 * (closes + opens);
    Nearest here;
    if (!opensAt(met.features, share, here)) {
      closes = share;
      continue;
    }
    opens = share;
    after = here;
  }
  // On a plateau of the distance the place would be determined by rounding; and a rotation may lead to a
  // farther place.
  const bool is_nearer = after.distance_m() < (1 - kRoundingShare) * met.reach.nearest.distance_m();
  if (after.distance_m() > kRounding_m && is_nearer) met.reach = {std::min(opens, 1.0), after};
}

bool findCrossingOf(const FeatureSet& part0, const FeatureSet& part1, const std::uint32_t (&feature)[2],
                    const Met& met, const Pose& X_10, FeatureContact& contact) {
  return findCrossing(part0, part1, feature, met.features, X_10, met.reach.nearest.p - met.reach.nearest.q,
                      contact);
}

// Curvature of the curve that an edge approximates, 0 for a straight edge: a chord of length l leaves the
// curve by l^2 / 8 times the curvature.
double curvature_per_m(const FeatureSet& part, const FeatureEdge& edge) {
  if (!edge.is_curved) return 0;
  const double sagitta_m = std::max(part.sagitta_m(edge.from), part.sagitta_m(edge.to));
  return 8 * sagitta_m / (part.vertices()[edge.to] - part.vertices()[edge.from]).squaredNorm();
}

// Upper bound of the distance from the place where edges cross at the end to the place at which a contact
// held them. A row of the solver assumes straight edges on a straight path. Its error is therefore the
// deviation of the path from its tangent plus the deviation of curved edges from their tangents along the
// slide.
double bendOf_m(const FeatureSet& part0, const FeatureSet& part1, const Pose& start, const Pose& end,
                const MotionBetweenPoses& way, const FeatureContact& contact) {
  const double slide_m = std::max((start.inverse() * contact.p[0] - end.inverse() * contact.p[0]).norm(),
                                  (start * contact.p[1] - end * contact.p[1]).norm());
  const double curvature = curvature_per_m(part0, part0.edges()[contact.feature[0]]) +
                           curvature_per_m(part1, part1.edges()[contact.feature[1]]);
  return 0.5 * travel_m(part0, part1, start, end) * way.turn_rad() + 0.5 * curvature * slide_m * slide_m;
}

// True if edges cross at the end of the step, but not at its start, and come nearer than bendOf_m(). On a
// curved path, an edge A that slides past an end of an edge B may dip below B, although the contact of A and
// B holds A at the end of the step. Edge A then enters the edge that follows B from B's end, deeper than
// features are searched. Along a fine rim an edge passes several such ends in a step.
bool entersFromItsEnd(const FeatureSet& part0, const FeatureSet& part1, const std::uint32_t (&feature)[2],
                      const Pose& start, const Pose& end, Met& met, FeatureContact& contact) {
  FeatureContact before;
  if (!findCrossingOf(part0, part1, feature, met, end.inverse(), contact) ||
      findCrossingOf(part0, part1, feature, met, start.inverse(), before))
    return false;
  const MotionBetweenPoses way(ballAround(part0), ballAround(part1), start, end);
  const double bend_m = bendOf_m(part0, part1, start, end, way, contact);
  thread_local std::vector<Pose> way_10;
  way.divide(way_10);
  placeAt(met.features, way_10, 0);
  met.reach.nearest = nearestOf(Kind::EdgeOnEdge, met.features.a, met.features.b);
  const double distance_m = met.reach.nearest.distance_m();
  return distance_m <= bend_m || findFirst(Kind::EdgeOnEdge, way_10, bend_m, distance_m, met);
}

}  // namespace

FeatureMotion::FeatureMotion() : tube_(std::make_unique<MotionTube>()) {}
FeatureMotion::~FeatureMotion() = default;
FeatureMotion::FeatureMotion(FeatureMotion&&) noexcept = default;
FeatureMotion& FeatureMotion::operator=(FeatureMotion&&) noexcept = default;

void FeatureMotion::check(const FeatureSet& part0, const FeatureSet& part1, const Pose& start,
                          const Pose& end, bool holds_close, std::vector<FeatureContact>& out) {
  const double stretch_m = longestStretch_m(ballAround(part0), ballAround(part1));
  const int stretches = static_cast<int>(
      std::clamp(std::ceil(travel_m(part0, part1, start, end) / stretch_m), 1.0, 10 * kMostStretches));
  if (stretches == 1) return checkStretch(part0, part1, {start, end, start, end, true}, holds_close, out);
  const MotionBetweenPoses way(ballAround(part0), ballAround(part1), start, end);
  const double gap_m = rest_m(part0, part1);
  const std::size_t first = out.size();
  Pose from = start;
  // The loop stops at more contacts than a solver adds at once.
  for (int k = 0; k < stretches && out.size() < first + 32 * kMostAdded; ++k) {
    const bool is_last = k + 1 == stretches;
    const Pose to = is_last ? end : way.at((k + 1.0) / stretches).inverse();
    const std::size_t found = out.size();
    checkStretch(part0, part1, {start, end, from, to, is_last}, holds_close && k == 0, out);
    from = to;
    for (std::size_t i = found; i < out.size(); ++i) {
      out[i].share = (k + out[i].share) / stretches;
      out[i].start_m = startOf(part0, part1, out[i], distanceAt(part0, part1, out[i], start), start);
    }
    if (k == 0) continue;
    // A segment may begin with a larger gap than the whole motion, whose end may be as near as its start.
    const auto first_of_stretch = out.begin() + static_cast<std::ptrdiff_t>(found);
    out.erase(std::remove_if(first_of_stretch, out.end(),
                             [&](const FeatureContact& c) { return !endsTooNear(c, end, gap_m); }),
              out.end());
  }
}

void FeatureMotion::search(const FeatureSet& part0, const FeatureSet& part1) {
  near_.clear();
  path_m_ = 0;
  const double margin_m = tube_->margin_m() + kLeastShare * rest_m(part0, part1);
  const Sweep X_01{tube_->from(), tube_->to()}, X_10{X_01.from.inverse(), X_01.to.inverse()};
  const auto addIfNear = [&](Kind kind, std::uint32_t i, std::uint32_t j) {
    Features f;
    f.load(part0, part1, kind, {i, j});
    f.moveFrom(X_10.from, X_10.to);
    Approach reach;
    reach.nearest = nearestOf(kind, f.a, f.b);
    const double distance_m = reach.nearest.distance_m();
    if (distance_m <= margin_m || findApproach(kind, f, margin_m, distance_m, reach))
      near_.push_back({kind, {i, j}, distance_m, 0});
  };
  thread_local std::vector<TouchPair> pairs;
  findTouchPairs(part0, part1, X_10, margin_m, tube_->turn_rad(), pairs);
  for (const auto& [corner, facet] : pairs) addIfNear(Kind::CornerOnFacet, corner, facet);
  findTouchPairs(part1, part0, X_01, margin_m, tube_->turn_rad(), pairs);
  for (const auto& [corner, facet] : pairs) addIfNear(Kind::FacetOnCorner, facet, corner);
  EdgePairSearch(part1.edgeTree(), part0.edgeTree(), X_10, tube_->turn_rad(), margin_m)
      .run([&](std::uint32_t j, std::uint32_t i) { addIfNear(Kind::EdgeOnEdge, i, j); });
}

// A contact is reported if the gap is too small at the end of the step.
void FeatureMotion::checkStretch(const FeatureSet& part0, const FeatureSet& part1, const Stretch& stretch,
                                 bool holds_close, std::vector<FeatureContact>& out) {
  const Pose &start = stretch.from, &to = stretch.to;
  const double step_m = travel_m(part0, part1, start, to);
  const double gap_m = rest_m(part0, part1), looked_at_m = kLeastShare * gap_m;
  if (is_valid_) path_m_ += travel_m(part0, part1, last_, start);
  if (!is_valid_ || !tube_->holds(start) || !tube_->holds(to)) {
    *tube_ = MotionTube(ballAround(part0), ballAround(part1), start, to, tube_->nextWidth(near_.size()));
    search(part0, part1);
  }
  is_valid_ = true;
  last_ = start;
  way_10_.clear();
  const Pose start_10 = start.inverse();
  for (Near& near : near_) {
    if (near.distance_m - (path_m_ - near.path_m) > step_m + looked_at_m) continue;
    Met met;
    Features& f = met.features;
    f.load(part0, part1, near.kind, near.feature);
    for (int k = 0; k < f.a_count; ++k) f.a[k] = start_10 * f.own[k];
    Nearest& nearest = met.reach.nearest;
    nearest = nearestOf(near.kind, f.a, f.b);
    near.distance_m = nearest.distance_m();
    near.path_m = path_m_;
    if (near.distance_m > step_m + looked_at_m || near.distance_m < kRounding_m) continue;
    if (way_10_.empty()) MotionBetweenPoses(ballAround(part0), ballAround(part1), start, to).divide(way_10_);
    const double least_m = std::min(looked_at_m, 0.5 * near.distance_m);
    const bool is_held = holds_close && near.distance_m < kHeldShare * gap_m;
    const Nearest at_start = nearest;
    FeatureContact contact;
    const bool is_reached = findFirst(near.kind, way_10_, least_m, near.distance_m, met);
    if (is_reached && near.kind == Kind::EdgeOnEdge) moveToTouch(met);
    if (!is_reached) {
      placeAt(f, way_10_, 0);
      met.piece = 0;
      met.reach = {0, at_start};
    }
    const bool are_edges = near.kind == Kind::EdgeOnEdge;
    if (is_reached || is_held) {
      if (!findContact(part0, part1, near.kind, near.feature, f, met.reach, rotationAt(way_10_, met),
                       contact) &&
          !(are_edges && findCrossingOf(part0, part1, near.feature, met, way_10_.back(), contact)))
        continue;
      contact.share =
          (static_cast<double>(met.piece) + met.reach.share) / static_cast<double>(way_10_.size() - 1);
    } else {
      if (!stretch.is_last || !are_edges ||
          !entersFromItsEnd(part0, part1, near.feature, stretch.start, stretch.end, met, contact))
        continue;
      contact.share = 1;
    }
    contact.start_m = startOf(part0, part1, contact, near.distance_m, start);
    if (is_held || endsTooNear(contact, stretch.end, gap_m)) out.push_back(contact);
  }
}

}  // namespace vps
