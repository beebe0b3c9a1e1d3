// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/pulled_handle.h"

#include <algorithm>
#include <cmath>

namespace vps::device {
namespace {

constexpr double kReach_m = 1e3;  // the workspace has no limit, but the splitting of paths needs a number
constexpr double kLongestTick_s = 0.02;  // 7 mm at the greatest speed, a third of the guard's jump limit

/// Speed under the force f and the spring, whose pull is at most `most`: b v = k (e - v dt) + f. The equation
/// is implicit in v and therefore stable for any step; with the spring at its limit, b v = limit + f.
Vec3 speed(const Vec3& e, const Vec3& f, double k, double b, double most, double dt_s) {
  Vec3 v = (k * e + f) / (b + k * dt_s);
  const Vec3 pull = k * (e - v * dt_s);
  const double size = pull.norm();
  if (size > most) v = (pull * (most / size) + f) / b;
  return v;
}

}  // namespace

const DeviceSample& PulledHandle::step(const Pose& X_DH_wish, const Wrench& F_Ho_D, double now_s) noexcept {
  const double dt_s =
      has_time_ && now_s > sample_.time_s ? std::min(now_s - sample_.time_s, kLongestTick_s) : 0;
  if (std::isfinite(now_s)) {
    sample_.time_s = now_s;
    has_time_ = true;
  }
  sample_.V_DH = {};
  if (!(dt_s > 0) || !X_DH_wish.isFinite()) return sample_;
  const Wrench F = F_Ho_D.isFinite() ? F_Ho_D : Wrench{};
  const Vec3 e_m = X_DH_wish.p - sample_.X_DH.p;
  const Vec3 e_rad = rotationVector(X_DH_wish.R * sample_.X_DH.R.transpose());
  const PulledHandleSettings& s = settings_;
  sample_.V_DH.v = speed(e_m, F.f, s.k_N_per_m, s.b_Ns_per_m, s.force_N, dt_s);
  sample_.V_DH.w = speed(e_rad, F.tau, s.k_Nm_per_rad, s.b_Nms_per_rad, s.torque_Nm, dt_s);
  // Integrated through a quaternion, so that the matrix stays a rotation after many steps.
  sample_.X_DH = Pose(Quat(rotationFromVector(dt_s * sample_.V_DH.w) * sample_.X_DH.R),
                      Vec3(sample_.X_DH.p + dt_s * sample_.V_DH.v));
  return sample_;
}

DeviceLimits PulledHandle::limits() const noexcept {
  DeviceLimits limits;
  // The force on the hand cannot exceed the pull of the spring.
  limits.continuous_force_N = limits.peak_force_N = settings_.force_N;
  limits.continuous_torque_Nm = limits.peak_torque_Nm = settings_.torque_Nm;
  limits.workspace_min_D = Vec3::Constant(-kReach_m);
  limits.workspace_max_D = Vec3::Constant(kReach_m);
  limits.rate_hz = settings_.rate_hz;
  // assumed: the usual delay of a thread without real-time priority on a desktop
  limits.delay_s = 4e-3;
  limits.damping_Ns_per_m = settings_.b_Ns_per_m;
  limits.damping_Nms_per_rad = settings_.b_Nms_per_rad;
  return limits;
}

}  // namespace vps::device
