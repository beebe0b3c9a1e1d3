// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/check/feature_check.h"

#include <algorithm>

#include "narrowphase/check/contact_at_pose.h"
#include "narrowphase/refinement/surface_view.h"
#include "narrowphase/selection/contact_selection.h"
#include "vps/contact_tolerances.h"

namespace vps::bullet {

namespace {

// Bits that mark a feature's kind in a contact's key, so that keys are unique. An edge has the same index as
// in edge crossings, so its key has a bit too.
constexpr std::uint32_t kCorner = 1U << 28, kFacet = 2U << 28, kEdge = 4U << 28;

Pose poseBetween(const PairView& pair, const Pose (&X_WS)[2]) {
  return (X_WS[0] * pair.shape[0]->X_SM()).inverse() * (X_WS[1] * pair.shape[1]->X_SM());
}

double restGapOf_m(const PairView& pair) {
  return FeatureMotion::rest_m(pair.shape[0]->features(), pair.shape[1]->features());
}

// True if the corner of a contact stays within the tolerated depth of the other body from the time at which
// the corner meets the other body to the end of the step. If the bodies turn far, a corner that grazes a
// curved face would otherwise be held by the plane of one facet, which leads away from the face.
bool grazes(const FeatureContact& c, const PairView& start, const EndPoses& end, double tolerated_m) {
  if (c.kind == FeatureContact::Kind::EdgeOnEdge) return false;
  const int i = c.kind == FeatureContact::Kind::CornerOnFacet ? 0 : 1;
  if (!start.shape[1 - i]->features().isCurved(c.feature[1 - i])) return false;
  for (int k = 1; k <= kMostPlaces; ++k) {
    const double share = c.share + (1 - c.share) * k / kMostPlaces;
    SideView side[2];
    for (const int j : {0, 1})
      side[j] = {start.shape[j], interpolate(start.X_WS[j], end.X_WS[j], share) * start.shape[j]->X_SM(),
                 static_cast<std::uint8_t>(j)};
    if (isInside(side[i].X_WM * c.p[i], side[1 - i], start.radius_m(), tolerated_m)) return false;
  }
  return true;
}

// In a late check of the step (CheckRound::isLate()), gaps from which the next step can restore the rest gap
// are accepted.
void findContacts(const PairView& start, const EndPoses& end, CheckRound round, PairState& state,
                  std::vector<FeatureContact>& found) {
  found.clear();
  const Pose X_01_end = poseBetween(start, end.X_WS);
  state.features.check(start.shape[0]->features(), start.shape[1]->features(), start.X_01_models(), X_01_end,
                       round.isFirst(), found);
  if (round.isLate()) {
    const double rest_m = restGapOf_m(start);
    std::erase_if(found, [&](const FeatureContact& c) {
      return c.gap_m(X_01_end) >= kHeldShare * std::min(rest_m, c.start_m);
    });
  }
  if (!end.turns_far) return;
  const double tolerated_m = kFacetCornerShare * state.context->settings.contact_margin_m;
  std::erase_if(found, [&](const FeatureContact& c) { return grazes(c, start, end, tolerated_m); });
}

std::uint32_t codeOf(const FeatureContact& c, int i) {
  const bool is_corner = (c.kind == FeatureContact::Kind::CornerOnFacet) == (i == 0);
  const std::uint32_t kind = c.kind == FeatureContact::Kind::EdgeOnEdge ? kEdge
                             : is_corner                                ? kCorner
                                                                        : kFacet;
  return kind | (c.feature[i] & (kCorner - 1));
}

// The surface of a shape that a feature lies on.
std::uint16_t surfaceOf(const FeatureContact& c, int i, const Shape& shape) {
  const FeatureSet& features = shape.features();
  const std::uint32_t feature = c.feature[i];
  if (c.kind == FeatureContact::Kind::EdgeOnEdge)
    return shape.surfaceOfVertex(features.edges()[feature].from);
  const bool is_corner = (c.kind == FeatureContact::Kind::CornerOnFacet) == (i == 0);
  return shape.surfaceOfVertex(is_corner ? features.corners()[feature] : features.facets()[feature][0]);
}

// True if a chosen contact has the same place and plane: coplanar facets, and edges that meet in a corner,
// give a contact several times.
bool isRepeated(const FeatureContact& c, const std::vector<const FeatureContact*>& chosen) {
  return std::any_of(chosen.begin(), chosen.end(), [&](const FeatureContact* other) {
    return other->plane_of == c.plane_of && other->n.dot(c.n) > kCosSamePlane &&
           (other->p[0] - c.p[0]).norm() < kSamePlace_m;
  });
}

// True if the contact's facet belongs to a sheet. A corner that starts behind a sheet is pushed back through
// it by other contacts.
bool isOnSheet(const FeatureContact& c, const PairView& pair) {
  if (c.kind == FeatureContact::Kind::EdgeOnEdge) return false;
  const int with_facet = c.kind == FeatureContact::Kind::CornerOnFacet ? 1 : 0;
  return pair.shape[with_facet]->features().isTwoSided(c.feature[with_facet]);
}

/// Makes candidates of feature contacts, at the poses of the start or of the end of a step.
struct FeaturePlacer {
  Pose X_01, X_WM0;
  const Shape* shape[2];
  double rest_m;

  explicit FeaturePlacer(const PairView& start) : FeaturePlacer(start, start.X_WS) {}
  FeaturePlacer(const PairView& start, const Pose (&X_WS)[2])
      : X_01(poseBetween(start, X_WS)),
        X_WM0(X_WS[0] * start.shape[0]->X_SM()),
        shape{start.shape[0], start.shape[1]},
        rest_m(restGapOf_m(start)) {}
  [[nodiscard]] Candidate operator()(const FeatureContact& c) const {
    Candidate at;
    at.n_W = X_WM0.R * c.normal_0(X_01);
    at.p_W = X_WM0 * c.p[0];
    at.distance_m = c.gap_m(X_01);
    at.id = codeOf(c, 0);
    at.crossed = codeOf(c, 1) + 1;
    for (const int i : {0, 1}) at.surface[i] = surfaceOf(c, i, *shape[i]);
    at.rest_m = rest_m;
    at.plane_of = c.kind == FeatureContact::Kind::EdgeOnEdge ? Candidate::kBetween : c.plane_of;
    return at;
  }
};

// Finds a shell point or edge crossing at the same place of the same plane. The contact's point may lie on
// the other body, across the gap. Returns null if there is no such contact.
Candidate* findAt(std::vector<Candidate>& contacts, const Candidate& at) {
  const auto found = std::find_if(contacts.begin(), contacts.end(), [&](const Candidate& c) {
    const Vec3 to = c.p_W - at.p_W;
    const double height_m = at.n_W.dot(to);
    return at.n_W.dot(c.n_W) > kCosSamePlane && std::abs(height_m) < std::abs(at.distance_m) + kSamePlace_m &&
           (to - height_m * at.n_W).squaredNorm() < kSamePlace_m * kSamePlace_m;
  });
  return found != contacts.end() ? &*found : nullptr;
}

void remember(const FeatureContact& c, std::vector<FeatureContact>& known) {
  constexpr std::size_t kMost = 2 * kMostAdded;  // assumed; six contacts hold a body
  std::erase_if(known, [&](const FeatureContact& k) {
    return k.kind == c.kind && std::equal(k.feature, k.feature + 2, c.feature);
  });
  if (known.size() == kMost) known.erase(known.begin());
  known.push_back(c);
}

bool isLoaded(const btManifoldPoint& point) {
  return point.m_appliedImpulse > 0;
}

/// Contacts of features as rows of the solver: gap, lever and normal are those at the end of the step.
class Linearised {
 public:
  Linearised(const PairView& start, const EndPoses& end)
      : start_(start), at_start_(start), at_end_(start, end.X_WS), end_(end) {}

  MissedContact operator()(const FeatureContact& c, PairState& state) const {
    const Candidate start = at_start_(c), end = at_end_(c);
    // If the bodies turn far, no single lever represents the whole path.
    const Candidate acting = end_.turns_far && !end_.path.isSettled() ? start : end_.path.acting(start, end);
    MissedContact missed;
    missed.point = state.writer->put(acting, start_.wrapper, state.motion);
    for (int i = 0; i < 2; ++i) missed.object[i] = start_.wrapper[i]->getCollisionObject();
    missed.end_gap_m = end.distance_m;
    missed.kept_m = std::min(at_end_.rest_m, c.start_m);
    missed.rest_m = at_end_.rest_m;
    missed.is_sharp = !isOnSheet(c, start_);
    return missed;
  }
  [[nodiscard]] std::uint64_t key(const FeatureContact& c) const { return at_end_(c).key(); }
  // Returns the contact with a gap so large that the contact loses its load.
  MissedContact without(const FeatureContact& c, PairState& state) const {
    MissedContact missed = (*this)(c, state);
    missed.end_gap_m = kOutOfReach_m;
    missed.is_let_go = true;
    return missed;
  }
  [[nodiscard]] bool isOutOfPlace(const FeatureContact& c, const Relinearising& which,
                                  const PairState& state) const {
    const Candidate end = at_end_(c);
    const btManifoldPoint* point = state.writer->find(end.key());
    if (!point || (!which.isBefore() && isLoaded(*point) != which.isOfLoad())) return false;
    return vps::bullet::isOutOfPlace(at_start_(c), end, end_.path, which, state.context->settings);
  }
  // True if a corner carries load and ends the step where no surface faces it along its plane, since it has
  // left the face or passed the face's rim.
  [[nodiscard]] bool hasLeft(const FeatureContact& c, const Relinearising& which,
                             const PairState& state) const {
    if (!which.isOfLoad() || c.kind == FeatureContact::Kind::EdgeOnEdge || isOnSheet(c, start_)) return false;
    const Candidate end = at_end_(c);
    const btManifoldPoint* point = state.writer->find(end.key());
    if (!point || !isLoaded(*point)) return false;
    const int i = c.kind == FeatureContact::Kind::CornerOnFacet ? 0 : 1;
    const SideView own = sideAtEnd(i), other = sideAtEnd(1 - i);
    const double near_m = at_end_.rest_m + which.apart_m;
    const SurfaceDistance there = SurfaceView(own, other).at(c.p[i], Vec3::Zero(), near_m);
    const Vec3 n_W = (i == 0 ? 1 : -1) * (other.X_WM.R * there.n);
    return there.distance_m > near_m || n_W.dot(end.n_W) <= kCosSameFace;
  }

 private:
  [[nodiscard]] SideView sideAtEnd(int i) const {
    return {start_.shape[i], end_.X_WS[i] * start_.shape[i]->X_SM(), static_cast<std::uint8_t>(i)};
  }

  const PairView& start_;
  FeaturePlacer at_start_, at_end_;
  const EndPoses& end_;
};

}  // namespace

bool hasFeatures(const PairView& pair, const Settings& settings) {
  return isExact(settings) && pair.shape[0] && pair.shape[1] && !pair.shape[0]->features().isEmpty() &&
         !pair.shape[1]->features().isEmpty();
}

double restGap_m(const PairView& pair, const Settings& settings) {
  return hasFeatures(pair, settings) ? restGapOf_m(pair) : FeatureMotion::kRest_m;
}

bool spinsFreely(const PairView& start, const Pose (&X_WS_end)[2], PairState& state) {
  const Settings& settings = state.context->settings;
  const double least_m = kToleratedShare * settings.contact_margin_m;
  // Bodies that touch have no free space around them, and the search for free space would take as long as
  // many steps.
  if (!hasFeatures(start, settings) || mayOverlap(state.selection, -least_m)) return false;
  return state.spin.staysApart(start.shape[0]->features(), start.shape[1]->features(), start.X_01_models(),
                               poseBetween(start, X_WS_end), least_m);
}

namespace {

bool isSharp(const PairView& pair, const Candidate& c) {
  return !c.is_flush && (c.isCrossing() || pair.shape[c.side]->isEdgePoint(c.id));
}

}  // namespace

void markSharp(const PairView& pair, const Settings& settings, bool is_own,
               std::vector<Candidate>& contacts) {
  if (!hasFeatures(pair, settings)) return;
  const double rest_m = restGapOf_m(pair);
  for (Candidate& c : contacts)
    if (is_own ? isSharp(pair, c) || c.is_flat : !c.is_flush) c.rest_m = rest_m;
}

void addFeatureContacts(const PairView& start, const EndPoses& end, CheckRound round, PairState& state,
                        std::vector<MissedContact>& out) {
  thread_local std::vector<FeatureContact> found;
  findContacts(start, end, round, state, found);
  if (found.empty()) return;
  thread_local std::vector<const FeatureContact*> chosen;
  chosen.clear();
  std::stable_sort(found.begin(), found.end(),
                   [](const FeatureContact& a, const FeatureContact& b) { return a.share < b.share; });
  for (const FeatureContact& c : found)
    if (chosen.size() < kMostAdded && !isRepeated(c, chosen)) chosen.push_back(&c);
  const Linearised at_end(start, end);
  for (const FeatureContact* c : chosen) {
    const MissedContact missed = at_end(*c, state);
    if (missed.is_sharp) remember(*c, state.missed_features);
    out.push_back(missed);
  }
}

bool isOutOfPlace(const Candidate& start, const Candidate& end, const StepPath& path,
                  const Relinearising& which, const Settings& settings) {
  switch (which.rows) {
    case Relinearising::Rows::Predicted:
      return end.distance_m > -settings.contact_margin_m && path.bends(start, end);
    case Relinearising::Rows::Loaded:
      return end.distance_m > end.rest_m + which.apart_m;
    case Relinearising::Rows::Others:
      return end.distance_m > path.endGap_m(start) + which.apart_m;
  }
  return false;
}

void lineariseFeatures(const PairView& start, const EndPoses& end, const Relinearising& which,
                       PairState& state, std::vector<MissedContact>& out) {
  const Linearised at_end(start, end);
  for (const FeatureContact& c : state.missed_features)
    if (at_end.hasLeft(c, which, state)) {
      if (state.letGo(at_end.key(c))) out.push_back(at_end.without(c, state));
    } else if (at_end.isOutOfPlace(c, which, state)) {
      out.push_back(at_end(c, state));
    }
}

void addMissedFeatures(const PairView& pair, const Settings& settings, PairState& state,
                       std::vector<Candidate>& contacts) {
  if (state.missed_features.empty()) return;
  if (!hasFeatures(pair, settings)) return state.missed_features.clear();
  const FeaturePlacer place(pair);
  const double most_m = FeatureMotion::kKeptGaps * place.rest_m;
  std::erase_if(state.missed_features, [&](FeatureContact& c) {
    return !measureAgain(pair.shape[0]->features(), pair.shape[1]->features(), place.X_01, most_m, c);
  });
  const std::size_t had = contacts.size();
  for (const FeatureContact& c : state.missed_features) {
    Candidate at = place(c);
    Candidate* same = findAt(contacts, at);
    // A crossing of flush curved edges rests without a gap, but a missed crossing needs the rest gap. The
    // crossing's distance may be measured from the curved surface, while the feature's is measured from the
    // facets.
    if (same)
      same->rest_m = std::max(same->rest_m, at.rest_m + same->distance_m - at.distance_m);
    else if (state.motion.canTouch(at))
      contacts.push_back(at);
  }
  const auto middle = contacts.begin() + static_cast<std::ptrdiff_t>(had);
  const auto byKey = [](const Candidate& a, const Candidate& b) { return a.key() < b.key(); };
  std::sort(middle, contacts.end(), byKey);
  std::inplace_merge(contacts.begin(), middle, contacts.end(), byKey);
}

double freeShareOf(const PairView& start, const EndPoses& end, PairState& state) {
  thread_local std::vector<FeatureContact> found;
  findContacts(start, end, {kMostRounds}, state, found);
  double share = 1;
  for (const FeatureContact& c : found) share = std::min(share, c.share);
  return share;
}

}  // namespace vps::bullet
