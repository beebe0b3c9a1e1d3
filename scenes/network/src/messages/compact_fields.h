// SPDX-License-Identifier: BSD-3-Clause
// The compact form of states and snapshots, for UDP: lengths are floats, rotations take eight bytes, twists
// and wrenches are half floats. Most haptic and physics states are sent in the shorter dense form
// (dense_state.h); the occasional whole states use this form.
//
// visit(x) stores numbers as floats, visit.exact(x) with all bits, and visit.coarse(x) as half floats. Writer
// and reader share these functions.
#pragma once

#include "messages/message_fields.h"
#include "messages/messages.h"

namespace vps::scenes::wire {

template <typename V>
void compactFields(HapticMessage& m, V& visit) {
  device::TickReport& report = m.state.report;
  visit.exact(m.state.tick);
  visit.exact(report.time_s);
  visit.choice(report.status, 6);
  visit.choice(m.state.safety.fault, 8);
  visit.exact(m.state.proxy.is_coupled);
  visit.exact(m.hand);
  visit(report.X_WG);
  visit.coarse(report.V_WG);
  visit.coarse(report.F_hand_W);
  visit.coarse(report.F_hand_D);
  visit(report.clutch_ratio);
  visit.exact(m.state.safety.faults);
  visit.exact(m.state.safety.limited);
  visit.exact(m.state.safety.slewed);
  fields(m.state.passivity, visit);
}

template <typename V>
void compactFields(PhysicsMessage& m, V& visit) {
  visit.exact(m.state.step);
  visit.exact(m.state.part.time_s);
  visit.exact(m.state.part.is_coupled);
  visit(m.state.part.X_W);
  visit.coarse(m.state.part.V_W);
  visit(m.state.stored_J);
  visit(m.state.held.X_WP);
  visit.coarse(m.state.held.V_WP);
  visit(m.state.held.weight_W);
}

template <typename V>
void compactFields(SnapshotMessage& m, V& visit) {
  Snapshot& s = m.snapshot;
  visit.exact(s.time_s);
  visit.exact(s.step);
  visit.exact(s.has_target);
  visit.exact(s.target_part);
  visit(s.X_WP_target);
  visit.exact(s.has_hand);
  visit(s.X_W_Proxy);
  visit.coarse(s.F_hand_W);
  visit.list(s.bodies, [&visit](BodySnapshot& body) {
    visit.exact(body.part);
    visit(body.X_WP);
    visit.choice(body.role, 4);
  });
  visit.list(s.contacts, [&visit](ContactMark& mark) {
    visit(mark.p_W);
    visit.coarse(mark.n_W);
    visit.coarse(mark.depth_m);  // precise to 0.06 um, or 1 part in 2048
    visit.coarse(mark.force_N);
  });
}

}  // namespace vps::scenes::wire
