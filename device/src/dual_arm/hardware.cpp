// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/dual_arm/hardware.h"

#include <algorithm>
#include <cmath>

namespace vps::device {
namespace {

// The peak decreases over the last tenth of the heat budget, so that force does not drop abruptly.
constexpr double kBlend = 0.1;

double shareOf(double heat) {
  return std::clamp((1 - heat) / kBlend, 0.0, 1.0);
}

}  // namespace

MotorHeat::MotorHeat(const DualArmParameters& parameters) noexcept
    : continuous_(motorLimits(parameters, 0)),
      peak_(motorLimits(parameters, 1)),
      thermal_s_(parameters.thermal_s) {}

void MotorHeat::add(const JointVector& efforts, double dt_s) noexcept {
  // Exact for a constant effort, so that one long tick heats as much as many short ones.
  const double share = -std::expm1(-dt_s / thermal_s_);
  heat_ += share * (efforts.cwiseQuotient(continuous_).cwiseAbs2() - heat_);
}

JointVector MotorHeat::limits() const noexcept {
  JointVector limit;
  for (int i = 0; i < 7; ++i) limit[i] = continuous_[i] + shareOf(heat_[i]) * (peak_[i] - continuous_[i]);
  return limit;
}

double MotorHeat::peakShare() const noexcept {
  return shareOf(heat_.maxCoeff());
}

}  // namespace vps::device
