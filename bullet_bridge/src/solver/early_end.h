// SPDX-License-Identifier: BSD-3-Clause
// The end of a step whose rounds of checks were used up with contacts still missed.
#pragma once

#include <span>

#include "solver/contact_sweeps.h"
#include "solver/island.h"
#include "solver/joint_rows.h"
#include "solver/step_check.h"

namespace vps::bullet {

/// Where points would be too deep at the end of the step, or sharp features too near to each other, the
/// bodies of the pair, and those that hang together with them by joints and by contacts with load, move only
/// a share of their way: IslandBody::way_share. They keep the velocities of the solution, and the rest of the
/// step is spent in place. So they hit nothing harder than was solved, and the next step begins near contacts
/// that it then knows. A kinematic body goes on; what it comes to is not stopped for it in vain.
/// @param contacts, joints  of the solved island
/// @param push              its velocities, as ContactSweeps::push()
/// @return true if a body's way is shorter
bool endEarly(Island& island, std::span<const RigidContact> contacts, const JointRows& joints,
              std::span<StepCheck* const> checks, std::span<const Vec6> push, double dt_s);

}  // namespace vps::bullet
