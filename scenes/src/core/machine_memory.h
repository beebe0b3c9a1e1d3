// SPDX-License-Identifier: BSD-3-Clause
// How much memory this machine has.
#pragma once

namespace vps::scenes {

/// Bytes, all in all; 0 where the system does not say.
double machineMemoryBytes() noexcept;

}  // namespace vps::scenes
