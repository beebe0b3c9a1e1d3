// SPDX-License-Identifier: BSD-3-Clause
#include "vps/load_error.h"
#include "vps_device/hand_controllers.h"

namespace vps::device {

std::unique_ptr<Device> openSpaceMouse(const RateSettings&) {
  throw LoadError("", "", "this build has no space mouse; install libspnav-dev and build again");
}

}  // namespace vps::device
