// SPDX-License-Identifier: BSD-3-Clause
// The text of data/dual_arm.toml, embedded at build time.
#pragma once

namespace vps::device {

extern const char* const kDualArmToml;

}  // namespace vps::device
