// SPDX-License-Identifier: BSD-3-Clause
// Stages 2 and 4 of PairCheck: finds the points that a solved step lets overlap.
#include <algorithm>
#include <cmath>

#include "narrowphase/check/checked_step.h"
#include "narrowphase/check/contact_at_pose.h"
#include "narrowphase/refinement/curved_contact.h"
#include "narrowphase/selection/contact_selection.h"

namespace vps::bullet {

// A point that the selection did not find had a gap above the contact margin at the predicted end of the
// step. Such a point does not touch if the motion deviates from the prediction by less than the margin, or if
// the travel is within the distance that was searched in every direction.
bool PairCheck::mayMissPoints(const Motion& m, const PairView& at_start) const {
  const double margin_m = state_.context->settings.contact_margin_m;
  const bool is_in_reach = !state_.selection.is_of_path &&
                           (m.deviation_m <= margin_m || m.travel_m <= margin_m + state_.selection.any_way_m);
  // Of neighbouring points, only the point nearest now and the point nearest at the predicted end were
  // selected. Another of these points may be the nearest if the part turns otherwise than predicted.
  const double sampling_m = state_.selection.sampling_m * std::min(m.turn_rad, m.turn_deviation_rad);
  if (!is_in_reach || sampling_m > m.tolerated_m) return true;
  if (std::any_of(state_.selection.refined.begin(), state_.selection.refined.end(),
                  [&](const Candidate& c) { return leavesCurve(m, at_start, c); }))
    return true;
  // The selection contains shell points only, and vertices of curved faces are not shell points.
  return haveFacetCorners(at_start, margin_m, state_.selection.refined);
}

// True if the step moves the bodies so far along curved faces that the planes of known points do not suffice:
// a concave face bends from its plane towards the point; or the sampling error (the gap between two shell
// points of a round face is smaller than at the points) and the deviation together exceed the contact margin.
bool PairCheck::leavesCurve(const Motion& m, const PairView& at_start, const Candidate& c) const {
  if (c.isCrossing() || (!(c.hollow_per_m > 0) && !(c.curvature_per_m > 0))) return false;
  const double margin_m = state_.context->settings.contact_margin_m;
  const double spacing_m = at_start.shape[c.side]->models().shell->spacing_m;
  if (m.deviation_m + samplingError_m(spacing_m, c.curvature_per_m) > margin_m) return true;
  const Vec3 way = m.step.D[0] * c.p_W - m.step.D[1] * c.p_W;
  return 0.5 * c.hollow_per_m * (way - c.n_W.dot(way) * c.n_W).squaredNorm() > m.tolerated_m;
}

void PairCheck::findAmongRefined(const Motion& m, std::vector<Candidate>& missed) const {
  if (m.turnsFar(0)) return;
  if (!state_.selection.leaves_out && m.bend_m <= m.tolerated_m) return;
  const Placed at_end(*this, m.end);
  const SideView side[2] = {at_end.pair.side(0), at_end.pair.side(1)};
  for (const Candidate& c : state_.selection.refined) {
    Candidate end = m.since_selected.moved(c);
    // The normal of an edge crossing does not turn with the bodies.
    if (c.isCrossing() && !crossAt(end, side[0], side[1])) continue;
    if (!isMissed(c.distance_m, end.distance_m, m.tolerated_m)) continue;
    const double near_m = std::abs(end.distance_m) + at_end.pair.voxel_m(1 - c.side);
    if (!c.isCrossing() && !isInside(end.p_W, side[1 - c.side], near_m, m.tolerated_m)) continue;
    missed.push_back(end);
  }
}

// Finds the points that overlap by more than tolerated.
void PairCheck::findOverlaps(const Motion& m, const PairView& pair, std::vector<Candidate>& found) const {
  found.clear();
  Context& context = *state_.context;
  const double cutoff_m = std::min(std::max(m.tolerated_m, fieldError_m(pair)), queryRange_m(pair));
  RelativeMotion still;
  still.contact_margin_m = context.settings.contact_margin_m;
  findPointCandidates(pair, cutoff_m, context, found, &state_, &still);
  const SamplingError sampling(pair, found);
  std::erase_if(found, [&](Candidate& c) {
    c.predicted_m = c.distance_m;
    return c.distance_m > fieldError_m(pair, c) + sampling.of_m(c);
  });
  const double radius_m = pair.radius_m();
  reduceByCell(found, refinedLimit(context.settings), radius_m / 16, radius_m, pair.X_WS[1].inverse());
  refineAll(pair, still, context.settings, found);
  moveToFacetCorners(pair, still.contact_margin_m, found);
  std::erase_if(found, [&](const Candidate& c) { return c.distance_m >= -m.tolerated_m; });
}

// For a point that was behind its present plane at the start, and so did not enter through that plane, the
// plane that the point had at the start decides. If the point does not cross its plane of the start either,
// but was outside at the start, it slid past the edge of the face that it faced; it must leave through its
// present plane.
bool PairCheck::refineAtStart(const Motion& m, const PairView& at_start, Candidate& start,
                              Candidate& end) const {
  Candidate then = start;
  if (refineAt(at_start, m.travel_m, state_.context->settings, then)) {
    const Candidate there = m.step.moved(then);
    if (isMissed(then.distance_m, there.distance_m, m.tolerated_m)) {
      start = then;
      end = there;
      return true;
    }
  }
  if (!wasOutside(m, at_start, start)) return false;
  start.distance_m = 0;
  return true;
}

// True for a point that was behind its plane at the start, but outside the other body, beside the face of
// that plane. Bodies that begin inside each other are moved apart by the push; a point that enters a face by
// the push needs no separating velocity.
bool PairCheck::wasOutside(const Motion& m, const PairView& at_start, const Candidate& start) const {
  if (start.isCrossing() || !(start.distance_m < -m.tolerated_m)) return false;
  const double margin_m = state_.context->settings.contact_margin_m;
  const std::vector<Candidate>& refined = state_.selection.refined;
  const bool are_in_each_other = std::any_of(refined.begin(), refined.end(),
                                             [&](const Candidate& c) { return c.distance_m < -margin_m; });
  return !are_in_each_other &&
         !isInside(start.p_W, at_start.side(1 - start.side), kOutOfReach_m, m.tolerated_m);
}

void PairCheck::findAlongPath(const Motion& m, std::vector<Candidate>& missed) const {
  const Placed at_start(*this, m.start);
  const double range_m = std::max(queryRange_m(at_start.pair), m.tolerated_m);
  const int places = static_cast<int>(std::ceil(std::min<double>(m.travel_m / range_m, kMostPlaces)));
  thread_local std::vector<Candidate> entered;
  for (int k = 1; k <= places && missed.empty(); ++k) {
    const double share = static_cast<double>(k) / places;
    const Pose then[2] = {interpolate(m.start[0], m.end[0], share), interpolate(m.start[1], m.end[1], share)};
    const Placed placed(*this, then);
    findOverlaps(m, placed.pair, missed);
    const Displacement back = {{m.start[0] * then[0].inverse(), m.start[1] * then[1].inverse()}};
    const Displacement onward = {{m.end[0] * then[0].inverse(), m.end[1] * then[1].inverse()}};
    entered.clear();
    for (const Candidate& c : missed) {
      Candidate start = back.moved(c), end = onward.moved(c);
      if (m.turnsFar(share)) continue;  // a later place along the path decides
      if (m.turnsFar(0)) {
        if (!measureAtStart(m, at_start.pair, start)) continue;
      } else if (start.distance_m < -m.tolerated_m && !refineAtStart(m, at_start.pair, start, end)) {
        continue;
      }
      if (isMissed(start.distance_m, end.distance_m, m.tolerated_m)) entered.push_back(end);
    }
    missed.swap(entered);
  }
}

// Measures the gap of a point at the start of the step, to the nearest surface at that time. Returns false if
// the point was inside, deeper than the step's motion.
bool PairCheck::measureAtStart(const Motion& m, const PairView& at_start, Candidate& start) const {
  if (refineAt(at_start, m.travel_m, state_.context->settings, start)) return true;
  start.distance_m = m.travel_m;
  return !isInside(start.p_W, at_start.side(1 - start.side), m.travel_m, m.tolerated_m);
}

void PairCheck::emit(const Motion& m, std::vector<Candidate>& missed, std::vector<MissedContact>& out) {
  for (Candidate& c : missed) c.predicted_m = c.distance_m;
  const Placed at_start(*this, m.start);
  reduceBySpread(missed, kMostAdded, at_start.pair.radius_m(), state_.context->settings.contact_margin_m,
                 m.start[1].R.transpose());
  for (const Candidate& end : missed) {
    Candidate start = m.step.inverse().moved(end);
    if (m.turnsFar(0) && !end.isCrossing()) measureAtStart(m, at_start.pair, start);
    put(m, at_start, start, end, out);
    if (wasOutside(m, at_start.pair, start)) out.back().kept_m = 0;
  }
}

// The contact acts with its lever and normal at one time within the step (StepPath). With the point at the
// start and the plane at the end, the normal would be turned relative to the lever by the step's rotation. At
// 2 degrees per step this error is two thirds of the slope of a screw's thread, and would brake the screw.
void PairCheck::put(const Motion& m, const Placed& at_start, const Candidate& start, const Candidate& end,
                    std::vector<MissedContact>& out) {
  MissedContact added;
  added.point = state_.writer->put(m.path.acting(start, end), at_start.pair.wrapper, state_.motion);
  for (int i = 0; i < 2; ++i) added.object[i] = object_[i];
  added.end_gap_m = end.distance_m;
  added.kept_m = overlapOf(start, at_start.pair);
  out.push_back(added);
}

}  // namespace vps::bullet
