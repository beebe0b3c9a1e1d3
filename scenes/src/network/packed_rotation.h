// SPDX-License-Identifier: BSD-3-Clause
// A rotation in eight bytes.
#pragma once

#include <cstdint>
#include <optional>

#include "vps/pose.h"

namespace vps::scenes::inline v0 {

/// The three smaller components of the quaternion, 20 bits each, and which the largest one is. Right to 3e-6
/// rad.
std::uint64_t packedRotation(const Mat3& R);
/// Empty: no rotation has this number.
std::optional<Mat3> unpackedRotation(std::uint64_t packed);

}  // namespace vps::scenes::inline v0
