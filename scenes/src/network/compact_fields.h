// SPDX-License-Identifier: BSD-3-Clause
// The states between nodes where bytes are dear, over UDP: lengths as floats, rotations in eight bytes,
// twists and wrenches as half floats. What changes slowly comes with some of the messages only; a reader
// keeps what it has.
//
// visit(x) takes the worth of a float of each number; visit.exact(x) every bit; visit.coarse(x) the worth of
// a half float; visit.isDue(number, every) whether a state of that number has the slow values. Shared by
// writing and reading.
#pragma once

#include "network/message_fields.h"
#include "network/messages.h"

namespace vps::scenes::inline v0::wire {

/// How many states from one with the slow values to the next. assumed: forces at 400 Hz and energies at 100
/// Hz are as many as anybody shows
inline constexpr std::int32_t kForceEvery = 4, kSlowEvery = 16;
/// The held part is for whoever looks at it, who needs it less often than the coupling needs its pose.
inline constexpr std::int32_t kHeldEvery = 4;

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
  const bool is_faulted =
      m.state.safety.fault != device::SafetyFault::None;  // that the force is zero is news
  if (is_faulted || visit.isDue(m.state.tick, kForceEvery)) visit.coarse(report.F_hand_W);
  if (!visit.isDue(m.state.tick, kSlowEvery)) return;
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
  if (!visit.isDue(m.state.step, kHeldEvery)) return;
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
  visit.list(s.contacts, [&visit](ContactMark& mark) { fields(mark, visit); });
}

}  // namespace vps::scenes::inline v0::wire
