// SPDX-License-Identifier: BSD-3-Clause
// Packs a rotation into a few bytes.
#pragma once

#include <cstdint>
#include <optional>

#include "vps/pose.h"

namespace vps::scenes {

/// Packs the three smaller components of the quaternion, 20 bits each, and the index of the largest one: 62
/// bits in total. Accurate to 5e-6 rad; n bits less multiply the error by 2^n.
/// @param bits  bits per component, at most 20
std::uint64_t packedRotation(const Mat3& R, unsigned bits = 20);
/// Unpacks a rotation; empty if no rotation has this packed value.
std::optional<Mat3> unpackedRotation(std::uint64_t packed, unsigned bits = 20);

}  // namespace vps::scenes
