// SPDX-License-Identifier: BSD-3-Clause
// Limits of voxmaps, checked before memory is allocated or a number becomes an index. All functions throw
// LoadError.
#pragma once

#include <string>

#include "voxmap/voxmap_layout.h"

namespace vps {

/// Refuses voxel sizes and bands that no map can have, including NaN.
void requireSettings(const VoxMapSettings& settings, const std::string& part = "");

/// Refuses a pose that is not finite.
void requirePose(const Pose& X_MP);

/// Refuses a surface's box so far from the origin that indices of its cells would overflow: at more than half
/// the range of 32 bits. The other half of the range is for the size of the box. Refuses NaN too.
void requireNear(const Box& bounds_M, double voxel_m, const std::string& part = "");

/// Bytes of a directory with this number of cells along each axis.
double directoryBytes(const Vec3& cells);

/// Refuses a directory that would not fit in memory; one that fits has indices of 31 bits, as queries need.
/// @param cells  along each axis; of type double, since the count may exceed the range of an index
VPS_API void requireDirectory(const Vec3& cells, const std::string& file = "", const std::string& part = "");

/// Refuses data that would not fit in memory, with the message "needs 12 GiB for its bricks, the limit is 4
/// GiB; REMEDY".
/// @param what_for  the purpose in the message, such as " for its bricks"
VPS_API void requireMemory(double bytes, const std::string& what_for, const std::string& remedy,
                           const std::string& file = "", const std::string& part = "");

/// Throws LoadError for settings that no map can have and for a mesh whose map would not fit in memory; the
/// message names a voxel size that would fit.
void requireFits(const Mesh& mesh, const VoxMapSettings& settings, const std::string& part);

}  // namespace vps
