// SPDX-License-Identifier: BSD-3-Clause
// The level set in a file of any program.
#pragma once

#include <string>

#include "vdb/vdb_archive.h"

namespace vps {

struct LevelSet {
  openvdb::FloatGrid::Ptr grid;
  Pose X_FM;  ///< pose of the grid's lattice M in the file's frame: p_M = voxel_m times the index
  double voxel_m = 0;
  double band_m = 0;
};

/// Throws LoadError if the file has no level set, several of them and no name is given, or values that are
/// not distances to a surface; the message says what would help.
LevelSet levelSetOf(VdbArchive& archive, const std::string& file, const std::string& name);

/// Converts a grid of floats to a level set; the file's name is for errors.
LevelSet asLevelSet(const openvdb::FloatGrid::Ptr& grid, const std::string& file);

}  // namespace vps
