// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/dual_arm/frames.h"

namespace vps::device {
namespace {

Pose between(const DualArmParameters& parameters, DeviceFrame from, DeviceFrame to) {
  return framePose(parameters, to).inverse() * framePose(parameters, from);
}

}  // namespace

const char* toText(DeviceFrame frame) noexcept {
  switch (frame) {
    case DeviceFrame::Independent:
      return "independent";
    case DeviceFrame::Left:
      return "left";
    case DeviceFrame::Right:
      return "right";
  }
  return "unknown";
}

Pose framePose(const DualArmParameters& parameters, DeviceFrame frame) noexcept {
  if (frame == DeviceFrame::Independent) return {};
  return armBase(parameters, frame == DeviceFrame::Left ? Side::Left : Side::Right);
}

Pose inFrame(const DualArmParameters& parameters, const Pose& X, DeviceFrame from, DeviceFrame to) noexcept {
  return between(parameters, from, to) * X;
}

Twist inFrame(const DualArmParameters& parameters, const Twist& V, DeviceFrame from,
              DeviceFrame to) noexcept {
  const Mat3 R = between(parameters, from, to).R;
  return {R * V.w, R * V.v};
}

Wrench inFrame(const DualArmParameters& parameters, const Wrench& F, DeviceFrame from,
               DeviceFrame to) noexcept {
  return rotated(between(parameters, from, to).R, F);
}

}  // namespace vps::device
