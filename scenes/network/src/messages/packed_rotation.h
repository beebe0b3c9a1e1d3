// SPDX-License-Identifier: BSD-3-Clause
// A rotation in a few bytes.
#pragma once

#include <cstdint>
#include <optional>

#include "vps/pose.h"

namespace vps::scenes {

/// The three smaller components of the quaternion, 20 bits each, and which the largest one is: 62 bits. Right
/// to 5e-6 rad, and to 2^n as much with n bits less.
/// @param bits  of a component, at most 20
std::uint64_t packedRotation(const Mat3& R, unsigned bits = 20);
/// Empty: no rotation has this number.
std::optional<Mat3> unpackedRotation(std::uint64_t packed, unsigned bits = 20);

}  // namespace vps::scenes
