// SPDX-License-Identifier: BSD-3-Clause
// What a voxmap cannot be: looked at before any memory is taken, or any number made an index. All throw
// LoadError.
#pragma once

#include <string>

#include "voxmap/voxmap_layout.h"

namespace vps {

/// Refuses a voxel size or a band that no map can have, NaN too.
void requireSettings(const VoxMapSettings& settings, const std::string& part = "");

/// Refuses a pose that is not made of numbers.
void requirePose(const Pose& X_MP);

/// Refuses a surface's box so far from the origin that indices of its cells would not hold: more than half of
/// their range of 32 bit, the other half is left to its own size. NaN too.
void requireNear(const Box& bounds_M, double voxel_m, const std::string& part = "");

/// Bytes that a directory of so many cells takes.
double directoryBytes(const Vec3& cells);

/// Refuses a directory that would not fit in memory; one that does has indices of 31 bit, as queries need.
/// @param cells  along each axis; of any size, since it may be counted before it can be an index
void requireDirectory(const Vec3& cells, const std::string& file = "", const std::string& part = "");

/// Refuses what would not fit in memory: "needs 12 GiB for its bricks, the limit is 4; REMEDY".
/// @param what_for  " for its bricks"
void requireMemory(double bytes, const std::string& what_for, const std::string& remedy,
                   const std::string& file = "", const std::string& part = "");

}  // namespace vps
