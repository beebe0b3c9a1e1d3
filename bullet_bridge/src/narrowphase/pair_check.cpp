// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/pair_check.h"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>
#include <cmath>

#include "narrowphase/carried_contact.h"
#include "narrowphase/contact_selection.h"
#include "narrowphase/contacts_there.h"
#include "narrowphase/curved_contact.h"
#include "narrowphase/facet_corners.h"
#include "narrowphase/feature_check.h"
#include "narrowphase/sampling_error.h"
#include "narrowphase/step_path.h"
#include "native_shapes/primitive.h"
#include "vps/contact_tolerances.h"
#include "vps_bullet/turn.h"

namespace vps::bullet::inline v0 {

namespace {

// A contact that carries load ends the step no farther apart than this.
double apartOf_m(const Settings& settings) {
  return kApartShare * settings.contact_margin_m;
}

double turn_rad(const Mat3& R) {
  return rotationVector(R).norm();
}

// True if the overlap at the end is more than tolerated, and more than it was.
bool isMissed(double start_m, double end_m, double tolerated_m) {
  return end_m < -tolerated_m && end_m < start_m - kGrowthShare * tolerated_m;
}

}  // namespace

/// Both bodies at other poses than Bullet's.
struct PairCheck::Placed {
  btTransform X_WS[2];
  btCollisionObjectWrapper wrapper0, wrapper1;
  PairView pair;

  Placed(const PairCheck& check, const Pose (&X)[2])
      : X_WS{toBt(X[0]), toBt(X[1])},
        wrapper0(nullptr, check.shape_[0], check.object_[0], X_WS[0], -1, -1),
        wrapper1(nullptr, check.shape_[1], check.object_[1], X_WS[1], -1, -1),
        pair(&wrapper0, &wrapper1) {}
  Placed(const Placed&) = delete;
  Placed& operator=(const Placed&) = delete;
};

/// The solved step.
struct PairCheck::Motion {
  Pose start[2], end[2];        ///< of the shapes
  Displacement step;            ///< from start to end
  Displacement since_selected;  ///< from where the contacts were selected to the end
  double tolerated_m = 0;
  double travel_m = 0;     ///< greatest of a point of the smaller body relative to the other body
  double deviation_m = 0;  ///< greatest from where the selection predicted the point
  double turn_rad = 0, turn_deviation_rad = 0;  ///< the same of the rotation
  StepPath path;
  Vec3 center_W = Vec3::Zero();                        ///< of the smaller body at the start
  double radius_m = 0;                                 ///< of the smaller body
  Vec3 moved_W = Vec3::Zero(), turned = Vec3::Zero();  ///< of body 0 relative to body 1
  double bend_m = 0;                                   ///< how far a point's path may bend from its tangent

  /// True if the bodies turn too far against each other from a share of the step to its end for a plane to be
  /// carried along: on a curved face another plane is the nearest one then.
  [[nodiscard]] bool turnsFar(double share) const { return (1 - share) * turn_rad > kContactTurn_rad; }
};

void PairCheck::setBodies(const PairView& pair) {
  is_of_this_step_ = true;
  for (int i = 0; i < 2; ++i) {
    object_[i] = pair.wrapper[i]->getCollisionObject();
    shape_[i] = pair.wrapper[i]->getCollisionShape();
    root_[i] = object_[i]->getCollisionShape();
    X_BS_[i] = fromBt(object_[i]->getWorldTransform()).inverse() * pair.X_WS[i];
  }
}

bool PairCheck::isValid() const {
  if (!is_of_this_step_ || !state_.selection.is_valid) return false;
  for (int i = 0; i < 2; ++i) {
    if (object_[i]->getCollisionShape() != root_[i]) return false;
    const auto* shape = dynamic_cast<const Shape*>(shape_[i]);
    if (shape && shape->revision() != state_.revision[i]) return false;
  }
  return true;
}

bool PairCheck::read(const Pose (&X_WB_end)[2], Motion& m) const {
  const Selection& selection = state_.selection;
  const Pose selected[2] = {selection.X_W0, selection.X_W0 * selection.X_01};
  m.tolerated_m = kToleratedShare * state_.context->settings.contact_margin_m;
  for (int i = 0; i < 2; ++i) {
    m.start[i] = fromBt(object_[i]->getWorldTransform()) * X_BS_[i];
    m.end[i] = X_WB_end[i] * X_BS_[i];
    if (!m.end[i].isFinite()) return false;
    m.step.D[i] = m.end[i] * m.start[i].inverse();
    m.since_selected.D[i] = m.end[i] * selected[i].inverse();
  }
  const Pose X_WB[2] = {fromBt(object_[0]->getWorldTransform()), fromBt(object_[1]->getWorldTransform())};
  m.path = StepPath(object_, X_WB, X_WB_end, state_.motion.dt_s);
  return true;
}

void PairCheck::measure(const PairView& start, Motion& m) const {
  m.center_W = start.center_W();
  m.radius_m = start.radius_m();
  m.moved_W = m.step.D[0] * m.center_W - m.step.D[1] * m.center_W;
  m.turned = rotationVector(m.step.D[0].R * m.step.D[1].R.transpose());
  m.turn_rad = m.turned.norm();
  m.travel_m = m.moved_W.norm() + m.turn_rad * m.radius_m;
  for (int i = 0; i < 2; ++i) {
    const double angle_rad = vps::bullet::turn_rad(m.step.D[i].R);
    const double lever_m =
        m.radius_m + (m.center_W - fromBt(object_[i]->getWorldTransform().getOrigin())).norm();
    m.bend_m += 0.5 * angle_rad * angle_rad * lever_m + angle_rad * m.travel_m;
  }
  const double dt_s = state_.motion.dt_s;
  const Twist& V = state_.selection.V;
  const Vec3 predicted = dt_s * (V.v + V.w.cross(m.center_W));
  m.turn_deviation_rad = (m.turned - dt_s * V.w).norm();
  m.deviation_m = (m.moved_W - predicted).norm() + m.turn_deviation_rad * m.radius_m + m.bend_m;
}

void PairCheck::linearise(const Pose (&X_WB_end)[2], std::vector<MissedContact>& out) {
  if (state_.contacts.empty() || !isValid()) return;
  Motion m;
  if (!read(X_WB_end, m)) return;
  const Placed at_start(*this, m.start);
  measure(at_start.pair, m);
  if (!(m.bend_m > kRounding_m) || m.turnsFar(0)) return;
  relinearise(m, at_start, true, out);
}

void PairCheck::findMissed(const Pose (&X_WB_end)[2], int round, std::vector<MissedContact>& out) {
  if (!isValid()) return;
  Motion m;
  if (!read(X_WB_end, m)) return;
  const Placed at_start(*this, m.start);
  measure(at_start.pair, m);
  if (!(m.travel_m > 0)) return;
  const double near_m = std::max(state_.context->settings.contact_margin_m, FeatureMotion::kRest_m);
  if (at_start.pair.leastDistance_m() > m.travel_m + near_m) return;
  if (spinsFreely(at_start.pair, m.end, state_)) return;
  const std::size_t had = out.size();
  if (hasFeatures(at_start.pair, state_.context->settings)) {
    addFeatureContacts(at_start.pair, {{m.end[0], m.end[1]}, m.path, m.turnsFar(0)}, round == 0, state_, out);
    if (out.size() > had) state_.is_incomplete = true;
  }
  if (m.travel_m <= m.tolerated_m) return;
  // In a step with so much rotation many facets of round parts pass each other: contacts that follow each of
  // them brake a shaft in its bore. What may protrude from a facet elsewhere is tolerated here.
  if (m.turnsFar(0)) m.tolerated_m = kFacetCornerShare * state_.context->settings.contact_margin_m;
  thread_local std::vector<Candidate> missed;
  missed.clear();
  findAmongRefined(m, missed);
  if (missed.empty() && out.size() == had && mayMissPoints(m, at_start.pair)) findAlongPath(m, missed);
  if (!missed.empty()) {
    emit(m, missed, out);
    state_.is_incomplete = true;
    return;
  }
  if (round < kMostRetakes && out.size() == had && m.bend_m > apartOf_m(state_.context->settings) &&
      !m.turnsFar(0))
    relinearise(m, at_start, false, out);
}

// Between two curved bodies a row is taken anew only in the plane that it had: the plane of the next facet is
// another contact, and rows that go from facet to facet never settle. Without rows taken anew a frictionless
// bolt loses 2.2 % of its acceleration; with those of the next facet a peg in a bore of 10 um clearance stays
// out.
//
// The rows of the step's contacts as they are at the end of a motion.
// @param is_before  before the step is solved: those for which it matters where they are taken. Otherwise
// those that carry load and end the step apart: of a body that rolls, the contacts in front of it, which come
// down but do not arrive, and those that it leaves.
void PairCheck::relinearise(const Motion& m, const Placed& at_start, bool is_before,
                            std::vector<MissedContact>& out) {
  const Settings& settings = state_.context->settings;
  const double apart_m = apartOf_m(settings);
  if (hasFeatures(at_start.pair, settings))
    lineariseFeatures(at_start.pair, {{m.end[0], m.end[1]}, m.path, m.turnsFar(0)}, {is_before, apart_m},
                      state_, out);
  if (!settings.use_surfaces) return;
  const bool are_both_curved = areBothCurved(at_start.pair, state_);
  if (is_before && are_both_curved) return;
  const double least_cos = are_both_curved ? kCosSamePlane : kCosSameFace;
  const Placed at_end(*this, m.end);
  thread_local std::vector<Candidate> now, ends;
  findThere(at_end.pair, state_, !is_before || m.bend_m <= apart_m, now, ends);
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const bool is_same = ends[k].n_W.dot(m.step.normal(now[k])) > least_cos &&
                         ends[k].distance_m < settings.contact_margin_m + m.travel_m;
    if (is_same && isOutOfPlace(now[k], ends[k], m.path, {is_before, apart_m}, settings))
      put(m, at_start, now[k], ends[k], out);
  }
}

double PairCheck::freeShare(const Pose (&X_WB_end)[2]) {
  if (!isValid()) return 1;
  const Pose start[2] = {fromBt(object_[0]->getWorldTransform()) * X_BS_[0],
                         fromBt(object_[1]->getWorldTransform()) * X_BS_[1]};
  const EndPoses end = {{X_WB_end[0] * X_BS_[0], X_WB_end[1] * X_BS_[1]}};
  const Placed at_start(*this, start);
  if (!end.X_WS[0].isFinite() || !end.X_WS[1].isFinite()) return 1;
  if (!hasFeatures(at_start.pair, state_.context->settings)) return 1;
  return freeShareOf(at_start.pair, end, state_);
}

// Of points that are deeper before the step than allowed, a share that lets them go a little deeper: what is
// jammed goes on.
double PairCheck::freeShareOfPoints(const Pose (&X_WB_end)[2]) {
  Motion m;
  if (!isValid() || !read(X_WB_end, m)) return 1;
  const Placed at_start(*this, m.start);
  measure(at_start.pair, m);
  m.tolerated_m = kUnsolvedShare * state_.context->settings.contact_margin_m;
  const double slack_m = kGrowthShare * m.tolerated_m;
  if (m.travel_m <= slack_m) return 1;
  thread_local std::vector<Candidate> missed;
  missed.clear();
  findAmongRefined(m, missed);
  if (missed.empty() && mayMissPoints(m, at_start.pair)) findAlongPath(m, missed);
  double share = 1;
  for (const Candidate& end : missed) {
    Candidate start = m.step.inverse().moved(end);
    if (m.turnsFar(0) && !end.isCrossing()) measureAtStart(m, at_start.pair, start);
    const double way_m = start.distance_m - end.distance_m;
    if (!(way_m > slack_m)) continue;  // along another plane it went in, or not at all
    share = std::min(share, std::max(start.distance_m + m.tolerated_m, slack_m) / way_m);
  }
  return share;
}

// Points out of reach had a greater gap than this at the predicted end of the step, so they do not touch if
// the deviation is less. Or they were out of reach of this motion in any direction.
bool PairCheck::mayMissPoints(const Motion& m, const PairView& at_start) const {
  const double margin_m = state_.context->settings.contact_margin_m;
  const bool is_in_reach = !state_.selection.is_of_path &&
                           (m.deviation_m <= margin_m || m.travel_m <= margin_m + state_.selection.any_way_m);
  // Among neighbours, those nearest now and at the predicted end were selected; another becomes nearer if the
  // part turns otherwise.
  const double sampling_m = state_.selection.sampling_m * std::min(m.turn_rad, m.turn_deviation_rad);
  if (!is_in_reach || sampling_m > m.tolerated_m) return true;
  if (std::any_of(state_.selection.refined.begin(), state_.selection.refined.end(),
                  [&](const Candidate& c) { return leavesCurve(m, at_start, c); }))
    return true;
  // Vertices of curved faces are no points.
  return haveFacetCorners(at_start, margin_m, state_.selection.refined);
}

// True where the step takes the bodies so far along curved faces that the planes of known points do not tell:
// a hollow face bends off its plane towards the point, and between the points of round faces gaps are smaller
// by more than what is left of the margin.
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
    // Where edges cross, the normal turns otherwise than the bodies do.
    if (c.isCrossing() && !crossAt(end, side[0], side[1])) continue;
    if (!isMissed(c.distance_m, end.distance_m, m.tolerated_m)) continue;
    const double near_m = std::abs(end.distance_m) + at_end.pair.voxel_m(1 - c.side);
    if (!c.isCrossing() && !isInside(end.p_W, side[1 - c.side], near_m, m.tolerated_m)) continue;
    missed.push_back(end);
  }
}

// Points that overlap by more than tolerated.
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
  reduceByCell(found, refinedLimit(context.settings), radius_m / 16, radius_m);
  refineAll(pair, still, context.settings, found);
  moveToFacetCorners(pair, still.contact_margin_m, found);
  std::erase_if(found, [&](const Candidate& c) { return c.distance_m >= -m.tolerated_m; });
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
      if (m.turnsFar(share)) continue;  // later places tell
      if (m.turnsFar(0)) {
        if (!measureAtStart(m, at_start.pair, start)) continue;
      } else if (start.distance_m < -m.tolerated_m) {
        // It was behind this plane before, so it did not enter through it. The plane that it had then
        // decides.
        if (!refineAt(at_start.pair, m.travel_m, state_.context->settings, start)) continue;
        end = m.step.moved(start);
      }
      if (isMissed(start.distance_m, end.distance_m, m.tolerated_m)) entered.push_back(end);
    }
    missed.swap(entered);
  }
}

// The gap that a point had before the step, of whatever was nearest to it then. False: it was inside, deeper
// than the step's motion.
bool PairCheck::measureAtStart(const Motion& m, const PairView& at_start, Candidate& start) const {
  if (refineAt(at_start, m.travel_m, state_.context->settings, start)) return true;
  start.distance_m = m.travel_m;
  return !isInside(start.p_W, at_start.side(1 - start.side), m.travel_m, m.tolerated_m);
}

void PairCheck::emit(const Motion& m, std::vector<Candidate>& missed, std::vector<MissedContact>& out) {
  for (Candidate& c : missed) c.predicted_m = c.distance_m;
  const Placed at_start(*this, m.start);
  reduceBySpread(missed, kMostAdded, at_start.pair.radius_m(), state_.context->settings.contact_margin_m);
  for (const Candidate& end : missed) {
    Candidate start = m.step.inverse().moved(end);
    if (m.turnsFar(0) && !end.isCrossing()) measureAtStart(m, at_start.pair, start);
    put(m, at_start, start, end, out);
  }
}

// The contact acts where it is on the way of the step: with its lever and normal there. With the point moved
// back and the plane of the other body as it is, the lever would be turned against the normal by the step's
// rotation, and contact would brake a screw that turns by 2 degrees a step by two thirds of the slope of its
// thread.
void PairCheck::put(const Motion& m, const Placed& at_start, const Candidate& start, const Candidate& end,
                    std::vector<MissedContact>& out) {
  MissedContact added;
  added.point = state_.writer->put(m.path.acting(start, end), at_start.pair.wrapper, state_.motion);
  for (int i = 0; i < 2; ++i) added.object[i] = object_[i];
  added.end_gap_m = end.distance_m;
  added.kept_m = overlapOf(start, at_start.pair);
  out.push_back(added);
}

}  // namespace vps::bullet::inline v0
