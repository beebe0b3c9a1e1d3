// SPDX-License-Identifier: BSD-3-Clause
// The kinds of device in this build, by the name that a scene's [device] kind and `vps device --list` use. To
// add a kind: device/DRIVERS.md, "A device of your own".
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "vps_device/export.h"
#include "vps_device/pulled_handle.h"
#include "vps_device/simulated_device.h"

namespace vps::device {

/// Options for opening a device. A kind ignores options that do not apply to it.
struct DeviceOptions {
  std::string parameter_file;          ///< parameter file of the dual arm; empty: the built-in parameters
  double rate_hz = 1000;               ///< rate of read-write cycles
  bool has_quantised_encoders = true;  ///< a simulated device rounds its readings to encoder steps
  Pose X_DH_start;                     ///< first pose of a simulated device's handle
  /// Box about D's origin that the handle can reach, for devices under rate control, which have no range of
  /// their own.
  Vec3 workspace_m = Vec3(0.4, 0.6, 0.4);
  std::shared_ptr<HandleWish> wish;  ///< wanted handle pose, set by the window, followed by the mouse device
};

/// Exactly one of `open` and `simulate` is set.
struct DeviceKind {
  std::string_view name;         ///< "space_mouse"
  std::string_view description;  ///< description in one line
  std::string_view remedy;       ///< what to do if the device does not answer
  /// Opens a device that a person moves. Throws LoadError. A device that is not plugged in opens too, and
  /// reads as lost (Status::Fault) until it is plugged in.
  std::unique_ptr<Device> (*open)(const DeviceOptions&) = nullptr;
  /// Makes a simulated device. Throws LoadError.
  std::unique_ptr<SimulatedDevice> (*simulate)(const DeviceOptions&) = nullptr;
  /// Why the device cannot be used here and now; empty: no reason is known.
  std::string (*missing)() = nullptr;

  [[nodiscard]] bool isSimulated() const { return simulate != nullptr; }
};

/// All kinds, in the order of a listing.
VPS_DEVICE_API std::span<const DeviceKind> deviceKinds();
/// Null if there is no such kind.
VPS_DEVICE_API const DeviceKind* findDeviceKind(std::string_view name);
/// The names of all kinds for a message: "dual_arm, ideal_dual_arm, ..."
VPS_DEVICE_API std::string deviceKindNames();

}  // namespace vps::device
