// SPDX-License-Identifier: BSD-3-Clause
// The game controller in a build without SDL2.
#include "vps/errors.h"
#include "vps_device/device_kinds.h"
#include "vps_device/rate_control.h"

namespace vps::device {

std::unique_ptr<Device> openGameController(const RateSettings&) {
  throw LoadError("", "",
                  "this build does not support game controllers; install libsdl2-dev and build again");
}

DeviceKind gameControllerKind() {
  return {"game_controller",
          "game controller through SDL2, moved by a person; gives no force",
          "install libsdl2-dev and build again",
          [](const DeviceOptions&) { return openGameController(); },
          nullptr,
          [] { return std::string("this build lacks SDL2"); }};
}

}  // namespace vps::device
