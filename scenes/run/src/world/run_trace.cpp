// SPDX-License-Identifier: BSD-3-Clause
#include "world/run_trace.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/steps.h"
#include "vps/box.h"

namespace vps::scenes {

namespace {

constexpr double kGuide_s =
    0.02;  ///< averaging time: a force across the axis that lasts less is an impact and does not guide

device::RunTrace logEntry(const TraceRow& row) {
  device::RunTrace entry;
  entry.time_s = row.time_s;
  entry.step = row.step;
  entry.phase = static_cast<std::uint8_t>(row.phase);
  entry.F_hand_W = row.F_hand_W;
  entry.X_WP = row.X_WP;
  entry.X_W_Proxy = row.X_W_Proxy;
  entry.contacts = row.contacts;
  entry.depth_m = row.depth_m;
  return entry;
}

TraceRow rowOf(const AssemblyWorld& world, TracePhase phase, const TouchState& touch) {
  const AssemblyState& state = world.state();
  TraceRow row;
  row.time_s = state.time_s;
  row.step = state.step;
  row.phase = static_cast<int>(phase);
  row.strategy = static_cast<int>(world.driver().state().strategy);
  row.F_hand_W = state.is_holding ? world.driver().last().F_hand_W : Wrench{};
  row.X_WP = world.movingPose();
  row.X_W_Proxy = world.driver().last().X_WG;
  row.contacts = touch.contacts;
  row.depth_m = touch.depth_m;
  return row;
}

}  // namespace

RunTrace::RunTrace(const Scene& scene, device::RunLog* log)
    : log_(log),
      log_stride_(std::max(1L, std::lround(scene.fidelity.physics_rate_hz / scene.record.csv_rate_hz))) {}

void RunTrace::beginStep(const AssemblyWorld& world) {
  const std::size_t part = world.state().moving.part;
  rows_.beginStep(bounds(world.scene().parts[part].model->solid->mesh()));
  peak_contact_N_ = guide_N_ = 0;
  const SceneStep& step = world.scene().steps[static_cast<std::size_t>(world.state().step)];
  axis_W_ = insertionAxis(step, world.state().moving.X_PG);
  start_.push_back(snapshotOf(world));
  contact_.push_back(start_.back());
}

void RunTrace::add(const AssemblyWorld& world, TracePhase phase, StepResult& result) {
  const TouchState touch = world.simulation().touch();
  const TraceRow row = rowOf(world, phase, touch);
  if (log_ != nullptr && !world.hasEnded() && added_++ % log_stride_ == 0) log_->add(logEntry(row));
  // The depth belongs to the pose at the start of the step, at which the solver found the contacts.
  rows_.add(row, {row.time_s - world.dt_s(), world.state().X_WP_before, touch.depth_m});

  result.field_penetration_m = std::max(result.field_penetration_m, touch.depth_m);
  if (!world.state().is_holding) return;
  result.peak_force_N = std::max(result.peak_force_N, row.F_hand_W.f.norm());
  result.peak_torque_Nm = std::max(result.peak_torque_Nm, row.F_hand_W.tau.norm());
  guide_N_ += std::min(1.0, world.dt_s() / kGuide_s) * (world.simulation().forceAcross_N(axis_W_) - guide_N_);
  if (phase == TracePhase::Insert || phase == TracePhase::Press || result.is_taken_off)
    result.guide_force_N = std::max(result.guide_force_N, guide_N_);
  const bool is_on_the_way = phase == TracePhase::Reach || phase == TracePhase::Insert;
  if (touch.force_N > peak_contact_N_ && is_on_the_way) {
    peak_contact_N_ = touch.force_N;
    contact_.back() = snapshotOf(world);
  }
}

void RunTrace::endStep(const AssemblyWorld& world) {
  end_.push_back(snapshotOf(world));
}

void RunTrace::logEvent(const AssemblyWorld& world, device::RunEventKind kind,
                        const std::string& text) const {
  if (log_ == nullptr || world.hasEnded()) return;
  device::RunEvent event;
  event.time_s = world.state().time_s;
  event.step = world.state().step;
  event.kind = kind;
  if (kind == device::RunEventKind::Phase) event.phase = device::toByte(world.driver().state());
  event.setWords(text);
  log_->add(event);
}

void RunTrace::logPhase(const AssemblyWorld& world) {
  const device::OperatorState state = world.driver().state();
  if (logged_state_ == state) return;
  logged_state_ = state;
  std::string words = toText(state.phase);
  if (state.strategy != device::OperatorStrategy::None) words.append(": ").append(toText(state.strategy));
  logEvent(world, device::RunEventKind::Phase, words);
}

void RunTrace::moveTo(AssembleResult& result) {
  result.trace = rows_.takeRows();
  result.start = std::move(start_);
  result.contact = std::move(contact_);
  result.end = std::move(end_);
}

Snapshot snapshotOf(const AssemblyWorld& world) {
  const AssemblyState& state = world.state();
  Snapshot shot;
  shot.time_s = state.time_s;
  shot.step = state.step;
  for (std::size_t i = 0; i < state.X_WP.size(); ++i)
    shot.bodies.push_back({i, state.X_WP[i], state.roles[i]});
  if (state.step < 0) return shot;
  shot.has_target = true;
  shot.target_part = state.moving.part;
  shot.X_WP_target = state.moving.X_WP_target;
  shot.has_hand = state.is_holding;
  shot.X_W_Proxy = world.driver().last().X_WG;
  shot.F_hand_W = world.driver().last().F_hand_W;
  world.simulation().contactMarks(shot.contacts);
  return shot;
}

}  // namespace vps::scenes
