// SPDX-License-Identifier: BSD-3-Clause
// Who may take part in sessions over UDP: DDS-Security, by the plugins of Cyclone DDS.
#pragma once

#include <string>

#include "vps_scenes/network/session_network.h"

namespace vps::scenes {

/// The part of Cyclone's settings that names certificates and plugins; empty: without security. Throws
/// LoadError where a file is missing, where this machine lacks the plugins, and where other machines could
/// reach a network without certificates.
std::string securitySettings(const SessionNetwork& network, bool is_loopback);

}  // namespace vps::scenes
