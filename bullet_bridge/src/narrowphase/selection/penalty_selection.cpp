// SPDX-License-Identifier: BSD-3-Clause
// Penalty contact: selects every point that can touch.
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>
#include <span>

#include "narrowphase/pair/pair_view.h"
#include "narrowphase/selection/contact_selection.h"
#include "solver/penalty/penalty_pair.h"
#include "vps/contact_tolerances.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {

namespace {

// Refines the points on edges. A point on an edge has no normal of its own, and the field has its greatest
// errors near the other side's edges: 14 um at the root of an M10 thread with voxels of 0.2 mm, with normals
// that follow the grid. A nut supported by unrefined points lost 21 % of its acceleration.
void refinePenaltyPoints(const PairView& pair, const RelativeMotion& motion, const Settings& settings,
                         std::vector<Candidate>& candidates) {
  // Candidates of a fast body were found elsewhere along its path.
  if (!settings.use_surfaces || motion.contact_margin_m + motion.speed_m_s * motion.dt_s > queryRange_m(pair))
    return;
  Pose way[2];
  coast(pair, motion.dt_s, way);
  for (int i = 0; i < 2; ++i)
    if (pair.hasShell(i))
      refineEdges(candidates, pair.side(i), pair.side(1 - i), *pair.wrapper[1 - i]->getCollisionShape(), way,
                  motion);
  dropUnreachable(motion, candidates);
}

// Selects all points that can touch, and a few of them for the manifolds, which users and solvers without
// penalty contact read.
void selectPenaltyPoints(const PairView& pair, PairState& state) {
  Context& context = *state.context;
  const RelativeMotion& motion = state.motion;
  Selection& selection = state.selection;
  std::vector<Candidate>& candidates = state.contacts;
  findStepCandidates(pair, motion, state, candidates);
  ++context.pair_updates;
  context.candidates += candidates.size();
  dropUnreachable(motion, candidates);
  refinePenaltyPoints(pair, motion, context.settings, candidates);
  selection.penalty_points = candidates;
  Settings seen = context.settings;
  seen.use_surfaces = false;
  selectContacts(pair, motion, seen, state.writer.get(), candidates);
  storeSelection(candidates, pair, motion, selection);
}

// Reuses the contacts of a pair that has not moved, as reuseSelection() does in rigid contact. Here the
// motion must be unchanged too, so that points that were out of reach still are.
bool reusePenaltyPoints(const PairView& pair, PairState& state, CandidateMotion& moved) {
  const Selection& selection = state.selection;
  const RelativeMotion& motion = state.motion;
  if (!(motionChange_m(selection, pair, motion) <= kSamePlace_m) || !hasNotMoved(selection, pair, motion))
    return false;
  moved = motionSince(selection, pair);
  state.contacts = selection.contacts;
  for (Candidate& c : state.contacts) moved(c);
  return true;
}

/// Updates a pair's points from candidates (ascending by key), which `moved` carries from the poses of their
/// query to the present ones. A point that the pair had before keeps its normal force, the deflection of its
/// friction bristle (PenaltyPoint::bend_W) and the rest of its tolerated overlap.
/// @param usual_N_per_m3  stiffness per area of surfaces without a value of their own
/// @param sides  number of sides whose points are queried. Both sides share the stiffness, since their areas
/// overlap
void updatePenaltyPoints(PenaltyPair& pair, std::span<const Candidate> candidates,
                         const PairMaterial& material, double usual_N_per_m3, int sides,
                         const RelativeMotion& motion, const CandidateMotion& moved) {
  const double separation_m = kSeparation_m_s * motion.dt_s;
  const Mat3 R_W1 = fromBt(pair.object[1]->getWorldTransform().getBasis());
  const Mat3 turned = R_W1 * pair.R_W1.transpose();
  pair.R_W1 = R_W1;
  thread_local std::vector<PenaltyPoint> old;
  old.swap(pair.points);
  pair.points.resize(candidates.size());
  auto point_at = pair.points.begin();
  auto before = old.begin();
  for (Candidate c : candidates) {
    moved(c);
    PenaltyPoint& point = *point_at++ = {};
    point.key = c.key();
    point.p_W = c.p_W;
    point.n_W = c.n_W;
    point.k_N_per_m = material.stiffness_N_per_m3(c, usual_N_per_m3) / sides * c.area_m2;
    point.mu = material.friction(c, motion);
    double before_m = 0;  // zero for a new point
    while (before != old.end() && before->key < point.key) ++before;
    if (before != old.end() && before->key == point.key) {
      const Vec3 bend_W = turned * before->bend_W;
      point.bend_W = bend_W - point.n_W * point.n_W.dot(bend_W);
      point.f_n_N = before->f_n_N;
      point.is_leader = before->is_leader;
      before_m = std::min(0.0, before->gap_m);
      // In each step at most separation_m of the tolerated overlap is pressed out.
      if (before->tolerated_m > 0)
        point.tolerated_m = std::max(before->tolerated_m - separation_m, -c.distance_m - separation_m);
    }
    // The point is deeper than its approach in the step explains, so the bodies were placed into each other,
    // or another surface became the nearest.
    const double deeper_m = before_m - motion.contact_margin_m - c.distance_m;
    if (deeper_m > point.tolerated_m) {
      const double approach_m = std::max(0.0, -c.n_W.dot(motion.velocityAt(c.p_W)) * motion.dt_s) +
                                0.1 * motion.own_speed_m_s * motion.dt_s;
      point.tolerated_m = std::max(point.tolerated_m, deeper_m - approach_m);
    }
    point.tolerated_m = std::clamp(point.tolerated_m, 0.0, std::max(0.0, -c.distance_m));
    point.gap_m = c.distance_m + point.tolerated_m;
  }
}

}  // namespace

void selectPenalty(const PairView& pair, PairState& state) {
  const Context& context = *state.context;
  CandidateMotion moved;
  if (!reusePenaltyPoints(pair, state, moved)) selectPenaltyPoints(pair, state);
  for (int i = 0; i < 2; ++i) state.penalty.object[i] = pair.wrapper[i]->getCollisionObject();
  updatePenaltyPoints(state.penalty, state.selection.penalty_points,
                      PairMaterial(pair.wrapper, context.settings.friction_model),
                      context.settings.stiffness_N_per_m3, sideCount(pair, context.settings.sides),
                      state.motion, moved);
}

}  // namespace vps::bullet
