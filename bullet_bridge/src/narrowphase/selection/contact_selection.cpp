// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/selection/contact_selection.h"

#include <algorithm>
#include <cmath>

#include "native_shapes/native_shape.h"
#include "vps/contact_tolerances.h"

namespace vps::bullet {

namespace {

// Rounds up to a geometric series of lengths, since a cutoff larger than the last one makes a QueryMemory
// read points again.
double roundedUp(double cutoff_m, double most_m) {
  constexpr double kStep = 1.5;
  const double steps = std::ceil(std::log(cutoff_m / kSamePlace_m) / std::log(kStep));
  return std::min(kSamePlace_m * std::pow(kStep, steps), most_m);
}

// Greatest overlap of edges that counts as a crossing. At greater depth shell points lie inside and act
// instead of the crossing. Assumed.
double edgeDepth_m(const PairView& pair, double cutoff_m) {
  return pair.hasMap(0) || pair.hasMap(1) ? std::max(cutoff_m, kEdgeDepthShare * queryRange_m(pair))
                                          : cutoff_m;
}

// Edges do not come to overlap by more than the cutoff within a step. Crossings can be deep only where
// contacts were found to overlap, or in a pair's first step.
double edgeDepth_m(const PairView& pair, const Selection& last, double cutoff_m) {
  return mayOverlap(last, kEdgeDepthShare * cutoff_m) ? edgeDepth_m(pair, cutoff_m) : cutoff_m;
}

// The motion of body 0 relative to body 1 during a time within the step, in W.
Pose displacementIn(const PairView& pair, const RelativeMotion& motion, double t_s) {
  const Vec3 center = pair.center_W();
  const Mat3 R = rotationFromVector(t_s * motion.V.w);
  return {R, center + t_s * motion.velocityAt(center) - R * center};
}

// Pose of body 1's models' frame in body 0's models' frame, after the step's motion.
Pose poseAfterStep(const PairView& pair, const RelativeMotion& motion) {
  const Pose step = displacementIn(pair, motion, motion.dt_s);
  return (step * pair.side(0).X_WM).inverse() * pair.side(1).X_WM;
}

bool haveCrossings(const PairView& pair, const Settings& settings) {
  return isExact(settings) && pair.shape[0] && pair.shape[1];
}

// Points are searched within the distance that they may move in any direction; edges, whose motion is known,
// only where they come near each other on that motion.
CrossingRange crossingRange(const PairView& pair, double cutoff_m, const PairState* state,
                            const RelativeMotion* motion) {
  if (!state) return {cutoff_m, edgeDepth_m(pair, cutoff_m), pair.X_01_models()};
  const double near_m = motion->contact_margin_m + motion->anyWay_m();
  return {near_m, edgeDepth_m(pair, state->selection, near_m), poseAfterStep(pair, *motion)};
}

// Greatest distance of a point from a surface that it can touch within the step. The pull of couplings is
// left out, as in RelativeMotion::canTouch(): a hand that presses a part against its seat never pulls with
// the same force in two steps.
double reach_m(const RelativeMotion& motion) {
  return motion.contact_margin_m + motion.own_speed_m_s * motion.dt_s;
}

QueryState& queryStateOf(const PairView& pair, int i, PairState& state) {
  std::optional<QueryState>& own = state.query_state[i];
  return own ? *own : own.emplace(*pair.shape[1 - i]->models().map, *pair.shape[i]->models().shell);
}

SideQuery sideQueryOf(const PairView& pair, int i, PairState& state, const RelativeMotion& motion) {
  std::vector<std::uint32_t>& always = state.always[i];
  always.clear();
  for (const Candidate& c : state.selection.contacts)  // ascending
    if (c.side == i && !c.isCrossing()) always.push_back(c.id);
  const double way_s = (i == 0 ? 1 : -1) * motion.dt_s;
  return {&queryStateOf(pair, i, state), {way_s * motion.V.w, way_s * motion.V.v}, always, pair.radius_m()};
}

}  // namespace

bool mayOverlap(const Selection& last, double depth_m) {
  return !last.is_valid || std::any_of(last.contacts.begin(), last.contacts.end(),
                                       [&](const Candidate& c) { return c.distance_m < -depth_m; });
}

bool isQueriedOnce(const PairView& pair, const RelativeMotion& motion) {
  return motion.contact_margin_m + motion.speed_m_s * motion.dt_s <= queryRange_m(pair);
}

bool turnsInPlace(const PairView& pair, const RelativeMotion& motion) {
  const double way_m = motion.velocityAt(pair.center_W()).norm() * motion.dt_s;
  return motion.is_checked && !isQueriedOnce(pair, motion) &&
         motion.contact_margin_m + way_m <= queryRange_m(pair);
}

void findPointCandidates(const PairView& pair, double cutoff_m, Context& context, std::vector<Candidate>& out,
                         PairState* state, const RelativeMotion* motion) {
  std::size_t tested = 0, left_out = 0;
  for (int i = 0; i < 2; ++i) {
    if (!queriesPoints(pair, i, context.settings.sides)) continue;
    const int j = 1 - i;
    if (isPrimitive(*pair.wrapper[j]->getCollisionShape()))
      left_out += findPrimitiveCandidates(pair.side(i), *pair.wrapper[j]->getCollisionShape(), pair.X_WS[j],
                                          cutoff_m, context.settings, out, tested);
    else if (pair.hasMap(j)) {
      const double wide_m = state ? roundedUp(cutoff_m, queryRange_m(pair)) : cutoff_m;
      const SideQuery query = state ? sideQueryOf(pair, i, *state, *motion) : SideQuery{};
      left_out += findMapCandidates(pair.side(i), pair.side(j), wide_m, context.settings, query, out, tested);
    } else {
      left_out += findSurfaceCandidates(pair.side(i), pair.side(j), cutoff_m, context.settings, out, tested);
    }
  }
  context.points_tested += tested;
  context.left_out += left_out;
}

void findCandidates(const PairView& pair, double cutoff_m, Context& context, std::vector<Candidate>& out,
                    PairState* state, const RelativeMotion* motion) {
  findPointCandidates(pair, cutoff_m, context, out, state, motion);
  if (haveCrossings(pair, context.settings))
    context.left_out +=
        findCrossingCandidates(pair.side(0), pair.side(1), crossingRange(pair, cutoff_m, state, motion),
                               context.settings, state ? &state->crossings : nullptr, out);
}

void refineAll(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
               std::vector<Candidate>& candidates) {
  if (!settings.use_surfaces) return;
  for (int i = 0; i < 2; ++i)
    if (queriesPoints(pair, i, settings.sides))
      refine(candidates, pair.side(i), pair.side(1 - i), *pair.wrapper[1 - i]->getCollisionShape(), motion,
             queriesPoints(pair, 1 - i, settings.sides));
}

void dropUnreachable(const RelativeMotion& motion, std::vector<Candidate>& candidates) {
  std::erase_if(candidates, [&](Candidate& c) { return !motion.canTouch(c); });
}

namespace {

// For a body that turns fast in place, drops the points that stay away from the surface on their paths.
template <typename Error>
void dropStayingAway(const PairView& pair, const RelativeMotion& motion, const Error& error_m,
                     std::vector<Candidate>& candidates) {
  if (!turnsInPlace(pair, motion)) return;
  constexpr int kPlaces = 4;
  const Vec3 center = pair.center_W();
  const double between_rad = motion.dt_s * motion.V.w.norm() / kPlaces;
  Pose way[kPlaces];
  for (int k = 0; k < kPlaces; ++k) way[k] = displacementIn(pair, motion, motion.dt_s * (k + 1) / kPlaces);
  std::erase_if(candidates, [&](const Candidate& c) {
    double nearest_m = c.distance_m;
    // The contact plane of a point of body 1 turns with body 0.
    for (const Pose& X : way)
      nearest_m = std::min(nearest_m,
                           c.distance_m + (c.side == 1 ? Vec3(X.R * c.n_W) : c.n_W).dot(X * c.p_W - c.p_W));
    // Greatest distance of the arc between two of the places from its chord.
    const double sagitta_m = between_rad * between_rad / 8 * (c.p_W - center).norm();
    return nearest_m - sagitta_m > motion.contact_margin_m + error_m(c);
  });
}

// Drops candidates that are out of reach. Candidates that are in reach only if the field reads too much are
// moved to `doubtful`.
void dropUnreachableByField(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
                            std::vector<Candidate>& candidates, std::vector<Candidate>& doubtful) {
  doubtful.clear();
  std::erase_if(candidates, [&](Candidate& c) {
    if (motion.canTouch(c)) return false;
    if (!settings.use_surfaces) return true;
    Candidate nearer = c;
    nearer.distance_m -= fieldError_m(pair, c);
    if (motion.canTouch(nearer)) doubtful.push_back(c);
    return true;
  });
}

}  // namespace

void selectContacts(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
                    ManifoldWriter* writer, std::vector<Candidate>& candidates, Selection* selection) {
  thread_local std::vector<Candidate> doubtful;
  dropStayingAway(
      pair, motion, [&](const Candidate& c) { return fieldError_m(pair, c); }, candidates);
  dropUnreachableByField(pair, motion, settings, candidates, doubtful);
  if (writer) {
    writer->markExistingContacts(candidates);
    writer->markExistingContacts(doubtful);
  }
  const auto limit = static_cast<std::size_t>(settings.contact_limit);
  const double radius_m = pair.radius_m();
  const Pose X_GW = pair.X_WS[1].inverse();
  keepFacingShares(pair, candidates);
  keepFacingShares(pair, doubtful);
  const double sampling_m = reduceByCell(candidates, refinedLimit(settings), radius_m / 16, radius_m, X_GW);
  // Doubtful candidates are reduced separately, so that they do not displace the certain ones.
  reduceByCell(doubtful, 2 * limit, radius_m / 16, radius_m, X_GW);
  candidates.insert(candidates.end(), doubtful.begin(), doubtful.end());
  refineOnWay(pair, motion, settings, candidates);
  if (isQueriedOnce(pair, motion)) measureAtEnd(pair, motion, settings, candidates);
  dropUnreachable(motion, candidates);
  dropStayingAway(
      pair, motion, [](const Candidate&) { return 0.0; }, candidates);
  if (selection) {
    selection->refined = candidates;
    selection->leaves_out = candidates.size() > limit;
    selection->sampling_m = sampling_m;
    selection->is_of_path = !isQueriedOnce(pair, motion);
    selection->any_way_m = motion.anyWay_m();
  }
  reduceBySpread(candidates, limit, radius_m, settings.contact_margin_m, X_GW.R);
  if (selection) shareAreas(selection->refined, radius_m, candidates);
}

void storeSelection(const std::vector<Candidate>& chosen, const PairView& pair, const RelativeMotion& motion,
                    Selection& selection) {
  selection.contacts = chosen;
  selection.is_valid = true;
  selection.X_01 = pair.X_01();
  selection.X_W0 = pair.X_WS[0];
  selection.V = motion.V;
  for (int i = 0; i < 2; ++i) selection.key[i] = pair.key(i);
  selection.reach_m = reach_m(motion);
}

bool hasNotMoved(const Selection& selection, const PairView& pair, const RelativeMotion& motion) {
  if (!selection.is_valid) return false;
  for (int i = 0; i < 2; ++i)
    if (!(selection.key[i] == pair.key(i))) return false;
  if (reach_m(motion) > selection.reach_m + kSamePlace_m) return false;
  return pair.movedBy_m(pair.X_01() * selection.X_01.inverse()) <= kSamePlace_m;
}

double motionChange_m(const Selection& selection, const PairView& pair, const RelativeMotion& motion) {
  RelativeMotion change = motion;
  change.V = {motion.V.w - selection.V.w, motion.V.v - selection.V.v};
  return (change.velocityAt(pair.center_W()).norm() + change.V.w.norm() * pair.radius_m()) * motion.dt_s;
}

CandidateMotion motionSince(const Selection& selection, const PairView& pair) {
  const Pose body0_W = pair.X_WS[0] * selection.X_W0.inverse();
  const Pose body1_W = pair.X_WS[0] * pair.X_01() * selection.X_01.inverse() * pair.X_WS[0].inverse();
  return {body0_W, body1_W};
}

}  // namespace vps::bullet
