// SPDX-License-Identifier: BSD-3-Clause
// Voxmaps as .vdb files: OpenVDB level sets. Link vps::vdb.
#pragma once

#include <string>

#include "vps/pose.h"
#include "vps/vdb_export.h"
#include "vps/voxmap.h"

namespace vps {

/// Writes an ordinary OpenVDB level set (grid "surface", float, narrow band) that opens in Houdini and
/// Blender, with metadata from which loadVdb() restores the map to the bit. An existing file is replaced
/// whole or not at all. Throws LoadError.
VPS_VDB_API void saveVdb(const VoxMap& map, const std::string& file);

/// Reads a level set of any program: values of 16, 32 or 64 bit, cubic voxels.
///
/// A file of saveVdb() gives the same map to the bit. In other files, `grid` names the grid to read; without
/// a name the only level set is taken, or the only grid that looks like a level set. A band of up to 32
/// voxels is kept; a band thinner than 3 voxels is extended by fast sweeping, a first-order solution that
/// does not change the values that the file has. The values need not be true distances: the largest deviation
/// from a 1-Lipschitz function is measured, and widens sampleError_m() and the margins of culling. A grid
/// that is rotated, or moved off the lattice through the origin, is resampled (see resampledVoxMap());
/// loadPlacedVdb() does not resample.
///
/// Throws LoadError for a file that is missing or damaged, that holds no such grid or several, or that would
/// not fit in memory; the size is tested before memory is allocated.
VPS_VDB_API VoxMap loadVdb(const std::string& file, const std::string& grid = "");

/// A level set on its own lattice, with that lattice's pose in the file's frame F.
struct PlacedVdb {
  VoxMap map;
  Pose X_FM;
};

/// As loadVdb(), but without resampling: every node is a value of the file, rounded to the map's quantum.
VPS_VDB_API PlacedVdb loadPlacedVdb(const std::string& file, const std::string& grid = "");

}  // namespace vps
