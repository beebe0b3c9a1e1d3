// SPDX-License-Identifier: BSD-3-Clause
// One function per kind of device, each defined in a file of its own.
#pragma once

#include "vps_device/device_kinds.h"
#include "vps_device/rate_control.h"

namespace vps::device {

DeviceKind dualArmKind();
DeviceKind idealDualArmKind();
DeviceKind spaceMouseKind();
DeviceKind gameControllerKind();
DeviceKind mouseKind();

inline RateSettings rateSettings(const DeviceOptions& options) {
  RateSettings settings;
  settings.rate_hz = options.rate_hz;
  settings.workspace_m = options.workspace_m;
  return settings;
}

}  // namespace vps::device
