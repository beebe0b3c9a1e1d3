// SPDX-License-Identifier: BSD-3-Clause
// How much memory this machine has.
#pragma once

namespace vps::scenes::inline v0 {

/// Total memory in bytes; 0 where the system does not report it.
double machineMemoryBytes() noexcept;

}  // namespace vps::scenes::inline v0
