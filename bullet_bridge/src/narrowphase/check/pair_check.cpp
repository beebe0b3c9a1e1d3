// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/check/pair_check.h"

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>
#include <cmath>

#include "narrowphase/check/checked_step.h"
#include "narrowphase/check/contact_at_pose.h"
#include "narrowphase/check/feature_check.h"
#include "narrowphase/check/step_path.h"
#include "narrowphase/refinement/curved_contact.h"
#include "narrowphase/selection/contact_selection.h"
#include "native_shapes/native_shape.h"
#include "vps/contact_tolerances.h"
#include "vps_bullet/turn.h"

namespace vps::bullet {

namespace {

// Greatest gap at which a contact that carries load may end the step.
double apartOf_m(const Settings& settings) {
  return kApartShare * settings.contact_margin_m;
}

double turn_rad(const Mat3& R) {
  return rotationVector(R).norm();
}

}  // namespace

void PairCheck::setBodies(const PairView& pair) {
  is_of_this_step_ = true;
  state_.let_go.clear();
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
  relinearise(m, at_start, {Relinearising::Rows::Predicted, apartOf_m(state_.context->settings)}, out);
}

// Checks features, then points.
void PairCheck::findOnWay(Motion& m, const Placed& at_start, CheckRound round,
                          std::vector<MissedContact>& out) {
  const std::size_t had = out.size();
  if (hasFeatures(at_start.pair, state_.context->settings))
    addFeatureContacts(at_start.pair, {{m.end[0], m.end[1]}, m.path, m.turnsFar(0)}, round, state_, out);
  if (m.travel_m <= m.tolerated_m) return;
  // In a step with so much rotation many facets of round parts pass each other, and contacts that follow each
  // facet would brake a shaft in its bore. The height of a facet's corners is therefore tolerated.
  if (m.turnsFar(0)) m.tolerated_m = kFacetCornerShare * state_.context->settings.contact_margin_m;
  thread_local std::vector<Candidate> missed;
  missed.clear();
  findAmongRefined(m, missed);
  if (missed.empty() && out.size() == had && mayMissPoints(m, at_start.pair)) findAlongPath(m, missed);
  if (!missed.empty()) emit(m, missed, out);
}

void PairCheck::findMissed(const Pose (&X_WB_end)[2], CheckRound round, std::vector<MissedContact>& out) {
  if (!isValid()) return;
  Motion m;
  if (!read(X_WB_end, m)) return;
  const Placed at_start(*this, m.start);
  measure(at_start.pair, m);
  if (!(m.travel_m > 0)) return;
  const double near_m = std::max(state_.context->settings.contact_margin_m, FeatureMotion::kRest_m);
  if (at_start.pair.leastDistance_m() > m.travel_m + near_m) return;
  const std::size_t had = out.size();
  const Pose X_01_end = m.end[0].inverse() * m.end[1];
  const double same_m = FeatureMotion::kMissedShare * restGap_m(at_start.pair, state_.context->settings);
  if (m.turnsFar(0) || !state_.clear_way.covers(at_start.pair, X_01_end, round.isFirst(), same_m)) {
    if (spinsFreely(at_start.pair, m.end, state_)) return;
    if ((round.isLate() || !round.is_own) && m.turnsFar(0)) m.path.settle();
    findOnWay(m, at_start, round, out);
    if (out.size() != had)
      state_.is_incomplete = true;
    else if (!round.isLate() && !m.turnsFar(0))
      state_.clear_way.remember(at_start.pair, X_01_end, round.isFirst());
  }
  if (m.travel_m <= m.tolerated_m) return;
  const double apart_m = apartOf_m(state_.context->settings);
  if (!round.mayRetake() || out.size() != had || !(m.bend_m > apart_m)) return;
  if (m.turnsFar(0) && areBothCurved(at_start.pair, state_)) return;
  relinearise(m, at_start, {Relinearising::Rows::Loaded, apart_m}, out);
  // If only the loaded rows were computed again, they would pass their load to neighbouring rows, which would
  // still have the wrong lever and normal.
  if (out.size() != had) relinearise(m, at_start, {Relinearising::Rows::Others, apart_m}, out);
}

// Between two curved bodies a row is computed again only in the plane that it had. The plane of the next
// facet belongs to another contact; if rows could change from facet to facet, the rounds of the solver would
// not converge. Without rows that are computed again a frictionless bolt loses 2.2 % of its acceleration;
// with rows of the next facet a peg does not enter a bore of 10 um clearance.
//
// Appends the rows of the step's contacts, computed from the end poses of a motion. Before the step is
// solved, these are the contacts whose row depends on the poses from which it is computed. After the step is
// solved, these are contacts that carry load and end the step apart (under a rolling body, contacts in front
// of it that do not arrive, and contacts that it leaves), and contacts that would get their load.
void PairCheck::relinearise(const Motion& m, const Placed& at_start, const Relinearising& which,
                            std::vector<MissedContact>& out) {
  const Settings& settings = state_.context->settings;
  if (hasFeatures(at_start.pair, settings))
    lineariseFeatures(at_start.pair, {{m.end[0], m.end[1]}, m.path, m.turnsFar(0)}, which, state_, out);
  if (!settings.use_surfaces) return;
  const bool are_both_curved = areBothCurved(at_start.pair, state_);
  if (which.isBefore() && are_both_curved) return;
  const double least_cos = are_both_curved ? kCosSamePlane : kCosSameFace;
  const Placed at_end(*this, m.end);
  thread_local std::vector<Candidate> now, ends;
  const bool only_loaded = which.isBefore() ? m.bend_m <= which.apart_m : which.isOfLoad();
  findThere(at_end.pair, state_, only_loaded, now, ends);
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const bool is_same = ends[k].n_W.dot(m.step.normal(now[k])) > least_cos &&
                         ends[k].distance_m < settings.contact_margin_m + m.travel_m;
    if (is_same) {
      if (isOutOfPlace(now[k], ends[k], m.path, which, settings)) put(m, at_start, now[k], ends[k], out);
    } else if (which.isOfLoad() && !are_both_curved && ends[k].distance_m > ends[k].rest_m + which.apart_m &&
               state_.letGo(now[k].key())) {
      // The contact carries load but faces nothing: its plane extends beyond the face that it was taken from.
      Candidate end = m.step.moved(now[k]);
      end.distance_m = kOutOfReach_m;
      put(m, at_start, now[k], end, out);
      out.back().is_let_go = true;
    }
  }
}

double PairCheck::freeShare(const Pose (&X_WB_end)[2]) {
  Motion m;
  if (!isValid() || !read(X_WB_end, m)) return 1;
  const Placed at_start(*this, m.start);
  measure(at_start.pair, m);
  if (!hasFeatures(at_start.pair, state_.context->settings)) return 1;
  return freeShareOf(at_start.pair, {{m.end[0], m.end[1]}, m.path, m.turnsFar(0)}, state_);
}

// Points that are deeper than allowed before the step may go a little deeper, so that jammed bodies are not
// frozen.
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
    if (!(way_m > slack_m)) continue;  // the point entered along another plane, or did not enter
    share = std::min(share, std::max(start.distance_m + m.tolerated_m, slack_m) / way_m);
  }
  return share;
}

}  // namespace vps::bullet
