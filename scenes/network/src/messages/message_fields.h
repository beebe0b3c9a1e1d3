// SPDX-License-Identifier: BSD-3-Clause
// The fields of each message, in the order of its bytes: one table for writing and reading.
//
// visit(x) handles a number, vector, pose, twist, wrench, flag or text; visit.notNegative(x) a number of at
// least 0; visit.choice(e, count) an enumeration with `count` values; visit.raw(x) arbitrary bytes.
// visit.unchecked(on) allows numbers of any value, as in the log of a faulty device.
#pragma once

#include "messages/messages.h"

namespace vps::scenes::wire {

template <typename V>
void fields(Envelope& m, V& visit) {
  visit(m.sender);
  visit(m.number);
  visit(m.time_ns);
}

// The compact messages have the same fields for the next two types.
template <typename V>
void fields(device::PassivityObserver& energy, V& visit) {
  visit(energy.to_hand_J);
  visit(energy.from_hand_J);
  visit(energy.dissipated_J);
  visit(energy.balance_J);
  visit(energy.least_J);
  visit(energy.injected_J);
  visit(energy.quantisation_error_bound_J);
}
template <typename V>
void fields(ContactMark& mark, V& visit) {
  visit(mark.p_W);
  visit(mark.n_W);
  visit(mark.depth_m);
  visit(mark.force_N);
}

template <typename V>
void fields(HapticMessage& m, V& visit) {
  device::TickReport& report = m.state.report;
  visit(m.state.tick);
  visit(report.time_s);
  visit.choice(report.status, 6);
  visit(report.X_WG);
  visit(report.V_WG);
  visit(report.F_hand_W);
  visit(report.F_hand_D);
  visit(report.clutch_ratio);
  visit(m.state.proxy.is_coupled);  // the remaining values of the proxy are in the report
  visit.choice(m.state.safety.fault, 8);
  visit(m.state.safety.faults);
  visit(m.state.safety.limited);
  visit(m.state.safety.slewed);
  fields(m.state.passivity, visit);
  visit(m.hand);
}

template <typename V>
void fields(CouplingState& state, V& visit) {
  visit(state.X_W);
  visit(state.V_W);
  visit(state.time_s);
  visit(state.is_coupled);
}

template <typename V>
void fields(PhysicsMessage& m, V& visit) {
  fields(m.state.part, visit);
  visit(m.state.step);
  visit(m.state.stored_J);
  visit(m.state.held.X_WP);
  visit(m.state.held.V_WP);
  visit(m.state.held.weight_W);
}

template <typename V>
void fields(CouplingGains& gains, V& visit) {
  visit.notNegative(gains.k_N_per_m);  // a negative spring or damper would generate energy
  visit.notNegative(gains.b_Ns_per_m);
  visit.notNegative(gains.k_Nm_per_rad);
  visit.notNegative(gains.b_Nms_per_rad);
  visit.notNegative(gains.max_force_N);
  visit.notNegative(gains.max_torque_Nm);
}

template <typename V>
void fields(device::OperatorTask& task, V& visit) {
  visit(task.X_WP_start);
  visit(task.X_WP_target);
  visit(task.X_PG);
  visit(task.tolerance_m);
  visit(task.tolerance_rad);
  visit(task.timeout_s);
  visit(task.weight_W);
  visit(task.tip_P);
  visit(task.give_m_per_N);
  visit(task.has_corners);
  visit(task.is_taking_off);
  visit(task.screw.pitch_m);
  visit(task.screw.torque_Nm);
  visit(task.screw.handle_rad);
}

template <typename V>
void fields(RequestMessage& m, V& visit) {
  visit.choice(m.kind, 4);
  visit.choice(m.command, 13);
  visit(m.keeps_log);
  visit(m.X_WG);
  visit(m.step);
  visit(m.now_s);
  fields(m.task, visit);
  visit(m.way_points_left);
  fields(m.gains, visit);
}

template <typename V>
void fields(ReplyMessage& m, V& visit) {
  visit(m.request);
  visit(m.hand);
  visit(m.tick);
  visit(m.refusal);
}

template <typename V>
void fields(HelloMessage& m, V& visit) {
  device::DeviceLimits& limits = m.limits;
  visit(limits.continuous_force_N);
  visit(limits.peak_force_N);
  visit(limits.continuous_torque_Nm);
  visit(limits.peak_torque_Nm);
  visit(limits.workspace_min_D);
  visit(limits.workspace_max_D);
  visit(limits.rate_hz);
  visit(limits.delay_s);
  visit(limits.damping_Ns_per_m);
  visit(limits.damping_Nms_per_rad);
  visit(limits.coulomb_N);
  visit(limits.coulomb_Nm);
  visit(limits.resolution_m);
  visit(limits.resolution_rad);
  visit(limits.workspace_rad);
  visit(m.name);
  visit(m.is_by_person);
  visit(m.may_rearm);
}

template <typename V>
void fields(TickTimes& times, V& visit) {
  visit(times.count);
  visit(times.missed);
  visit(times.p50_us);
  visit(times.p99_us);
  visit(times.p999_us);
  visit(times.max_us);
}

template <typename V>
void fields(TimesMessage& m, V& visit) {
  fields(m.tick, visit);
  fields(m.late, visit);
  fields(m.response, visit);
  for (std::uint64_t& missed : m.missed_by) visit(missed);
  visit(m.stale_ticks);
  visit(m.worst_tick);
  visit(m.faults);
  visit(m.worst_us);
  visit.choice(m.worst_cause, device::kTickCauses);
  visit(m.has_priority);
  visit(m.has_locked_memory);
}

template <typename V>
void fields(device::DeviceSample& e, V& visit) {
  visit(e.X_DH);
  visit(e.V_DH);
  visit(e.time_s);
  visit.choice(e.status, 6);
}
template <typename V>
void fields(device::WrittenWrench& e, V& visit) {
  visit(e.time_s);
  visit(e.F_Ho_D);
}
template <typename V>
void fields(device::SyncEvent& e, V& visit) {
  visit(e.time_s);
  visit(e.tick);
  visit(e.periods);
  visit(e.snapshot);
  visit.choice(e.kind, 17);
}

template <typename V>
void fields(LogMessage& m, V& visit) {
  visit.unchecked(true);
  visit(m.number);
  visit.alternative(m.entry);
  visit.unchecked(false);
}

template <typename V>
void fields(SnapshotMessage& m, V& visit) {
  Snapshot& s = m.snapshot;
  visit(s.time_s);
  visit(s.step);
  visit(s.has_target);
  visit(s.target_part);
  visit(s.X_WP_target);
  visit(s.has_hand);
  visit(s.X_W_Proxy);
  visit(s.F_hand_W);
  visit.list(s.bodies, [&visit](BodySnapshot& body) {
    visit(body.part);
    visit(body.X_WP);
    visit.choice(body.role, 4);
  });
  visit.list(s.contacts, [&visit](ContactMark& mark) { fields(mark, visit); });
}

template <typename V>
void fields(NewsMessage& m, V& visit) {
  visit.choice(m.kind, 3);
  visit(m.step);
  visit.choice(m.verdict, 3);
  visit(m.time_s);
  visit(m.text);
}

template <typename V>
void fields(BeatMessage& m, V& visit) {
  visit.choice(m.role, 3);
  visit(m.session);
  visit(m.has_ended);
  visit(m.peer);
  visit(m.peer_sent_ns);
  visit(m.received_ns);
}

template <typename V>
void fields(PointerMessage& m, V& visit) {
  visit(m.person);
  visit(m.is_shown);
  visit(m.p_W);
}

template <typename V>
void fields(AskMessage& m, V& visit) {
  visit.choice(m.kind, 9);
  visit(m.text);
  visit.notNegative(m.k_N_per_m);
  visit.notNegative(m.k_Nm_per_rad);
  visit(m.wants_file);
  visit(m.offset);
}

template <typename V>
void fields(AnswerMessage& m, V& visit) {
  visit(m.asker);
  visit(m.number);
  visit(m.is_done);
  visit(m.wants_scene);
  visit(m.text);
}

template <typename V>
void fields(PieceMessage& m, V& visit) {
  visit(m.hash);
  visit(m.total);
  visit(m.offset);
  visit(m.size);
  visit.raw(m.bytes);
}

template <typename V>
void fields(FetchedMessage& m, V& visit) {
  visit(m.asker);
  visit(m.number);
  fields(m.piece, visit);
}

}  // namespace vps::scenes::wire
