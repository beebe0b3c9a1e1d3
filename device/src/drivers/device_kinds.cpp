// SPDX-License-Identifier: BSD-3-Clause
#include "vps_device/device_kinds.h"

#include <array>

namespace vps::device {

// Each kind is defined in the source of its driver.
DeviceKind dualArmKind();
DeviceKind idealDualArmKind();
DeviceKind spaceMouseKind();
DeviceKind gameControllerKind();
DeviceKind mouseKind();

// An explicit list: a linker drops self-registering objects of a static library.
std::span<const DeviceKind> deviceKinds() {
  static const std::array kinds = {dualArmKind(), idealDualArmKind(), spaceMouseKind(), gameControllerKind(),
                                   mouseKind()};
  return kinds;
}

const DeviceKind* findDeviceKind(std::string_view name) {
  for (const DeviceKind& kind : deviceKinds())
    if (kind.name == name) return &kind;
  return nullptr;
}

std::string deviceKindNames() {
  std::string names;
  for (const DeviceKind& kind : deviceKinds()) names += (names.empty() ? "" : ", ") + std::string(kind.name);
  return names;
}

}  // namespace vps::device
