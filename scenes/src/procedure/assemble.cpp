// SPDX-License-Identifier: BSD-3-Clause
// The procedure of the paper's section 5, step by step.
#include "vps_scenes/assemble.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <future>
#include <optional>
#include <thread>

#include "core/tick_times.h"
#include "core/wall_clock.h"
#include "haptics/clutching.h"
#include "haptics/haptic_driver.h"
#include "haptics/load_shedder.h"
#include "judge/box_motion.h"
#include "judge/overlap_record.h"
#include "models/scene_models.h"
#include "procedure/placed_parts.h"
#include "procedure/procedure.h"
#include "record/run_record.h"
#include "simulation/simulation.h"
#include "vps/load_error.h"
#include "vps_device/gains.h"
#include "vps_device/periodic_thread.h"
#include "vps_scenes/contact_episodes.h"

namespace vps::scenes {

namespace {

constexpr double kPenetrationLimit_m = 10e-6;
constexpr double kStartOverlap_m = 10e-6;  ///< deeper at the start is refused

constexpr std::chrono::milliseconds kLook{20};  // assumed: no wait that a person notices

int ticksPerStep(const Scene& scene) {
  const double ratio = scene.fidelity.haptic_rate_hz / scene.fidelity.physics_rate_hz;
  const int ticks = static_cast<int>(std::lround(ratio));
  if (ticks < 1 || std::abs(ratio - ticks) > 1e-9)
    throw LoadError(scene.file, "",
                    "the haptic rate is not a whole multiple of the physics rate; choose, say, 1000 Hz "
                    "for both");
  return ticks;
}

/// A grip that loosens, with the same limits.
CouplingGains faded(CouplingGains gains, double share) {
  gains.k_N_per_m *= share;
  gains.b_Ns_per_m *= share;
  gains.k_Nm_per_rad *= share;
  gains.b_Nms_per_rad *= share;
  return gains;
}

/// The energy of the coupling's springs, up to their limits (beyond one the spring's force is constant).
double springEnergy(const CouplingGains& gains, const CouplingState& proxy, const CouplingState& part) {
  const auto stored = [](double k, double stretch, double limit) {
    const double elastic = std::min(stretch, limit / k);
    return 0.5 * k * elastic * elastic + limit * (stretch - elastic);
  };
  if (!proxy.is_coupled || !part.is_coupled) return 0;
  return stored(gains.k_N_per_m, (proxy.X_W.p - part.X_W.p).norm(), gains.max_force_N) +
         stored(gains.k_Nm_per_rad, rotationVector(proxy.X_W.R * part.X_W.R.transpose()).norm(),
                gains.max_torque_Nm);
}

template <typename T>
bool isReady(const std::future<T>& future) {
  return !future.valid() || future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

device::RunTrace logged(const TraceRow& row) {
  device::RunTrace trace;
  trace.time_s = row.time_s;
  trace.step = row.step;
  trace.phase = static_cast<std::uint8_t>(row.phase);
  trace.F_hand_W = row.F_hand_W;
  trace.X_WP = row.X_WP;
  trace.X_W_Proxy = row.X_W_Proxy;
  trace.contacts = row.contacts;
  trace.depth_m = row.depth_m;
  return trace;
}

Twist scaled(const Twist& V, double by) {
  return {by * V.w, by * V.v};
}

/// What a device is passive with in a scene, at a physics rate.
CouplingGains gainsFor(const Scene& scene, const device::DeviceLimits& limits, double physics_rate_hz) {
  device::CouplingTiming timing;
  timing.haptic_rate_hz = scene.fidelity.haptic_rate_hz;
  timing.physics_rate_hz = physics_rate_hz;
  timing.scale = scene.device.scale;
  return device::deriveGains(limits, timing);
}

/// One run of a procedure. Lives as long as the run.
class Procedure {
 public:
  Procedure(Scene& scene, const Plan& plan, Hand& hand, device::RunLog* log,
            const device::LoopSettings& settings, const AssembleOptions& options)
      : scene_(scene),
        plan_(plan),
        log_(log),
        options_(options),
        simulation_(scene, plan_),
        tapped_(hand.device(), log != nullptr ? *log : deaf_),
        placed_(scene, plan_, simulation_, options),
        dt_s_(1 / scene.fidelity.physics_rate_hz),
        trace_stride_(std::max(1L, std::lround(scene.fidelity.physics_rate_hz / scene.record.csv_rate_hz))),
        physics_clock_(dt_s_),
        poses_(scene.parts.size()),
        roles_(scene.parts.size(), BodyRole::Waiting) {
    for (std::size_t i = 0; i < scene.parts.size(); ++i) poses_[i] = scene.parts[i].X_WP;
    const auto tell = [this](const std::string& words) {
      tellEvent(device::RunEventKind::Note, "safety: " + words);
    };
    device::LoopSettings loop_settings = settings;
    if (options.has_local_contact) loop_settings.local = &local_;
    driver_ = sideFor(scene, hand, loop_settings, tell);
    LoadLimits limits_of_pace;
    limits_of_pace.stop = options.stop;
    // What the loop foretells by itself moves as the clock does.
    limits_of_pace.may_slow = !options.has_local_contact;
    shedder_.emplace(scene_, plan_, simulation_, placed_, *driver_, limits_of_pace,
                     [limits = hand.device().limits(), &scene](double rate_hz) {
                       return gainsFor(scene, limits, rate_hz);
                     });
    mountFixed();
  }

  AssembleResult run();

 private:
  struct InHand {
    std::size_t part = 0;
    Pose X_PG;
    Pose X_WP_target;
    Box box_P;
    Vec3 weight_W = Vec3::Zero();
    double held_energy_J = 0;  ///< mechanical energy when it was taken, so that a hand-over stores nothing
  };

  std::unique_ptr<HapticDriver> sideFor(const Scene& scene, Hand& hand, device::LoopSettings settings,
                                        const TellFault& tell);
  void mountFixed();
  void runStep(std::size_t index);
  void work(StepResult& result, const SceneStep& step, std::size_t index);
  [[nodiscard]] device::OperatorTask taskOf(const SceneStep& step) const;
  void take(const SceneStep& step);
  void takeLocally(const ScenePart& scene_part);
  void letGo();
  void rest(StepResult& result, const SceneStep& step);
  void findWhetherCompleted(StepResult& result, const SceneStep& step) const;

  /// Judges the part that was let go and cooks the field of the next step, on other threads. In lockstep time
  /// stands meanwhile, so that the swap comes at a step's number; by the clock, loop and physics go on until
  /// it is ready.
  void settle(StepResult& result, std::size_t index);
  std::future<OverlapVerdict> judgeAsync();
  std::future<CookedField> cookAsync(std::size_t step);  ///< without a state if none is needed
  void goOnUntil(const std::function<bool()>& is_done);
  void swapIn(CookedField field, StepResult& result);
  void tellVerdict(StepResult& result, const OverlapVerdict& verdict) const;
  void mount(std::size_t part);
  /// Models the rest of what is fixed, if the part in hand comes near the border of its region.
  void keepCovered();

  /// Gives up what must be to hold the rate, or takes it back.
  void shedLoad();

  /// One physics step with its haptic ticks. False, and nothing done, where the hand cannot go on.
  [[nodiscard]] bool advance();
  void record(int phase);
  void tellPhase();
  void tellEvent(device::RunEventKind kind, const std::string& words);
  [[nodiscard]] Snapshot snapshot() const;
  void tell(std::size_t index, double share) const;
  [[nodiscard]] bool isStopped() const {
    return is_over_ || (options_.stop != nullptr && options_.stop->load());
  }

  /// Where nobody listens.
  class DeafLog final : public device::RunLog {
    void add(const device::LogEntry&) noexcept override {}
  };

  Scene& scene_;
  Plan plan_;
  device::RunLog* log_;
  const AssembleOptions& options_;
  Simulation simulation_;
  DeafLog deaf_;
  device::TappedDevice tapped_;
  CouplingPort port_;
  device::LocalContact local_;
  std::unique_ptr<HapticDriver> driver_;
  PlacedParts placed_;
  std::optional<LoadShedder> shedder_;  ///< of driver_
  double dt_s_;
  double grip_ = 1;    ///< share of the gains that holds the part in hand
  long trace_stride_;  ///< physics steps from one logged row to the next
  double time_s_ = 0;
  TickClock physics_clock_;
  std::vector<Pose> poses_;
  std::vector<BodyRole> roles_;
  InHand held_;
  bool is_holding_ = false;
  bool is_over_ = false;      ///< the hand cannot go on
  bool is_settling_ = false;  ///< the part is judged and cooked: what it does no longer counts
  std::optional<device::OperatorPhase> told_phase_;
  int step_ = -1;
  double stored_before_J_ = 0;  ///< stored energy of parts handed over so far
  std::size_t first_row_ = 0;   ///< of the step, in the trace
  std::vector<OverlapSample> samples_;
  Pose X_WP_before_;
  double peak_contact_N_ = 0;
  AssembleResult result_;
};

AssembleResult Procedure::run() {
  const double begun_s = wallSeconds();
  result_.completed = true;
  for (std::size_t i = 0; i < scene_.steps.size() && !isStopped(); ++i) {
    runStep(i);
    if (result_.steps.back().completed) continue;
    result_.completed = false;
    if (!options_.keep_going) break;
  }
  if (result_.steps.size() < scene_.steps.size()) result_.completed = false;
  driver_->pause();
  step_ = -1;
  result_.finished = snapshot();
  result_.haptic = driver_->times();
  result_.real_time = driver_->realTime();
  if (result_.real_time) result_.real_time->load_changes = shedder_->changes();
  result_.physics = physics_clock_.summary();
  const device::PassivityObserver ledger = driver_->ledger();
  result_.energy = {ledger.to_hand_J, ledger.from_hand_J, ledger.injected_J,
                    ledger.quantisation_error_bound_J};
  result_.contacts_left_out = simulation_.contactsLeftOut();
  result_.modelled = placed_.modelled();
  result_.widened = placed_.widened();
  const device::LocalContact::Report& local = local_.report();
  result_.local_contact = {local.held, local.jump_J, local.greatest_jump_m};
  result_.simulated_s = time_s_;
  result_.run_wall_s = wallSeconds() - begun_s;
  return std::move(result_);
}

std::unique_ptr<HapticDriver> Procedure::sideFor(const Scene& scene, Hand& hand,
                                                 device::LoopSettings settings, const TellFault& tell) {
  if (options_.is_real_time) return makeRealTimeDriver(hand, port_, settings, dt_s_, tell, log_);
  device::Device& device = log_ != nullptr ? tapped_ : hand.device();
  if (std::vector<device::SyncEvent> sync_events = hand.sync_events();
      !sync_events.empty() && log_ != nullptr) {
    settings.physics_limit_s = physicsLimit_s(dt_s_);
    return makeReplayedDriver(hand, std::move(sync_events), device, port_, settings, tell, *log_);
  }
  return makeLockstepDriver(hand, device, port_, settings, ticksPerStep(scene), tell);
}

void Procedure::mountFixed() {
  for (std::size_t i = 0; i < scene_.parts.size(); ++i) {
    if (!scene_.parts[i].is_fixed) continue;
    placed_.add(i, poses_[i]);
    mount(i);
  }
  if (const auto order = placed_.orderFor(0)) placed_.setField(cookField(*order));
}

void Procedure::mount(std::size_t part) {
  placed_.addToJudge(part);
  roles_[part] = BodyRole::Mounted;
}

void Procedure::keepCovered() {
  const auto step = static_cast<std::size_t>(step_);
  const std::size_t part = held_.part;
  if (placed_.isCovered(step, held_.box_P, poses_[part], simulation_.twist(part), dt_s_)) return;
  if (options_.warn)
    options_.warn(
        "'" + scene_.parts[part].part.name +
        "' came to the border of where it was expected; all that is fixed is modelled from there on");
  // By the clock physics that stands still for so long is a fault; paused, the loop knows.
  const bool pauses = options_.has_local_contact || driver_->isByClock();
  if (pauses) driver_->pause();
  shedder_->beforeNewModels(time_s_);
  placed_.widen(step);
  shedder_->afterNewModels(time_s_, part);
  if (!pauses) return;
  if (options_.has_local_contact && is_holding_) takeLocally(scene_.parts[part]);
  driver_->resume();
}

void Procedure::take(const SceneStep& step) {
  const ScenePart& scene_part = scene_.parts[step.part];
  if (!scene_part.allow_overlap) {
    const Penetration overlap = placed_.fit().deepest(placed_.judgedBody(step.part), step.X_WP_start);
    if (overlap.depth_m > kStartOverlap_m)
      throw LoadError(scene_.file, scene_part.part.name,
                      "starts " + std::to_string(std::lround(overlap.depth_m * 1e6)) + " um inside '" +
                          placed_.fit().name(overlap.against) +
                          "'; move its start, or say allow_overlap = true");
  }
  simulation_.addBody(step.part, step.X_WP_start);
  roles_[step.part] = BodyRole::InHand;
  held_ = {step.part,
           Pose::translation(simulation_.centreOfMass(step.part)),
           step.X_WP_target,
           bounds(scene_part.part.mesh),
           simulation_.mass(step.part) * scene_.gravity_W,
           0};
  held_.held_energy_J = simulation_.mechanicalEnergy();
  simulation_.grasp(step.part, held_.X_PG, shedder_->gains());
  grip_ = 1;
  driver_->handOver(step.X_WP_start * held_.X_PG);
  is_holding_ = true;
  if (options_.has_local_contact) takeLocally(scene_part);
}

void Procedure::takeLocally(const ScenePart& scene_part) {
  local_.letGo();
  if (!simulation_.hasFixed()) return;
  device::LocalPart part;
  part.map = simulation_.fixedMap();
  part.shell = scene_part.part.shell.get();
  part.X_PG = held_.X_PG;
  part.mass_kg = simulation_.mass(held_.part);
  part.inertia_G = simulation_.inertia(held_.part);
  part.gravity_W = scene_.gravity_W;
  part.friction = simulation_.friction(held_.part);
  part.k_N_per_m3 = scene_part.part.material.stiffness_N_per_m3;
  local_.take(part);
}

void Procedure::letGo() {
  // The ledger goes on from what is stored without the springs: letting go gives their energy to nobody.
  stored_before_J_ += simulation_.mechanicalEnergy() - held_.held_energy_J;
  simulation_.release();
  driver_->letGo();
  local_.letGo();
  is_holding_ = false;
  roles_[held_.part] = BodyRole::Released;
}

bool Procedure::advance() {
  if (!driver_->advance({poses_[held_.part], simulation_.twist(held_.part), held_.weight_W})) {
    is_over_ = true;
    log_ = nullptr;  // what follows is no part of the run
    return false;
  }
  X_WP_before_ = poses_[held_.part];
  if (!is_settling_) keepCovered();
  shedLoad();
  physics_clock_.start();
  CouplingState proxy = driver_->proxy();
  proxy.V_W = scaled(proxy.V_W, shedder_->slower());
  simulation_.setProxy(proxy);
  simulation_.step(dt_s_);
  physics_clock_.stop();
  time_s_ += dt_s_;
  if (options_.after_step) options_.after_step(time_s_);

  poses_[held_.part] = simulation_.pose(held_.part);
  CouplingState part = simulation_.graspState();
  part.is_coupled =
      is_holding_;  // its time stays that of the proxy it answers: the loop reckons on from there
  part.V_W = scaled(part.V_W, 1 / shedder_->slower());
  std::optional<double> stored_J;
  if (is_holding_)
    stored_J = stored_before_J_ + simulation_.mechanicalEnergy() - held_.held_energy_J +
               springEnergy(faded(shedder_->gains(), grip_), proxy, part);
  driver_->publish(part, stored_J);
  return true;
}

void Procedure::shedLoad() {
  // Cooking and judging slow a run down that nothing given up would quicken. A recording does not hold what
  // is given up.
  if (!options_.degrades || !driver_->isByClock() || is_settling_ || log_ != nullptr) return;
  shedder_->keep(driver_->busy_s(), time_s_, held_.part, is_holding_);
  dt_s_ = shedder_->dt_s();
  if (grip_ < 1) simulation_.setGains(faded(shedder_->gains(), grip_));  // other gains may have come
}

void Procedure::tellEvent(device::RunEventKind kind, const std::string& words) {
  if (log_ == nullptr) return;
  device::RunEvent event;
  event.time_s = time_s_;
  event.step = step_;
  event.kind = kind;
  if (kind == device::RunEventKind::Phase) event.phase = static_cast<std::uint8_t>(driver_->phase());
  event.say(words);
  log_->add(event);
}

void Procedure::tellPhase() {
  const device::OperatorPhase phase = driver_->phase();
  if (told_phase_ == phase) return;
  told_phase_ = phase;
  tellEvent(device::RunEventKind::Phase, toText(phase));
}

void Procedure::record(int phase) {
  const TouchState touch = simulation_.touch();
  TraceRow row;
  row.time_s = time_s_;
  row.step = step_;
  row.phase = phase;
  row.F_hand_W = is_holding_ ? driver_->last().F_hand_W : Wrench{};
  row.X_WP = poses_[held_.part];
  row.X_W_Proxy = driver_->last().X_WG;
  row.contacts = touch.contacts;
  row.depth_m = touch.depth_m;
  result_.trace.push_back(row);
  if (log_ != nullptr && static_cast<long>(result_.trace.size() - 1) % trace_stride_ == 0)
    log_->add(logged(row));
  // The solver saw the contacts of the pose in which the step began.
  samples_.push_back({time_s_ - dt_s_, X_WP_before_, touch.depth_m});

  StepResult& step = result_.steps.back();
  step.field_penetration_m = std::max(step.field_penetration_m, touch.depth_m);
  if (!is_holding_) return;
  step.peak_force_N = std::max(step.peak_force_N, row.F_hand_W.f.norm());
  step.peak_torque_Nm = std::max(step.peak_torque_Nm, row.F_hand_W.tau.norm());
  if (touch.force_N > peak_contact_N_ && phase < 2) {
    peak_contact_N_ = touch.force_N;
    result_.contact.back() = snapshot();
  }
}

device::OperatorTask Procedure::taskOf(const SceneStep& step) const {
  device::OperatorTask task;
  task.X_WP_start = step.X_WP_start;
  task.way_points = step.way_points;
  task.X_WP_target = step.X_WP_target;
  task.X_PG = held_.X_PG;
  task.tolerance_m = step.tolerance_m;
  task.tolerance_rad = step.tolerance_rad;
  task.timeout_s = step.timeout_s;
  task.weight_W = held_.weight_W;
  return task;
}

void Procedure::runStep(std::size_t index) {
  if (options_.has_local_contact) driver_->pause();
  const SceneStep& step = scene_.steps[index];
  const std::string& name = scene_.parts[step.part].part.name;
  step_ = static_cast<int>(index);
  StepResult& result = result_.steps.emplace_back();
  result.part = name;
  result.start_s = time_s_;
  result.penetration_limit_m =
      step.clearance_m > 0 ? std::min(kPenetrationLimit_m, step.clearance_m / 4) : kPenetrationLimit_m;
  samples_.clear();
  first_row_ = result_.trace.size();
  peak_contact_N_ = 0;

  poses_[step.part] = step.X_WP_start;
  take(step);
  result_.start.push_back(snapshot());
  result_.contact.push_back(snapshot());
  tellEvent(device::RunEventKind::Take, "takes '" + name + "'");
  work(result, step, index);
  if (options_.has_local_contact) driver_->pause();
  for (const ContactEpisode& episode : contactEpisodes(std::span(result_.trace).subspan(first_row_)))
    ++(episode.is_slide ? result.slides : result.impacts);
  result.duration_s = time_s_ - result.start_s;
  result_.end.push_back(snapshot());

  letGo();
  tellEvent(device::RunEventKind::LetGo, "lets go of '" + name + "'");
  rest(result, step);
  tell(index, 0.9);
  findWhetherCompleted(result, step);
  settle(result, index);
}

void Procedure::work(StepResult& result, const SceneStep& step, std::size_t index) {
  // The part is still where it was taken when the first tick looks.
  CouplingState part = simulation_.graspState();
  part.is_coupled = true;
  part.time_s = time_s_;
  driver_->publish(part, {});
  driver_->resume();
  const auto go_on = [&](int phase) {
    if (isStopped() || !advance()) return false;
    record(phase);
    return true;
  };
  const auto reaching = [&] { return go_on(0); };
  const auto pressing = [&] { return go_on(2); };
  const ClutchWork clutch(*driver_, [this] { return shedder_->dt_s() * shedder_->slower(); });
  if (!clutch.takeHold(reaching)) return;
  driver_->begin(taskOf(step), index, time_s_);
  told_phase_.reset();
  tellPhase();
  const auto is_busy = [&] {
    const device::OperatorPhase phase = driver_->phase();
    return phase != device::OperatorPhase::Done && phase != device::OperatorPhase::Failed;
  };
  while (is_busy() && !isStopped() && advance()) {
    const device::OperatorPhase phase = driver_->phase();
    tellPhase();
    record(phase == device::OperatorPhase::Press || phase == device::OperatorPhase::Done ? 2
           : phase == device::OperatorPhase::Insert                                      ? 1
                                                                                         : 0);
    tell(index, 0.8 * std::min(1.0, (time_s_ - result.start_s) / step.timeout_s * 2));
    if (phase != device::OperatorPhase::Regrasp) continue;
    ++result.index_count;
    if (!clutch.index_point(reaching)) return;
    tellPhase();
  }
  if (!clutch.comeFree(pressing)) return;
  clutch.setDown([&](double share) {
    grip_ = share;
    simulation_.setGains(faded(shedder_->gains(), grip_));
    return pressing();
  });
}

void Procedure::findWhetherCompleted(StepResult& result, const SceneStep& step) const {
  const Pose& X_WP = poses_[step.part];
  result.final_error_m = (X_WP.p - step.X_WP_target.p).norm();
  result.final_error_rad = rotationVector(X_WP.R * step.X_WP_target.R.transpose()).norm();
  const bool is_on_target =
      result.final_error_m <= step.tolerance_m && result.final_error_rad <= step.tolerance_rad;
  const bool is_done = driver_->phase() == device::OperatorPhase::Done;
  result.completed = is_done && is_on_target;
  if (!result.completed)
    result.failure_reason = is_over_      ? "the recording ends here"
                            : isStopped() ? "stopped"
                            : is_done     ? "moved off its target after it was let go"
                            : time_s_ - result.start_s > step.timeout_s
                                ? "the hand gave up: target not reached in time"
                                : "the hand gave up: target not reached";
}

std::future<OverlapVerdict> Procedure::judgeAsync() {
  samples_.push_back({time_s_, poses_[held_.part], 0});
  const JudgedBody& body = placed_.judgedBody(held_.part);
  return std::async(std::launch::async, [this, &body] {
    device::leaveRealTime();  // threads are born with their maker's priority
    // Contacts of one side's points are blind to the other's edges, and cannot say when the part was deepest.
    if (scene_.fidelity.sides == Sides::One)
      for (OverlapSample& sample : samples_)
        sample.depth_m = std::max(sample.depth_m, placed_.fit().fieldDepth_m(body, sample.X_WP));
    return judge(placed_.fit(), body, samples_, options_.judge_stride, options_.stop);
  });
}

std::future<CookedField> Procedure::cookAsync(std::size_t step) {
  auto order = placed_.orderFor(step);
  if (!order) return {};
  order->stop = options_.stop;
  return std::async(std::launch::async, [order = std::move(*order)] {
    device::leaveRealTime();
    return cookField(order);
  });
}

void Procedure::goOnUntil(const std::function<bool()>& is_done) {
  is_settling_ = true;
  while (!is_done() && !isStopped() && advance()) {
  }
  is_settling_ = false;
}

void Procedure::settle(StepResult& result, std::size_t index) {
  const std::size_t part = held_.part;
  if (driver_->isByClock()) goOnUntil([this] { return shedder_->isReady(); });
  shedder_->finish(time_s_);  // of the part that goes now
  std::future<OverlapVerdict> verdict = judgeAsync();
  // So that the next step has what it is mounted on.
  const Pose X_WP = result.completed ? poses_[part] : held_.X_WP_target;
  placed_.add(part, X_WP);
  std::future<CookedField> field = cookAsync(index + 1);
  const std::uint64_t missed_before = driver_->missed();
  if (driver_->isByClock())
    goOnUntil([&] { return driver_->hasSettled(isReady(verdict) && isReady(field)); });
  while (!isReady(verdict) || !isReady(field)) {
    std::this_thread::sleep_for(kLook);
    tell(index, 0.95);  // who listens may stop the run
  }
  result.missed_while_cooking = driver_->missed() - missed_before;
  tellVerdict(result, verdict.get());
  simulation_.removeBody(part);
  poses_[part] = X_WP;
  mount(part);
  if (!field.valid()) return;
  CookedField cooked = field.get();
  if (cooked.shape) swapIn(std::move(cooked), result);
}

void Procedure::swapIn(CookedField field, StepResult& result) {
  result.cook_wall_s = field.wall_s;
  const double begun_s = wallSeconds();
  placed_.setField(std::move(field));
  result.swap_wall_s = wallSeconds() - begun_s;
}

void Procedure::tellVerdict(StepResult& result, const OverlapVerdict& verdict) const {
  result.max_penetration_m = verdict.worst.depth_m;
  result.deepest_at_W = verdict.worst.p_W;
  result.deepest_time_s = verdict.time_s;
  if (verdict.worst.depth_m > 0) result.deepest_against = placed_.fit().name(verdict.worst.against);
}

void Procedure::rest(StepResult& result, const SceneStep& step) {
  const Box box = bounds(scene_.parts[step.part].part.mesh);
  const Pose X_WP_released = poses_[step.part];

  // Meanwhile the empty hand goes back: to where the next part's path lies around the middle of the
  // workspace.
  const std::size_t next = static_cast<std::size_t>(step_) + 1;
  driver_->goBack(next);
  // At least until the hand is back.
  driver_->resume();
  const double first_dt_s = dt_s_;
  const double steps = std::round(std::max(scene_.release_s, kHandReturn_s) / dt_s_);
  result.rest_s = steps * dt_s_;
  for (double left = steps; left > 0 && !isStopped() && advance(); left -= dt_s_ / first_dt_s) {
    record(3);
    result.rest_drift_m =
        std::max(result.rest_drift_m, greatestDisplacement(box, X_WP_released, poses_[step.part]));
  }
}

Snapshot Procedure::snapshot() const {
  Snapshot shot;
  shot.time_s = time_s_;
  shot.step = step_;
  for (std::size_t i = 0; i < poses_.size(); ++i) shot.bodies.push_back({i, poses_[i], roles_[i]});
  if (step_ >= 0) {
    shot.has_target = true;
    shot.target_part = held_.part;
    shot.X_WP_target = held_.X_WP_target;
    shot.has_hand = is_holding_;
    shot.X_W_Proxy = driver_->last().X_WG;
    shot.F_hand_W = driver_->last().F_hand_W;
    simulation_.contactMarks(shot.contacts);
  }
  return shot;
}

void Procedure::tell(std::size_t index, double share) const {
  if (!options_.progress) return;
  const auto count = static_cast<double>(scene_.steps.size());
  options_.progress("step " + std::to_string(index + 1) + " of " + std::to_string(scene_.steps.size()) +
                        ": " + scene_.parts[held_.part].part.name,
                    (static_cast<double>(index) + share) / count);
}

}  // namespace

device::LoopSettings loopSettings(const Scene& scene, const device::Device& device) {
  const device::DeviceLimits limits = device.limits();
  device::LoopSettings settings;
  settings.gains = gainsFor(scene, limits, scene.fidelity.physics_rate_hz);
  const CouplingWishes& wishes = scene.coupling;
  settings.gains.k_N_per_m = wishes.k_N_per_m.value_or(settings.gains.k_N_per_m);
  settings.gains.b_Ns_per_m = wishes.b_Ns_per_m.value_or(settings.gains.b_Ns_per_m);
  settings.gains.k_Nm_per_rad = wishes.k_Nm_per_rad.value_or(settings.gains.k_Nm_per_rad);
  settings.gains.b_Nms_per_rad = wishes.b_Nms_per_rad.value_or(settings.gains.b_Nms_per_rad);
  settings.gains.max_force_N = wishes.max_force_N.value_or(settings.gains.max_force_N);
  settings.gains.max_torque_Nm = wishes.max_torque_Nm.value_or(settings.gains.max_torque_Nm);
  settings.map.scale = scene.device.scale;
  settings.safety.force_N = limits.peak_force_N;
  settings.safety.torque_Nm = limits.peak_torque_Nm;
  settings.period_s = 1 / scene.fidelity.haptic_rate_hz;
  // A part in free motion is a step behind the proxy. Without this the hand would drag k v dt with it, 0.4 N
  // at 0.35 m/s.
  settings.extrapolates_part = true;
  return settings;
}

AssembleResult runProcedure(Scene& scene, Hand& hand, device::RunLog* log,
                            const device::LoopSettings& settings, const AssembleOptions& options) {
  const double begun_s = wallSeconds();
  const Plan plan = makePlan(scene, PlanFor::Assemble, options.models_everything);
  buildModels(scene, plan, options);
  Procedure procedure(scene, plan, hand, log, settings, options);
  const double built_s = wallSeconds() - begun_s;
  AssembleResult result = procedure.run();
  result.scene = scene.name;
  result.build_wall_s = built_s;
  result.haptic_rate_hz = scene.fidelity.haptic_rate_hz;
  result.physics_rate_hz = scene.fidelity.physics_rate_hz;
  return result;
}

AssembleResult assemble(Scene& scene, const AssembleOptions& options) {
  if (scene.steps.empty())
    throw LoadError(scene.file, "",
                    "has no [[step]], so there is nothing to assemble; add one, or use `vps simulate`");
  if (options.has_local_contact && !options.record.empty())
    throw LoadError(options.record, "",
                    "a run with local contact cannot be replayed bit for bit; record it without "
                    "--local-contact");
  const std::unique_ptr<Hand> hand = simulatedHand(scene);
  const device::LoopSettings settings = loopSettings(scene, hand->device());
  if (options.record.empty()) return runProcedure(scene, *hand, nullptr, settings, options);
  RunRecord record(options.record, scene, hand->device(), settings.gains, options);
  AssembleResult result = runProcedure(scene, *hand, &record, settings, options);
  if (options.stop == nullptr || !options.stop->load()) record.finish();
  return result;
}

}  // namespace vps::scenes
