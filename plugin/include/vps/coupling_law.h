// SPDX-License-Identifier: BSD-3-Clause
// The force law of the virtual coupling between the device's proxy and the part in hand. The haptic and the
// physics thread both evaluate it.
#pragma once

#include "vps/export.h"
#include "vps/pose.h"
#include "vps/wrench.h"

namespace vps {

/// A 6-DOF spring-damper. The limits apply to the spring's part of the force and keep its direction, so that
/// the force on a part that lags behind the proxy has a known upper bound.
struct CouplingGains {
  double k_N_per_m = 2000;
  double b_Ns_per_m = 10;
  double k_Nm_per_rad = 4;
  double b_Nms_per_rad = 0.02;
  double max_force_N = 30;
  double max_torque_Nm = 2.5;
};

/// State of one coupled frame (of the proxy or of the part) at the grasp point, in W.
struct CouplingState {
  Pose X_W;
  Twist V_W;
  double time_s = 0;
  bool is_coupled = false;
};

/// Wrench on the part about its grasp point, in W: k times the pose error plus b times the velocity error,
/// with the springs' forces limited. The opposite wrench acts on the proxy. The wrench is zero if any input
/// is not finite. Never throws or allocates. Source: Colgate, Stanley and Brown 1995 (virtual coupling);
/// rotation error as a rotation vector.
VPS_API Wrench couplingWrench(const CouplingGains& gains, const CouplingState& proxy,
                              const CouplingState& part) noexcept;

/// Energy stored in the coupling's springs [J]. Beyond a spring's limit its force is constant, so the energy
/// grows linearly there. The member is_coupled of both states is ignored: the coupling counts as active.
/// Never throws or allocates.
VPS_API double couplingEnergy_J(const CouplingGains& gains, const CouplingState& proxy,
                                const CouplingState& part) noexcept;

}  // namespace vps
