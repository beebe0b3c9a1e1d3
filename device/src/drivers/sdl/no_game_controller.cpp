// SPDX-License-Identifier: BSD-3-Clause
#include "vps/load_error.h"
#include "vps_device/hand_controllers.h"

namespace vps::device {

std::unique_ptr<Device> openGameController(const RateSettings&) {
  throw LoadError("", "", "this build has no game controller; install libsdl2-dev and build again");
}

}  // namespace vps::device
