// SPDX-License-Identifier: BSD-3-Clause
// Space mouse and game controller: devices without force, under rate control.
#pragma once

#include <memory>

#include "vps_device/export.h"
#include "vps_device/rate_control.h"

namespace vps::device {

/// Each has a thread of its own that talks to the library, which may wait, allocate and look for hardware;
/// the haptic thread takes the latest deflection from a TripleBuffer and never meets it. A device that is not
/// there, or is unplugged, reads as lost (Status::Fault), and is looked for again: once it is back it goes on
/// where the handle stood. The safety guard wants to be re-armed then, as after every loss.

/// The first space mouse of the spacenavd daemon (socket: SPNAV_SOCKET, /etc/spnavrc or /var/run/spnav.sock).
/// Button 0 re-centres. Throws LoadError where this build lacks libspnav, or while another one lives: the
/// library knows one connection a program.
VPS_DEVICE_API std::unique_ptr<Device> openSpaceMouse(const RateSettings& settings = {});

/// The first game controller that SDL knows. Left stick: to the sides, to and fro; triggers: up (right) and
/// down; right stick: turns about z and y; shoulders: about x; start: re-centres. Throws LoadError where this
/// build lacks SDL2.
VPS_DEVICE_API std::unique_ptr<Device> openGameController(const RateSettings& settings = {});

}  // namespace vps::device
