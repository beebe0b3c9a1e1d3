// SPDX-License-Identifier: BSD-3-Clause
#include "case_run.h"

#include <algorithm>
#include <deque>
#include <exception>

#include "dynamics/world.h"
#include "vps/coupling_law.h"
#include "vps/errors.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/coupling.h"

namespace vps::search {

namespace {

/// Fine enough for parts of a few millimetres.
constexpr dynamics::Resolution kResolution{0.25e-3, 0.5e-3};

dynamics::PartMesh partOf(const CaseBody& body) {
  // Mass and inertia come from the true solid, since a user of Bullet states them.
  dynamics::PartMesh part = dynamics::makePart(body.mesh);
  part.mesh = body.given;
  return part;
}

/// The pose of the hand's proxy over time: from goal to goal, straight and turning evenly.
class HandPath {
 public:
  HandPath(const Hand& hand, const Pose& X_start) : goals_(hand.goals), X_W_(X_start) {}
  /// Advances by dt_s and returns the state at the end of the step.
  CouplingState advance(double dt_s);

 private:
  const std::vector<Hand::Goal>& goals_;
  std::size_t next_ = 0;
  Pose X_W_;
};

CouplingState HandPath::advance(double dt_s) {
  const Pose before = X_W_;
  if (next_ < goals_.size()) {
    const Hand::Goal& goal = goals_[next_];
    const Vec3 way = goal.X_WP.p - X_W_.p, turn = rotationVector(goal.X_WP.R * X_W_.R.transpose());
    const double needed_s = std::max(way.norm() / goal.speed_m_s, turn.norm() / goal.spin_rad_s);
    if (needed_s <= dt_s) {
      X_W_ = goal.X_WP;
      ++next_;
    } else {
      const double share = dt_s / needed_s;
      X_W_ = {rotationFromVector(share * turn) * X_W_.R, X_W_.p + share * way};
    }
  }
  CouplingState state;
  state.X_W = X_W_;
  state.V_W.v = (X_W_.p - before.p) / dt_s;
  state.V_W.w = rotationVector(X_W_.R * before.R.transpose()) / dt_s;
  state.is_coupled = true;
  return state;
}

/// The bodies of a case in a Bullet world.
class CaseWorld {
 public:
  CaseWorld(const Case& made, const RunSettings& settings)
      : world_({settings.mode, false, dynamics::vpsEngine(kResolution)}) {
    for (const CaseBody& body : made.bodies) {
      placed_.push_back(world_.add(partOf(body), body.X_WP, body.is_fixed, body.friction));
      if (body.is_fixed) continue;
      placed_.back().body->setLinearVelocity(bullet::toBt(body.V_WP_W.v));
      placed_.back().body->setAngularVelocity(bullet::toBt(body.V_WP_W.w));
    }
    if (!made.hand) return;
    const dynamics::Placed& held = placed_[made.hand->body];
    auto coupling = std::make_unique<bullet::CouplingConstraint>(*held.body, held.part.frame.X_PB.inverse(),
                                                                 CouplingGains());
    coupling_ = coupling.get();
    world_.addConstraint(std::move(coupling));
    path_.emplace(*made.hand, held.pose());
  }

  void step(double dt_s) {
    if (path_) coupling_->setTarget(path_->advance(dt_s));
    world_.step(1, dt_s);
  }
  [[nodiscard]] std::vector<Pose> poses() const {
    std::vector<Pose> poses;
    for (const dynamics::Placed& placed : placed_) poses.push_back(placed.pose());
    return poses;
  }
  [[nodiscard]] std::vector<BodyMotion> motions() const {
    std::vector<BodyMotion> motions;
    for (const dynamics::Placed& placed : placed_)
      motions.push_back({placed.pose(),
                         {bullet::fromBt(placed.body->getAngularVelocity()),
                          bullet::fromBt(placed.body->getLinearVelocity())}});
    return motions;
  }
  [[nodiscard]] std::uint64_t hash() const { return world_.hash(); }

 private:
  dynamics::World world_;
  std::vector<dynamics::Placed> placed_;
  bullet::CouplingConstraint* coupling_ = nullptr;
  std::optional<HandPath> path_;
};

bool hasAnyPassed(const Case& made, const std::vector<Pose>& before, const std::vector<Pose>& after) {
  for (std::size_t a = 0; a < after.size(); ++a)
    for (std::size_t b = 0; b < after.size(); ++b) {
      if (a == b || (made.bodies[a].is_fixed && made.bodies[b].is_fixed)) continue;
      if (hasPassedThrough(*made.bodies[a].exact, *made.bodies[b].exact, before[b].inverse() * before[a],
                           after[b].inverse() * after[a], kPassed_m))
        return true;
    }
  return false;
}

void simulate(const Case& made, const RunSettings& settings, CaseResult& result) {
  CaseWorld world(made, settings);
  std::deque<std::vector<BodyMotion>> history;
  std::vector<Pose> before = world.poses();
  const auto steps = static_cast<int>(made.seconds / settings.step_s);
  for (int i = 0; i < steps; ++i) {
    history.push_back(world.motions());
    if (history.size() > kKept) history.pop_front();
    world.step(settings.step_s);
    result.simulated_s += settings.step_s;
    result.hash = world.hash();
    const std::vector<Pose> after = world.poses();
    for (const Pose& X : after)
      if (!X.isFinite()) {
        result.refusal = "a pose is not finite";
        return;
      }
    const CaseOverlap now = deepestOverlap(made, after);
    if (hasAnyPassed(made, before, after) || now.overlap.depth_m > kLost_m) result.has_tunnelled = true;
    if (now.overlap.depth_m > result.deepest.overlap.depth_m) {
      result.deepest = now;
      result.deepest_at_s = (i + 1) * settings.step_s;
    }
    if (now.overlap.depth_m > settings.bound_m && result.before.empty()) {
      result.before.assign(history.begin(), history.end());
      result.before_s = i * settings.step_s;
    }
    before = after;
    // A body that has passed through another one stays on the wrong side, so the rest of the run gives no
    // more information.
    if (result.has_tunnelled) return;
    if (settings.stops_at_bound && !result.before.empty()) return;
  }
}

}  // namespace

bool hasPassedThrough(const OverlapMesh& a, const OverlapMesh& b, const Pose& X_BA_before,
                      const Pose& X_BA_after, double margin_m) {
  std::vector<double> crossings;
  for (const Vec3& p_A : a.mesh().vertices) {
    const Vec3 from = X_BA_before * p_A, to = X_BA_after * p_A;
    Box path;
    path.add(from);
    path.add(to);
    if (!overlap(path, b.box()) || (to - from).squaredNorm() < margin_m * margin_m) continue;
    crossings.clear();
    b.solid().appendCrossings(from, to, crossings);
    if (crossings.size() < 2) continue;
    if (b.solid().signedDistance(from) < 0 || b.solid().signedDistance(to) < 0) continue;
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
      const Vec3 middle = from + 0.5 * (crossings[i] + crossings[i + 1]) * (to - from);
      if (b.solid().signedDistance(middle) < -margin_m) return true;
    }
  }
  return false;
}

CaseResult runCase(const Case& made, const RunSettings& settings) {
  CaseResult result;
  try {
    simulate(made, settings, result);
  } catch (const std::exception& error) {
    result.refusal = error.what();
  }
  return result;
}

}  // namespace vps::search
