// SPDX-License-Identifier: BSD-3-Clause
// How the library's messages reach the log hook.
#pragma once

#include <string>

#include "vps_bullet/log.h"

namespace vps::bullet {

/// Passes a message to the hook, within the limits of log.h. Never throws. Thread-safe.
void report(LogLevel level, const std::string& message) noexcept;

/// install() was called for any dispatcher of the process.
void setContactInstalled();
[[nodiscard]] bool isContactInstalled();

/// Called with each bounding box that Bullet asks of a Shape while there is no installation. Bodies may be
/// added before install() is called, so it speaks at a later call, once.
void warnOfForgottenInstall();

}  // namespace vps::bullet
