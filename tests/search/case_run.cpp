// SPDX-License-Identifier: BSD-3-Clause
#include "case_run.h"

#include <deque>
#include <exception>

#include "dynamics/world.h"
#include "hand_path.h"
#include "pass_through.h"
#include "vps/errors.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/coupling.h"

namespace vps::search {

namespace {

/// Voxels and points as fine as the parts of a few millimetres need.
constexpr dynamics::Resolution kResolution{0.25e-3, 0.5e-3};

dynamics::PartMesh partOf(const CaseBody& body) {
  // Mass and inertia are those of the true solid: a user of Bullet states them.
  dynamics::PartMesh part = dynamics::makePart(body.mesh);
  part.mesh = body.given;
  return part;
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
    // What has lost its side stays lost: the rest of the run would tell nothing more.
    if (result.has_tunnelled) return;
    if (settings.stops_at_bound && !result.before.empty()) return;
  }
}

}  // namespace

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
