// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/algorithm.h"

#include <BulletCollision/CollisionDispatch/btConvexConcaveCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <typeinfo>

#include "candidate.h"
#include "context.h"
#include "manifold_writer.h"
#include "motion.h"
#include "partner.h"
#include "penalty_pair.h"
#include "primitive.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/shape.h"

namespace vps {

// Bullet's pool hands out elements as large as its own largest algorithm, whatever is asked for.
static_assert(sizeof(VpsAlgorithm) <= sizeof(btConvexConcaveCollisionAlgorithm));

namespace {

/// The points chosen in a full query, and where that was.
struct Selection {
  std::vector<Candidate> chosen;
  bool is_valid = false;
  Pose X_01;           ///< body 1 in body 0
  double reach_m = 0;  ///< how far the query looked
  // In penalty mode:
  std::vector<Candidate> springs;  ///< all that were
  Pose X_W0;                       ///< of body 0
  Twist V;                         ///< RelativeMotion::V
  ShapeKey key[2];                 ///< of sides that are no VpsShape
};

}  // namespace

struct VpsPairState {
  std::shared_ptr<VpsContext> context;
  std::unique_ptr<ManifoldWriter> writer;
  Selection selection;
  std::vector<Candidate> contacts;  ///< of the coming step
  RelativeMotion motion;
  bool is_prepared = false;
  PenaltyPair penalty;                   ///< in penalty mode
  bool is_registered = false;            ///< penalty is known to the solver
  std::optional<QueryMemory> memory[2];  ///< of side 0's points in side 1's map, and the reverse
  QueryMemory& memoryOf(int side, const VoxMap& map, const PointShell& shell) {
    std::optional<QueryMemory>& own = memory[side];
    return own ? *own : own.emplace(map, shell);
  }
  unsigned revision[2] = {0, 0};  ///< of the shapes that writer's and selection's ids belong to
};

namespace {

/// Both bodies of a pair at one instant.
struct PairView {
  const btCollisionObjectWrapper* wrapper[2];
  const VpsShape* vps[2];  // null: a primitive
  Pose X_WS[2];

  PairView(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1)
      : wrapper{body0, body1} {
    for (int i = 0; i < 2; ++i) {
      vps[i] = dynamic_cast<const VpsShape*>(wrapper[i]->getCollisionShape());
      X_WS[i] = fromBt(wrapper[i]->getWorldTransform());
    }
  }
  [[nodiscard]] SideView side(int i) const {
    return {vps[i], vps[i] ? X_WS[i] * vps[i]->X_SM() : X_WS[i], static_cast<std::uint8_t>(i)};
  }
  /// Changes when the size of a side does that is no VpsShape.
  [[nodiscard]] ShapeKey key(int i) const {
    return vps[i] ? ShapeKey{} : keyOf(*wrapper[i]->getCollisionShape());
  }
  [[nodiscard]] bool hasShell(int i) const { return vps[i] && vps[i]->models().shell; }
  [[nodiscard]] bool hasMap(int i) const { return vps[i] && vps[i]->models().map; }
  [[nodiscard]] bool canLookBothWays() const { return hasMap(0) && hasMap(1) && hasShell(0) && hasShell(1); }
  /// Half the diagonal of the smaller body.
  [[nodiscard]] double radius_m() const {
    double radius_m = 1e30;
    for (const VpsShape* shape : vps)
      if (shape) radius_m = std::min(radius_m, 0.5 * shape->bounds().size().norm());
    return std::max(radius_m, 1e-6);
  }
  /// Centre of the smaller VpsShape, in W.
  [[nodiscard]] Vec3 center_W() const {
    const bool second =
        !vps[0] || (vps[1] && vps[1]->bounds().size().norm() < vps[0]->bounds().size().norm());
    const int i = second ? 1 : 0;
    return X_WS[i] * vps[i]->bounds().center();
  }
};

RelativeMotion relativeMotion(const PairView& pair, double dt_s, double slack_m) {
  RelativeMotion motion;
  motion.dt_s = dt_s;
  motion.slack_m = slack_m;
  if (!(dt_s > 0)) return motion;
  const auto relative = [&](bool with_couplings) {
    const Twist V0 = predictedVelocity(*pair.wrapper[0]->getCollisionObject(), dt_s, with_couplings);
    const Twist V1 = predictedVelocity(*pair.wrapper[1]->getCollisionObject(), dt_s, with_couplings);
    return Twist{V0.w - V1.w, V0.v - V1.v};
  };
  const auto greatestSpeed = [&](const Twist& V) {
    return (V.v + V.w.cross(pair.center_W())).norm() + V.w.norm() * pair.radius_m();
  };
  motion.V = relative(true);
  motion.speed_m_s = greatestSpeed(motion.V);
  motion.own_speed_m_s = greatestSpeed(relative(false));
  return motion;
}

// The band bounds how far the fields can see.
double sight_m(const PairView& pair) {
  double sight_m = 1e30;
  for (const VpsShape* shape : pair.vps)
    if (shape && shape->models().map) sight_m = std::min(sight_m, 0.95 * shape->models().map->band_m());
  return sight_m;
}

// The next of a row of lengths, each half as long again: a query's memory is for one cutoff.
double roundedUp(double cutoff_m, double most_m) {
  constexpr double kStep = 1.5, kUnit_m = 1e-6;
  const double steps = std::ceil(std::log(cutoff_m / kUnit_m) / std::log(kStep));
  return std::min(kUnit_m * std::pow(kStep, steps), most_m);
}

// All points near the other side, both ways if the settings say so. With a pair's memory at least those: what
// the last steps' distances exclude is not read.
void collect(const PairView& pair, double cutoff_m, VpsContext& context, std::vector<Candidate>& out,
             VpsPairState* state = nullptr) {
  std::size_t tested = 0, left_out = 0;
  // One-sided: the smaller body's points, since a larger one's may be too far apart to catch it.
  int only = -1;
  if (context.settings.sides == Sides::One && pair.canLookBothWays())
    only = pair.vps[0]->bounds().size().norm() <= pair.vps[1]->bounds().size().norm() ? 0 : 1;
  for (int i = 0; i < 2; ++i) {
    if (!pair.hasShell(i) || (only >= 0 && i != only)) continue;
    const int j = 1 - i;
    if (isPrimitive(*pair.wrapper[j]->getCollisionShape()))
      left_out += collectFromPrimitive(pair.side(i), *pair.wrapper[j]->getCollisionShape(), pair.X_WS[j],
                                       cutoff_m, context.settings, out, tested);
    else if (pair.hasMap(j)) {
      const VoxMap& map = *pair.vps[j]->models().map;
      QueryMemory* memory = state ? &state->memoryOf(i, map, *pair.vps[i]->models().shell) : nullptr;
      const double wide_m = memory ? roundedUp(cutoff_m, sight_m(pair)) : cutoff_m;
      left_out += collectFromMap(pair.side(i), pair.side(j), wide_m, context.settings, out, tested, memory);
    } else {
      left_out += collectFromSurfaces(pair.side(i), pair.side(j), cutoff_m, context.settings, out, tested);
    }
  }
  context.points_tested += tested;
  context.left_out += left_out;
}

// Where both bodies are after a share of the step, moving freely.
void advance(PairView& pair, const PairView& start, double dt_s) {
  for (int i = 0; i < 2; ++i) {
    const Twist V = predictedVelocity(*pair.wrapper[i]->getCollisionObject(), dt_s > 0 ? dt_s : 0);
    const Mat3 R = rotationFromVector(V.w * dt_s);
    pair.X_WS[i] = Pose(Mat3(R * start.X_WS[i].R), R * start.X_WS[i].p + V.v * dt_s);
  }
}

// In penalty mode the points of faces press along their own normals.
void takeSpringNormals(const PairView& pair, const VpsBulletSettings& settings,
                       std::vector<Candidate>& candidates) {
  for (int i = 0; i < 2; ++i)
    if (settings.mode == ContactMode::Penalty && pair.hasShell(i)) takeOwnNormals(candidates, pair.side(i));
}

// Candidates of the step. A body that moves less than the fields can see is looked at once, where it is. A
// faster one is looked at along its way, so that it cannot pass through; the plane it first meets then holds
// for the whole step.
void collectForStep(const PairView& pair, const RelativeMotion& motion, VpsPairState& state,
                    std::vector<Candidate>& out) {
  VpsContext& context = *state.context;
  const double sight = sight_m(pair);
  const double travel_m = motion.speed_m_s * motion.dt_s;
  if (motion.slack_m + travel_m <= sight) {
    collect(pair, motion.slack_m + travel_m, context, out, &state);
    takeSpringNormals(pair, context.settings, out);
    return;
  }
  const double stride_m = std::max(0.5 * (sight - motion.slack_m), 0.25 * sight);
  constexpr double kMostStrides = 1000;  // 0.5 m a step at a voxel of 0.25 mm
  const int strides = static_cast<int>(std::ceil(std::min(travel_m / stride_m, kMostStrides)));
  PairView later = pair;
  for (int k = 0; k < strides && out.empty(); ++k) {
    const double t_s = motion.dt_s * k / strides;
    if (k > 0) advance(later, pair, t_s);
    collect(later, std::min(motion.slack_m + travel_m / strides, sight), context, out);
    takeSpringNormals(later, context.settings, out);
    // Keep what is met in this stride, as planes seen from where the bodies are now.
    std::erase_if(out, [&](Candidate& c) {
      const Vec3 moved = motion.velocityAt(c.p_W) * t_s;
      const double approach_m = -c.n_W.dot(motion.velocityAt(c.p_W)) * motion.dt_s / strides;
      if (c.distance_m - approach_m > motion.slack_m) return true;
      c.distance_m -= c.n_W.dot(moved);
      const Pose& X_then = later.X_WS[c.side];
      c.p_W = pair.X_WS[c.side] * (X_then.inverse() * c.p_W);
      return false;
    });
  }
}

// Where the bodies go in the step if they keep their velocities.
void coast(const PairView& pair, double dt_s, Pose (&way)[2]) {
  for (int i = 0; i < 2; ++i) {
    const btCollisionObject& object = *pair.wrapper[i]->getCollisionObject();
    const Twist V = predictedVelocity(object, 0, false);
    const Vec3 center = fromBt(object.getWorldTransform().getOrigin());
    const Mat3 R = rotationFromVector(V.w * dt_s);
    way[i] = Pose(R, center + (V.v + V.w.cross(center)) * dt_s - R * center);
  }
}

void correctAll(const PairView& pair, const RelativeMotion& motion, const VpsBulletSettings& settings,
                std::vector<Candidate>& candidates) {
  if (!settings.use_surfaces) return;
  for (int i = 0; i < 2; ++i)
    if (pair.hasShell(i))
      correct(candidates, pair.side(i), pair.side(1 - i), *pair.wrapper[1 - i]->getCollisionShape(), motion);
}

void dropUnreachable(const RelativeMotion& motion, std::vector<Candidate>& candidates) {
  std::erase_if(candidates, [&](Candidate& c) { return !motion.canTouch(c); });
}

// From thousands of near points to the few that hold the part. `writer` knows last step's contacts; may be
// null.
void choose(const PairView& pair, const RelativeMotion& motion, const VpsBulletSettings& settings,
            ManifoldWriter* writer, std::vector<Candidate>& candidates) {
  dropUnreachable(motion, candidates);
  if (writer) writer->recall(candidates);
  const auto limit = static_cast<std::size_t>(settings.contact_limit);
  const double radius_m = pair.radius_m();
  // Four times the limit go to the exact surfaces: enough for some to prove out of reach, and no more than
  // the step's time allows (about 0.5 us each).
  for (double cell_m = radius_m / 16; candidates.size() > 4 * limit && cell_m < radius_m; cell_m *= 2)
    thinOut(candidates, cell_m);
  correctAll(pair, motion, settings, candidates);
  dropUnreachable(motion, candidates);
  chooseSpread(candidates, limit, radius_m, settings.slack_m);
}

void keepSelection(const std::vector<Candidate>& chosen, const PairView& pair, const RelativeMotion& motion,
                   Selection& selection) {
  selection.chosen = chosen;
  selection.is_valid = true;
  selection.X_01 = pair.X_WS[0].inverse() * pair.X_WS[1];
  selection.reach_m = motion.slack_m + motion.speed_m_s * motion.dt_s;
}

constexpr double kStill_m =
    1e-6;  // assumed: below it no other point would be worth more than the chosen ones

bool isWhereItWas(const Selection& selection, const PairView& pair, const RelativeMotion& motion) {
  if (!selection.is_valid) return false;
  if (motion.slack_m + motion.speed_m_s * motion.dt_s > selection.reach_m + kStill_m) return false;
  const Pose X_01 = pair.X_WS[0].inverse() * pair.X_WS[1];
  const Pose moved = X_01 * selection.X_01.inverse();  // of body 1, in body 0
  const Vec3 center_0 = pair.X_WS[0].inverse() * pair.center_W();
  const double turned_rad = (moved.R - Mat3::Identity()).norm();
  return (moved * center_0 - center_0).norm() + turned_rad * pair.radius_m() <= kStill_m;
}

// A part that has not moved since its points were chosen keeps them: only their distances are looked up anew.
// At rest that is all the work there is. False: choose anew.
bool recallSelection(const Selection& selection, const PairView& pair, const RelativeMotion& motion,
                     const VpsBulletSettings& settings, std::vector<Candidate>& out) {
  if (!isWhereItWas(selection, pair, motion)) return false;
  for (Candidate c : selection.chosen) {
    lookUp(pair.side(c.side), pair.side(1 - c.side), *pair.wrapper[1 - c.side]->getCollisionShape(), settings,
           c);
    out.push_back(c);
  }
  correctAll(pair, motion, settings, out);
  dropUnreachable(motion, out);
  return true;
}

// Point ids do not outlive the models they belong to.
void forgetReplacedModels(VpsPairState& state, const PairView& pair) {
  for (int i = 0; i < 2; ++i) {
    const unsigned revision = pair.vps[i] ? pair.vps[i]->revision() : 0;
    if (state.revision[i] == revision) continue;
    state.revision[i] = revision;
    state.selection.is_valid = false;
    state.penalty.points.clear();
    for (auto& memory : state.memory) memory.reset();
    state.writer->forget();
  }
}

void prepareRestitution(std::vector<Candidate>& candidates, const RelativeMotion& motion,
                        const btCollisionObject* object0, const btCollisionObject* object1) {
  // The solver takes the gap off the rebound's speed, which kills a bounce that would happen within the step.
  // So a point that bounces does so at once: early by less than a step's travel, with the right energy.
  if (!(btManifoldResult::calculateCombinedRestitution(object0, object1) > 0)) return;
  for (Candidate& c : candidates)
    if (c.distance_m > 0 && c.predicted_m < 0 && c.predicted_m < c.distance_m - 0.2 * motion.dt_s)
      c.distance_m = 0;
}

// How many sides' points answer for the same surface.
int sideCount(const PairView& pair, Sides sides) {
  return sides == Sides::Both && pair.canLookBothWays() ? 2 : 1;
}

// A point on an edge has no normal of its own, and the field is worst near the other side's edges: 14 um at
// the root of an M10 thread with voxels of 0.2 mm, and normals that follow the grid. A nut that stood on such
// points lost 21 % of its acceleration.
void correctSprings(const PairView& pair, const RelativeMotion& motion, const VpsBulletSettings& settings,
                    std::vector<Candidate>& candidates) {
  // Of a body that was looked at along its way, the places are elsewhere.
  if (!settings.use_surfaces || motion.slack_m + motion.speed_m_s * motion.dt_s > sight_m(pair)) return;
  Pose way[2];
  coast(pair, motion.dt_s, way);
  for (int i = 0; i < 2; ++i)
    if (pair.hasShell(i))
      correctEdges(candidates, pair.side(i), pair.side(1 - i), *pair.wrapper[1 - i]->getCollisionShape(), way,
                   motion);
  dropUnreachable(motion, candidates);
}

// All that can touch, and the few of them that stand in the manifolds, to be seen and for solvers that know
// nothing of springs.
void chooseSprings(const PairView& pair, VpsPairState& state) {
  VpsContext& context = *state.context;
  const RelativeMotion& motion = state.motion;
  Selection& selection = state.selection;
  std::vector<Candidate>& candidates = state.contacts;
  collectForStep(pair, motion, state, candidates);
  ++context.pair_updates;
  context.candidates += candidates.size();
  dropUnreachable(motion, candidates);
  correctSprings(pair, motion, context.settings, candidates);
  selection.springs = candidates;
  VpsBulletSettings seen = context.settings;
  seen.use_surfaces = false;
  choose(pair, motion, seen, state.writer.get(), candidates);
  keepSelection(candidates, pair, motion, selection);
  selection.X_W0 = pair.X_WS[0];
  selection.V = motion.V;
  for (int i = 0; i < 2; ++i) selection.key[i] = pair.key(i);
}

// What recallSelection() does for thousands of points: within kStill_m their planes are as good as a look.
// The points that could be left out as the motion was are those that can be left out now.
bool recallSprings(const PairView& pair, VpsPairState& state, Carry& carry) {
  const Selection& selection = state.selection;
  const RelativeMotion& motion = state.motion;
  for (int i = 0; i < 2; ++i)
    if (!(selection.key[i] == pair.key(i))) return false;
  RelativeMotion change = motion;
  change.V = {motion.V.w - selection.V.w, motion.V.v - selection.V.v};
  const double change_m_s = change.velocityAt(pair.center_W()).norm() + change.V.w.norm() * pair.radius_m();
  if (!(change_m_s * motion.dt_s <= kStill_m) || !isWhereItWas(selection, pair, motion)) return false;
  const Pose X_01 = pair.X_WS[0].inverse() * pair.X_WS[1];
  const Pose carried = pair.X_WS[0] * selection.X_W0.inverse();  // body 0, in W
  const Pose against =
      pair.X_WS[0] * X_01 * selection.X_01.inverse() * pair.X_WS[0].inverse();  // body 1, in W
  carry = {carried, against};
  state.contacts = selection.chosen;
  for (Candidate& c : state.contacts) carry(c);
  return true;
}

void choosePenalty(const PairView& pair, VpsPairState& state) {
  const VpsContext& context = *state.context;
  Carry carry;
  if (!recallSprings(pair, state, carry)) chooseSprings(pair, state);
  for (int i = 0; i < 2; ++i) state.penalty.object[i] = pair.wrapper[i]->getCollisionObject();
  state.penalty.mu =
      btManifoldResult::calculateCombinedFriction(state.penalty.object[0], state.penalty.object[1]);
  const double stiffness = context.settings.stiffness_N_per_m3 / sideCount(pair, context.settings.sides);
  renewPoints(state.penalty, state.selection.springs, stiffness, state.motion, carry);
}

void chooseRigid(const PairView& pair, VpsPairState& state) {
  VpsContext& context = *state.context;
  if (!recallSelection(state.selection, pair, state.motion, context.settings, state.contacts)) {
    collectForStep(pair, state.motion, state, state.contacts);
    ++context.pair_updates;
    context.candidates += state.contacts.size();
    choose(pair, state.motion, context.settings, state.writer.get(), state.contacts);
    keepSelection(state.contacts, pair, state.motion, state.selection);
  }
  prepareRestitution(state.contacts, state.motion, pair.wrapper[0]->getCollisionObject(),
                     pair.wrapper[1]->getCollisionObject());
}

// Points now rather than contacts for a step.
void answerQuery(const PairView& pair, VpsContext& context, btManifoldResult& result) {
  RelativeMotion still;
  still.slack_m =
      std::min<double>(std::max<double>(result.m_closestPointDistanceThreshold, 0), sight_m(pair));
  std::vector<Candidate> candidates;
  collect(pair, still.slack_m, context, candidates);
  choose(pair, still, context.settings, nullptr, candidates);
  reportToQuery(candidates, pair.wrapper, result);
}

}  // namespace

VpsAlgorithm::VpsAlgorithm(const btCollisionAlgorithmConstructionInfo& info,
                           const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                           std::shared_ptr<VpsContext> context)
    : btActivatingCollisionAlgorithm(info, body0, body1), state_(std::make_unique<VpsPairState>()) {
  state_->context = std::move(context);
  state_->writer = std::make_unique<ManifoldWriter>(*m_dispatcher, body0->getCollisionObject(),
                                                    body1->getCollisionObject());
}

VpsAlgorithm::~VpsAlgorithm() {
  state_->context->penalty.remove(&state_->penalty);
}

void VpsAlgorithm::getAllContactManifolds(btManifoldArray& manifolds) {
  state_->writer->append(manifolds);
}

void VpsAlgorithm::prepare(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1,
                           const btDispatcherInfo& info) {
  VpsPairState& state = *state_;
  const PairView pair(body0, body1);
  state.contacts.clear();
  state.motion = {};
  state.is_prepared = true;
  forgetReplacedModels(state, pair);
  const VpsBulletSettings& settings = state.context->settings;
  const bool is_penalty = settings.mode == ContactMode::Penalty;
  if (!pair.X_WS[0].isFinite() || !pair.X_WS[1].isFinite() || !is_penalty) state.penalty.points.clear();
  if (!pair.X_WS[0].isFinite() || !pair.X_WS[1].isFinite()) return;
  // Springs push from the first touch on, and only then: what is farther than the step's travel need not be
  // there.
  constexpr double kPenaltySlack_m = 2e-6;  // assumed: contact turns the motion within the step
  const double slack_m = is_penalty ? std::min(kPenaltySlack_m, settings.slack_m) : settings.slack_m;
  state.motion = relativeMotion(pair, info.m_timeStep, slack_m);
  is_penalty ? choosePenalty(pair, state) : chooseRigid(pair, state);
}

void VpsAlgorithm::processCollision(const btCollisionObjectWrapper* body0,
                                    const btCollisionObjectWrapper* body1, const btDispatcherInfo& info,
                                    btManifoldResult* result) {
  VpsContext& context = *state_->context;
  const PairView pair(body0, body1);
  // A contactTest hands in a result of its own type.
  if (typeid(*result) != typeid(btManifoldResult)) {
    if (pair.X_WS[0].isFinite() && pair.X_WS[1].isFinite()) answerQuery(pair, context, *result);
    return;
  }
  if (!state_->is_prepared) prepare(body0, body1, info);
  state_->is_prepared = false;
  context.contacts += state_->contacts.size();
  state_->writer->write(state_->contacts, pair.wrapper, state_->motion);
  // Pairs that press on nothing, and all of rigid mode, have nothing to say to the solver.
  const bool presses = !state_->penalty.points.empty();
  if (!presses && state_->is_registered) context.penalty.remove(&state_->penalty);
  state_->is_registered = presses;
  if (presses)
    for (const btPersistentManifold* manifold : state_->writer->manifolds())
      context.penalty.add(manifold, &state_->penalty);
}

}  // namespace vps
