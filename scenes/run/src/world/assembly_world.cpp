// SPDX-License-Identifier: BSD-3-Clause
#include "world/assembly_world.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include <Eigen/Eigenvalues>

#include "scene/steps.h"
#include "vps/errors.h"
#include "vps_device/metronome.h"
#include "vps_scenes/scene/scene_parts.h"
#include "world/loop_settings.h"
#include "world/run_trace.h"

namespace vps::scenes {

namespace {

constexpr double kSnapFade_s =
    0.2;  ///< fade time of axis snap. assumed: slow enough not to feel like an impact
/// Share of the coupling's greatest force that may be weight. A heavier part hangs on a hoist that carries
/// the rest of the weight, and is simulated with the mass that the hand carries. Path and rest of a part do
/// not depend on its mass, since contact and friction forces are proportional to the mass; a heavy part would
/// swing on the coupling's spring.
constexpr double kMostCarried = 0.5;
constexpr double kStartOverlap_m = 10e-6;  ///< a part that starts deeper inside another part is refused

/// The gains times `share`, with the same limits.
CouplingGains scaled(CouplingGains gains, double share) {
  gains.k_N_per_m *= share;
  gains.b_Ns_per_m *= share;
  gains.k_Nm_per_rad *= share;
  gains.b_Nms_per_rad *= share;
  return gains;
}

Twist scaled(const Twist& V, double factor) {
  return {factor * V.w, factor * V.v};
}

std::string newtons(double force_N) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f N", force_N);
  return text;
}

LoadLimits loadLimits(const AssembleOptions& options) {
  LoadLimits limits;
  limits.stop = options.stop;
  // Local contact predicts the part's motion in real time, so simulated time must not run slower.
  limits.may_slow = !options.has_local_contact;
  return limits;
}

}  // namespace

AssemblyWorld::AssemblyWorld(Scene& scene, const ModelPlan& plan, Hand& hand, device::RunLog* log,
                             const device::LoopSettings& settings, const AssembleOptions& options,
                             const ReportFault& on_fault)
    : scene_(scene),
      plan_(plan),
      log_(log),
      options_(options),
      simulation_(scene, plan_),
      tapped_(hand.device(), log != nullptr ? *log : null_log_),
      placed_(scene, plan_, simulation_, options),
      dt_s_(1 / scene.fidelity.physics_rate_hz),
      physics_clock_(dt_s_) {
  for (const ScenePart& part : scene.parts) state_.X_WP.push_back(part.X_WP);
  state_.roles.assign(scene.parts.size(), BodyRole::Waiting);
  for (const SceneStep& step : scene.steps)
    if (step.takes_off) {
      state_.X_WP[step.part] = step.X_WP_start;
      state_.roles[step.part] = BodyRole::Mounted;
    }
  driver_ = makeDriver(hand, settings, on_fault);
  shedder_.emplace(
      scene_, plan_, simulation_, *driver_, loadLimits(options),
      [limits = hand.device().limits(), &scene](double rate_hz) {
        return passiveGains(scene, limits, rate_hz);
      },
      [this](CookedField field) { placed_.setField(std::move(field)); });
  mountFixed();
}

std::unique_ptr<HapticDriver> AssemblyWorld::makeDriver(Hand& hand, device::LoopSettings settings,
                                                        const ReportFault& on_fault) {
  if (auto driver = hand.makeDriver(settings, dt_s_, on_fault, log_)) return driver;
  if (options_.has_local_contact) settings.local = &local_;
  if (options_.is_real_time) return makeRealTimeDriver(hand, port_, settings, dt_s_, on_fault, log_);
  device::Device& device = log_ != nullptr ? tapped_ : hand.device();
  if (std::vector<RecordedEvent> events = hand.events(); !events.empty() && log_ != nullptr) {
    if (!(settings.physics_limit_s > 0)) settings.physics_limit_s = physicsLimit_s(dt_s_);
    return makeReplayedDriver(hand, std::move(events), device, port_, settings, on_fault, *log_);
  }
  return makeLockstepDriver(hand, device, port_, settings, ticksPerStep(scene_), on_fault);
}

void AssemblyWorld::mountFixed() {
  for (const auto& [part, X_WP] : partsInPlace(scene_, 0)) {
    placed_.add(part, X_WP);
    state_.roles[part] = BodyRole::Mounted;
  }
  placed_.renewJudge();
  if (const auto order = placed_.orderFor(0)) placed_.setField(cookField(*order));
}

void AssemblyWorld::take(std::size_t index) {
  const SceneStep& step = scene_.steps[index];
  state_.step = static_cast<int>(index);
  state_.gives_up = false;
  changeGains();
  const Pose X_WP_start = startOf(step);
  state_.X_WP[step.part] = X_WP_start;
  requireFreeStart(step);
  const double g_m_s2 = scene_.gravity_W.norm();
  const double most_kg = g_m_s2 > 0 ? kMostCarried * shedder_->gains().max_force_N / g_m_s2
                                    : std::numeric_limits<double>::infinity();
  const double own_kg = simulation_.addBody(step.part, X_WP_start, most_kg);
  const double hoist_N = std::max(0.0, own_kg - most_kg) * g_m_s2;
  if (hoist_N > 0 && options_.warn)
    options_.warn(
        "'" + scene_.parts[step.part].part.name + "' weighs " + newtons(own_kg * g_m_s2) +
        ", and the hand carries " + newtons(most_kg * g_m_s2) +
        " of this weight; a hoist carries the rest, so forces on the hand are as for a lighter part");
  state_.roles[step.part] = BodyRole::InHand;
  state_.moving = {step.part,
                   Pose::translation(simulation_.centreOfMass(step.part)),
                   step.X_WP_target,
                   bounds(scene_.parts[step.part].part.mesh),
                   simulation_.mass(step.part) * scene_.gravity_W,
                   hoist_N,
                   simulation_.mechanicalEnergy()};
  simulation_.grasp(step.part, state_.moving.X_PG, shedder_->gains());
  grip_ = 1;
  const Mat3 inertia = simulation_.inertia(step.part);
  snap_ = axisSnap(step, state_.moving.X_PG.p, tapped_.limits(), simulation_.mass(step.part),
                   inertia.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), dt_s_);
  snap_share_ = 0;
  driver_->handOver(handAt(X_WP_start));
  state_.is_holding = true;
  if (options_.has_local_contact) startLocalContact();
}

// The coupling's spring is stretched by the part's weight, so that a heavy part does not fall when the hand
// takes the part.
Pose AssemblyWorld::handAt(const Pose& X_WP) const {
  Pose X_WG = X_WP * state_.moving.X_PG;
  const double k_N_per_m = driver_->settings().gains.k_N_per_m;
  if (k_N_per_m > 0 && !driver_->settings().is_collocated)
    X_WG.p -= device::sagBelowHand_m(device::OperatorHabits(), state_.moving.weight_W, 1 / k_N_per_m);
  return X_WG;
}

void AssemblyWorld::changeGains() {
  if (options_.requests == nullptr || log_ != nullptr) return;
  const std::optional<CouplingGains> gains = options_.requests->takeGains();
  if (!gains) return;
  driver_->setGains(*gains);
  shedder_->setOwnGains(*gains);
}

Penetration AssemblyWorld::overlapAt(const SceneStep& step, const Pose& X_WP) {
  return placed_.judge().deepest(placed_.judgedBody(step.part), X_WP);
}

Pose AssemblyWorld::startOf(const SceneStep& step) {
  if (!driver_->settings().is_collocated || !driver_->isByClock()) return step.X_WP_start;
  const Vec3 p_PG = partMass(scene_.parts[step.part]).com;
  Pose X_WP = step.X_WP_start;
  bool is_told = false;
  driver_->resume();
  while (!isStopped()) {
    if (!driver_->advance()) {
      has_ended_ = true;
      break;
    }
    if (driver_->last().status != Status::Ok) continue;
    X_WP.p = driver_->last().X_WG.p - X_WP.R * p_PG;  // no part is held, so this is the handle's pose
    if (scene_.parts[step.part].allow_overlap || overlapAt(step, X_WP).depth_m <= kStartOverlap_m) break;
    if (!std::exchange(is_told, true) && options_.warn)
      options_.warn("the hand is inside a part; move the hand to where '" +
                    scene_.parts[step.part].part.name + "' has room");
  }
  return X_WP;
}

void AssemblyWorld::requireFreeStart(const SceneStep& step) {
  const ScenePart& part = scene_.parts[step.part];
  // checkDrawnTargets() has found whether a part in place overlaps another part as drawn.
  if (part.allow_overlap || step.takes_off || isStopped()) return;
  const Penetration overlap = overlapAt(step, state_.X_WP[step.part]);
  if (overlap.depth_m > kStartOverlap_m)
    throw LoadError(scene_.file, part.part.name,
                    "starts " + std::to_string(std::lround(overlap.depth_m * 1e6)) + " um inside '" +
                        placed_.judge().name(overlap.against) +
                        "'; move its start, or set allow_overlap = true");
}

void AssemblyWorld::startLocalContact() {
  local_.letGo();
  if (!simulation_.hasFixed()) return;
  const StepPart& moving = state_.moving;
  device::LocalPart part;
  part.map = simulation_.fixedMap();
  part.shell = scene_.parts[moving.part].model->shell.get();
  part.X_PG = moving.X_PG;
  part.mass_kg = simulation_.mass(moving.part);
  part.inertia_G = simulation_.inertia(moving.part);
  part.gravity_W = scene_.gravity_W;
  for (const Simulation::FieldContact& contact : simulation_.fieldContacts(moving.part))
    part.of_owner.push_back({contact.friction, contact.stiffness_N_per_m3});
  local_.take(part);
}

void AssemblyWorld::pauseLocalContact() {
  if (options_.has_local_contact) driver_->pause();
}

void AssemblyWorld::release(bool is_held) {
  // On release, the energy in the coupling's springs is discarded and does not enter the energy balance.
  stored_before_J_ += simulation_.mechanicalEnergy() - state_.moving.energy_at_grasp_J;
  simulation_.release();
  if (is_held) simulation_.hold(state_.moving.part);
  driver_->letGo();
  local_.letGo();
  state_.is_holding = false;
  state_.roles[state_.moving.part] = BodyRole::Released;
}

void AssemblyWorld::mount(const Pose& X_WP) {
  const std::size_t part = state_.moving.part;
  const auto next = static_cast<std::size_t>(state_.step) + 1;
  simulation_.removeBody(part);
  state_.X_WP[part] = X_WP;
  const bool is_away = scene_.steps[static_cast<std::size_t>(state_.step)].takes_off;
  state_.roles[part] = is_away ? BodyRole::Waiting : BodyRole::Mounted;
  if (!is_away) placed_.addToJudge(part);
  if (next < scene_.steps.size() && scene_.steps[next].takes_off) placed_.renewJudge();
}

void AssemblyWorld::setGrip(double share) {
  grip_ = share;
  simulation_.setGains(scaled(shedder_->gains(), grip_));
}

device::HeldPart AssemblyWorld::heldPart() const {
  return {movingPose(), simulation_.twist(state_.moving.part), state_.moving.weight_W};
}

bool AssemblyWorld::advance(bool is_settling) {
  if (!driver_->advance()) {
    has_ended_ = true;
    return false;
  }
  state_.X_WP_before = movingPose();
  if (!is_settling) {
    keepCovered();
    shedLoad();
  }
  snap();
  step();
  passEvents();
  if (options_.tap != nullptr && options_.tap->is_wanted.exchange(false)) giveSnapshot();
  return true;
}

void AssemblyWorld::giveSnapshot() {
  Snapshot shot = snapshotOf(*this);
  if (driver_->isByClock()) {
    shot.sample_s = driver_->last().time_s;
    shot.clock_s = device::monotonicSeconds();
  }
  // Least age of figures before new figures are made from some thousand counters.
  constexpr double kFiguresAge_s = 0.05;
  if (!figures_ || state_.time_s - figures_time_s_ >= kFiguresAge_s) {
    const TickTimes haptic = driver_->times(), physics = physics_clock_.summary();
    const device::PassivityObserver energy = driver_->passivity();
    figures_ =
        RunFigures{haptic.count,   haptic.missed,    physics.count,      physics.missed,   haptic.p99_us,
                   physics.p99_us, energy.to_hand_J, energy.from_hand_J, energy.injected_J};
    figures_time_s_ = state_.time_s;
  }
  shot.figures = figures_;
  options_.tap->give(std::move(shot));
}

void AssemblyWorld::passEvents() {
  if (!options_.on_device_event) return;
  driver_->passEvents(options_.on_device_event);
  if (device::DeviceEventQueue* own = tapped_.ownEvents())
    for (device::DeviceEvent event; own->pop(event);) options_.on_device_event(event);
}

void AssemblyWorld::snap() {
  const bool may_snap = log_ == nullptr || driver_->isByClock();
  const bool snaps = driver_->snaps(may_snap && options_.snaps != nullptr && options_.snaps->load());
  if (!state_.is_holding || !snap_) return;
  const double share = std::clamp(snap_share_ + (snaps ? dt_s_ : -dt_s_) / kSnapFade_s, 0.0, 1.0);
  if (share == 0 && snap_share_ == 0) return;
  // Fading changes the spring's energy without work of the hand.
  stored_before_J_ -= (share - snap_share_) * snap_->energy_J(movingPose());
  snap_share_ = share;
  simulation_.push(snap_->wrench(movingPose()) * share);
}

void AssemblyWorld::step() {
  physics_clock_.start();
  CouplingState proxy = driver_->proxy();
  proxy.V_W = scaled(proxy.V_W, shedder_->timeDivisor());
  simulation_.setProxy(proxy);
  simulation_.step(dt_s_);
  physics_clock_.stop();
  state_.time_s += dt_s_;
  if (options_.after_step) options_.after_step(state_.time_s);

  state_.X_WP[state_.moving.part] = simulation_.pose(state_.moving.part);
  // The state of the part keeps the time stamp of the proxy state that caused it: the loop extrapolates from
  // that time.
  CouplingState part = simulation_.graspState();
  part.is_coupled = state_.is_holding;
  part.V_W = scaled(part.V_W, 1 / shedder_->timeDivisor());
  std::optional<double> stored_J;
  // For a device without force output the hand's work is not known, so there is no energy balance.
  const bool is_balanced = driver_->settings().safety.force_N > 0;
  if (state_.is_holding && is_balanced) {
    const bool is_coupled = proxy.is_coupled && part.is_coupled;
    stored_J = stored_before_J_ + simulation_.mechanicalEnergy() - state_.moving.energy_at_grasp_J +
               (is_coupled ? couplingEnergy_J(scaled(shedder_->gains(), grip_), proxy, part) : 0);
    if (snap_share_ > 0) *stored_J += snap_share_ * snap_->energy_J(movingPose());
  }
  driver_->publish({part, 0, stored_J, heldPart()});
}

void AssemblyWorld::keepCovered() {
  const auto step = static_cast<std::size_t>(state_.step);
  const std::size_t part = state_.moving.part;
  if (placed_.isCovered(step, state_.moving.box_P, movingPose(), simulation_.twist(part), dt_s_)) return;
  if (options_.warn)
    options_.warn("'" + scene_.parts[part].part.name +
                  "' came near the edge of the space around its planned path, outside of which contact was "
                  "not modelled; more of the surrounding parts is modelled now");
  // Physics stops while the parts are modelled. In real time stopped physics would be a safety fault, so the
  // loop is paused.
  const bool pauses = options_.has_local_contact || driver_->isByClock();
  if (pauses) driver_->pause();
  shedder_->beforeNewModels(state_.time_s);
  placed_.widen(step, state_.moving.box_P, movingPose());
  shedder_->afterNewModels(state_.time_s, part);
  if (!pauses) return;
  if (options_.has_local_contact && state_.is_holding) startLocalContact();
  driver_->resume();
}

void AssemblyWorld::shedLoad() {
  // A recording does not hold load levels, so a recorded run does not change them.
  if (!options_.degrades || !driver_->isByClock() || log_ != nullptr) return;
  shedder_->update(driver_->busy_s(), state_.time_s, state_.moving.part, state_.is_holding);
  dt_s_ = shedder_->dt_s();
  if (grip_ < 1) setGrip(grip_);  // the level may have changed the gains
}

void AssemblyWorld::finish() {
  driver_->pause();
  state_.step = -1;
}

void AssemblyWorld::reportProgress(double share_of_step) const {
  if (!options_.progress) return;
  const auto count = static_cast<double>(scene_.steps.size());
  options_.progress("step " + std::to_string(state_.step + 1) + " of " + std::to_string(scene_.steps.size()) +
                        ": " + scene_.parts[state_.moving.part].part.name,
                    (static_cast<double>(state_.step) + share_of_step) / count);
}

void AssemblyWorld::summarise(AssembleResult& result) const {
  result.haptic = driver_->times();
  result.real_time = driver_->realTime();
  if (result.real_time) result.real_time->load_changes = shedder_->changes();
  result.physics = physics_clock_.summary();
  const device::PassivityObserver energy = driver_->passivity();
  result.energy = {energy.to_hand_J, energy.from_hand_J, energy.injected_J,
                   energy.quantisation_error_bound_J};
  result.contacts_left_out = simulation_.contactsLeftOut();
  result.fast_turns = simulation_.fastTurns();
  result.modelled = placed_.modelled();
  result.widened = placed_.widened();
  const device::LocalContact::Report& local = local_.report();
  result.local_contact = {local.held, local.jump_J, local.greatest_jump_m};
  result.simulated_s = state_.time_s;
}

}  // namespace vps::scenes
