// SPDX-License-Identifier: BSD-3-Clause
#include "vps/coupling_law.h"

#include <algorithm>

namespace vps {
namespace {

/// Shortens v to at most `limit` and keeps its direction, so that saturation does not turn the force.
Vec3 limited(const Vec3& v, double limit) {
  const double length = v.norm();
  return length > limit ? Vec3(v * (limit / length)) : v;
}

/// Energy of a spring of stiffness k at this stretch; its force does not exceed `limit`.
double storedEnergy(double k, double stretch, double limit) {
  const double elastic = std::min(stretch, limit / k);
  return 0.5 * k * elastic * elastic + limit * (stretch - elastic);
}

}  // namespace

Wrench couplingWrench(const CouplingGains& gains, const CouplingState& proxy,
                      const CouplingState& part) noexcept {
  if (!proxy.X_W.isFinite() || !part.X_W.isFinite()) return {};  // NaN has no rotation vector
  const Vec3 p_error_W = proxy.X_W.p - part.X_W.p;
  const Vec3 r_error_W = rotationVector(proxy.X_W.R * part.X_W.R.transpose());

  Wrench F_part_W;
  F_part_W.f =
      limited(gains.k_N_per_m * p_error_W, gains.max_force_N) + gains.b_Ns_per_m * (proxy.V_W.v - part.V_W.v);
  F_part_W.tau = limited(gains.k_Nm_per_rad * r_error_W, gains.max_torque_Nm) +
                 gains.b_Nms_per_rad * (proxy.V_W.w - part.V_W.w);
  // One test of the result catches velocities and gains that are not finite, and overflow.
  return F_part_W.isFinite() ? F_part_W : Wrench{};
}

double couplingEnergy_J(const CouplingGains& gains, const CouplingState& proxy,
                        const CouplingState& part) noexcept {
  return storedEnergy(gains.k_N_per_m, (proxy.X_W.p - part.X_W.p).norm(), gains.max_force_N) +
         storedEnergy(gains.k_Nm_per_rad, rotationVector(proxy.X_W.R * part.X_W.R.transpose()).norm(),
                      gains.max_torque_Nm);
}

}  // namespace vps
