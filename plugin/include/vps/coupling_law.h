// SPDX-License-Identifier: BSD-3-Clause
// The virtual coupling between the device's proxy and the part in hand: the law, and the port where the
// haptic and the physics side meet. Neither side includes the other.
#pragma once

#include "vps/pose.h"
#include "vps/triple_buffer.h"
#include "vps/wrench.h"

namespace vps {

/// A 6-DOF spring-damper. Limits bound the spring's part, keeping its direction, so that a part that hangs
/// back pulls with a known greatest force.
struct CouplingGains {
  double k_N_per_m = 2000;
  double b_Ns_per_m = 10;
  double k_Nm_per_rad = 4;
  double b_Nms_per_rad = 0.02;
  double max_force_N = 30;
  double max_torque_Nm = 2.5;
};

/// The coupled frame on one side: proxy or part, at the grasp point, in W.
struct CouplingState {
  Pose X_W;
  Twist V_W;
  double time_s = 0;
  bool is_coupled = false;
};

/// Wrench on the part about its grasp point, in W: k times the pose error plus b times the velocity error,
/// springs limited. The proxy gets the opposite. Zero if anything is not finite. Never throws or allocates.
/// Source: Colgate, Stanley and Brown 1995 (virtual coupling); rotation error as a rotation vector.
Wrench couplingWrench(const CouplingGains& gains, const CouplingState& proxy,
                      const CouplingState& part) noexcept;

/// Energy stored in the coupling's springs [J]. Beyond a spring's limit its force is constant, so the energy
/// grows linearly there. Takes both states as coupled. Never throws or allocates.
double couplingEnergy_J(const CouplingGains& gains, const CouplingState& proxy,
                        const CouplingState& part) noexcept;

/// Where the two rates meet: the haptic side writes the proxy, the physics side writes the part; each reads
/// the other's latest without waiting.
struct CouplingPort {
  TripleBuffer<CouplingState> proxy;
  TripleBuffer<CouplingState> part;
};

}  // namespace vps
