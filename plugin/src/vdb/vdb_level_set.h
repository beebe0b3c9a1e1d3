// SPDX-License-Identifier: BSD-3-Clause
// A level set from a file of any program.
#pragma once

#include <string>

#include "vdb/vdb_archive.h"

namespace vps {

struct LevelSet {
  openvdb::FloatGrid::Ptr grid;
  Pose X_FM;  ///< of the grid's lattice M in the file's frame: p_M = voxel_m times the index
  double voxel_m = 0;
  double band_m = 0;
};

/// Throws LoadError if the file has no level set, several and no name is given, or one that is not a distance
/// to a surface; the message says what would help.
LevelSet levelSetOf(VdbArchive& archive, const std::string& file, const std::string& name);

/// Takes a grid of floats as a level set; the file's name is for errors.
LevelSet asLevelSet(const openvdb::FloatGrid::Ptr& grid, const std::string& file);

}  // namespace vps
