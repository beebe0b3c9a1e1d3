// SPDX-License-Identifier: BSD-3-Clause
// The space mouse in a build without libspnav.
#include "vps/errors.h"
#include "vps_device/device_kinds.h"
#include "vps_device/rate_control.h"

namespace vps::device {

std::unique_ptr<Device> openSpaceMouse(const RateSettings&) {
  throw LoadError("", "", "this build does not support space mice; install libspnav-dev and build again");
}

DeviceKind spaceMouseKind() {
  return {"space_mouse",
          "6-DOF mouse through spacenavd, moved by a person; gives no force",
          "install libspnav-dev and build again",
          [](const DeviceOptions&) { return openSpaceMouse(); },
          nullptr,
          [] { return std::string("this build lacks libspnav"); }};
}

}  // namespace vps::device
