// SPDX-License-Identifier: BSD-3-Clause
// How long work tells a person how far it is.
#pragma once

#include <functional>
#include <string_view>

namespace vps {

/// Called now and then with what is being done and the share done, 0 to 1. May be empty. Never from the
/// haptic path.
using Progress = std::function<void(std::string_view doing, double share)>;

}  // namespace vps
