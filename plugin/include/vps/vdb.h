// SPDX-License-Identifier: BSD-3-Clause
// Voxmaps as .vdb files. In the library vps::vdb, so that only programs that use it need OpenVDB.
#pragma once

#include <string>

#include "vps/pose.h"
#include "vps/vdb_export.h"
#include "vps/voxmap.h"

namespace vps {

/// Writes an ordinary OpenVDB level set ("surface", float, narrow band) that opens in Houdini and Blender.
/// Goes to a temporary name first: an existing file is replaced whole or not at all. Throws LoadError.
VPS_VDB_API void saveVdb(const VoxMap& map, const std::string& file);

/// Reads a level set of any program: values of 16, 32 or 64 bit; cubes for voxels. Files of ours come back to
/// the bit. Of others, `grid` names the one to read; unnamed, the only level set is taken, or the only grid
/// that looks like one. Its band is kept up to 32 voxels; one thinner than 3 is extended by fast sweeping, a
/// first-order solution that leaves what is there as it is. Values need not be true distances: how far they
/// are from any function that changes by the way gone is measured, and widens sampleError_m() and what
/// culling allows for. A grid that is turned or moved off the lattice through the origin is resampled (see
/// resampledVoxMap()); loadPlacedVdb() leaves it as it is. Throws LoadError on a file that is missing or
/// damaged, that holds no such grid or several, and on what would not fit in memory (before taking it).
VPS_VDB_API VoxMap loadVdb(const std::string& file, const std::string& grid = "");

/// A level set on its own lattice, and where that lies in the file's frame F.
struct PlacedVdb {
  VoxMap map;
  Pose X_FM;
};

/// As loadVdb(), but every node is a value of the file, rounded to the map's quantum.
VPS_VDB_API PlacedVdb loadPlacedVdb(const std::string& file, const std::string& grid = "");

}  // namespace vps
