// SPDX-License-Identifier: BSD-3-Clause
// How much memory this machine has.
#pragma once

namespace vps::scenes {

/// Total memory in bytes; 0 where the system does not report it.
double machineMemoryBytes() noexcept;

}  // namespace vps::scenes
