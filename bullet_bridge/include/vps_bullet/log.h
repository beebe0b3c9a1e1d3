// SPDX-License-Identifier: BSD-3-Clause
// Where the messages of this library go.
#pragma once

#include <functional>
#include <string>

#include "vps_bullet/export.h"
#include "vps_bullet/precision.h"

namespace vps::bullet {

enum class LogLevel {
  Info,     ///< what was chosen or done
  Warning,  ///< it goes on, but not as the host may expect
  Error,    ///< something has no contact, or no effect
};

/// Receives one sentence or more, without a line end. Called from any thread that steps a world, possibly at
/// the same time from several; it must not throw.
using LogHook = std::function<void(LogLevel level, const std::string& message)>;

/// Replaces the receiver, for all dispatchers of the process. An empty hook: stderr, as at the start, with
/// "vps: " before each message.
VPS_BULLET_API void setLogHook(LogHook hook);
/// Messages below it are dropped. At the start: Warning.
VPS_BULLET_API void setLogLevel(LogLevel least);

/// At most so many messages within a second reach the hook; the next one that does says how many did not.
inline constexpr int kLogLimit = 20;

}  // namespace vps::bullet
