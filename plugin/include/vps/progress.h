// SPDX-License-Identifier: BSD-3-Clause
// Callback for the progress of long computations.
#pragma once

#include <functional>
#include <string_view>

namespace vps {

/// Called from time to time with the name of the current work and the share done, 0 to 1. May be empty. Never
/// called from the haptic loop.
using Progress = std::function<void(std::string_view doing, double share)>;

}  // namespace vps
