// SPDX-License-Identifier: BSD-3-Clause
// How the library's messages reach the log hook.
#pragma once

#include <string>

#include "vps_bullet/log.h"

namespace vps::bullet {

/// Passes a message to the hook, within the limits of log.h. Never throws. Thread-safe.
void report(LogLevel level, const std::string& message) noexcept;

}  // namespace vps::bullet
