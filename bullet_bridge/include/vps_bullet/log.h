// SPDX-License-Identifier: BSD-3-Clause
// The log hook: where the messages of this library go.
#pragma once

#include <functional>
#include <string>

#include "vps_bullet/export.h"
#include "vps_bullet/precision.h"

namespace vps::bullet {

enum class LogLevel {
  Info,     ///< a choice that the library made, or an action
  Warning,  ///< the run continues, but possibly not as the host expects
  Error,    ///< something has no contact, or no effect
};

/// Receives one sentence or more, without a line end. Called from any thread that steps a world, possibly at
/// the same time from several; it must not throw.
using LogHook = std::function<void(LogLevel level, const std::string& message)>;

/// Sets the receiver of messages, for all dispatchers of the process. With an empty hook, as at the start,
/// messages go to stderr, each after "vps: ".
VPS_BULLET_API void setLogHook(LogHook hook);
/// Drops messages below this level. The initial level is Warning.
VPS_BULLET_API void setLogLevel(LogLevel least);

/// Greatest number of messages per second that reach the hook. The next message that reaches the hook tells
/// how many messages were dropped.
inline constexpr int kLogLimit = 20;

}  // namespace vps::bullet
