// SPDX-License-Identifier: BSD-3-Clause
// Space mouse and game controller: devices without force, under rate control.
#pragma once

#include <memory>

#include "vps_device/export.h"
#include "vps_device/rate_control.h"

namespace vps::device {

/// A thread of the device's own calls the library, which may wait, allocate and search for hardware; the
/// haptic thread reads the latest deflection from a TripleBuffer. A device that is absent or unplugged reads
/// as lost (Status::Fault) and is searched for again; once it is back, the handle continues where it stood.
/// The safety guard needs rearm() then, as after every loss.

/// The first space mouse of the spacenavd daemon (socket: SPNAV_SOCKET, /etc/spnavrc or /var/run/spnav.sock).
/// Button 0 re-centres. Throws LoadError if this build lacks libspnav, or while another one exists: the
/// library supports one connection per program.
VPS_DEVICE_API std::unique_ptr<Device> openSpaceMouse(const RateSettings& settings = {});

/// The first game controller that SDL finds. Left stick: sideways, and towards or away from the person;
/// triggers: up (right) and down; right stick: rotation about z and y; shoulders: about x; start: re-centres.
/// Throws LoadError if this build lacks SDL2.
VPS_DEVICE_API std::unique_ptr<Device> openGameController(const RateSettings& settings = {});

}  // namespace vps::device
