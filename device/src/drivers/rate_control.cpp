// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/rate_control.h"

#include <algorithm>
#include <cmath>

namespace vps::device {

namespace {

constexpr double kLongestStep_s = 0.05;

Vec3 rates(const Vec3& deflection, const RateSettings& settings) {
  return deflection.unaryExpr([&](double x) { return rateShare(x, settings); });
}

Vec3 shortened(const Vec3& v, double longest) {
  const double length = v.norm();
  return length > longest ? Vec3(v * (longest / length)) : v;
}

}  // namespace

double rateShare(double deflection, const RateSettings& settings) noexcept {
  const double size = std::min(std::abs(deflection), 1.0);
  if (!(size > settings.dead_zone)) return 0;
  return std::copysign(std::pow((size - settings.dead_zone) / (1 - settings.dead_zone), settings.curve),
                       deflection);
}

const DeviceSample& RateControl::step(const Deflection& deflection, double now_s) noexcept {
  const double dt_s =
      has_time_ && now_s > sample_.time_s ? std::min(now_s - sample_.time_s, kLongestStep_s) : 0;
  if (std::isfinite(now_s)) {
    sample_.time_s = now_s;
    has_time_ = true;
  }
  sample_.V_DH = {};
  const bool is_good = deflection.push.allFinite() && deflection.turn.allFinite() && dt_s > 0;
  if (!is_good) return sample_;

  Vec3 step_m = dt_s * settings_.speed_m_s * rates(deflection.push, settings_);
  Vec3 step_rad = dt_s * settings_.turn_rad_s * rates(deflection.turn, settings_);
  if (deflection.is_recentring) {
    step_m = shortened(-sample_.X_DH.p, dt_s * settings_.recentre_m_s);
    step_rad = shortened(-rotationVector(sample_.X_DH.R), dt_s * settings_.recentre_rad_s);
  }
  const Vec3 edge_m = 0.5 * settings_.workspace_m;
  const Vec3 p = (sample_.X_DH.p + step_m).cwiseMax(-edge_m).cwiseMin(edge_m);
  sample_.V_DH = {step_rad / dt_s, Vec3((p - sample_.X_DH.p) / dt_s)};
  // Integrated through a quaternion, so that the matrix stays a rotation after many steps.
  sample_.X_DH = Pose(Quat(rotationFromVector(step_rad) * sample_.X_DH.R), p);
  return sample_;
}

DeviceLimits RateControl::limits() const noexcept {
  DeviceLimits limits;
  limits.workspace_min_D = -0.5 * settings_.workspace_m;
  limits.workspace_max_D = 0.5 * settings_.workspace_m;
  limits.rate_hz = settings_.rate_hz;
  return limits;
}

}  // namespace vps::device
