// SPDX-License-Identifier: BSD-3-Clause
// Messages of the library: how they reach the log hook, and the warning about a forgotten install().
#pragma once

#include <string>

#include "vps_bullet/log.h"

namespace vps::bullet {

/// Passes a message to the log hook, within the limits of log.h. Never throws. Thread-safe.
void report(LogLevel level, const std::string& message) noexcept;

/// Notes that install() was called for a dispatcher of this process.
void setContactInstalled();
[[nodiscard]] bool isContactInstalled();

/// Must be called for each bounding box that Bullet requests of a Shape while there is no installation.
/// Without install() parts would fall through planes without a message. Bodies may be added before install(),
/// so the warning is given at a later call, once.
void warnOfForgottenInstall();

}  // namespace vps::bullet
