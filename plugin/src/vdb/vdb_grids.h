// SPDX-License-Identifier: BSD-3-Clause
// The grids of a .vdb file: their list, the level set among them, and the conversion of its values to bricks.
#pragma once

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>

#include <sstream>
#include <string>
#include <vector>

#include "vdb/vdb_format.h"

namespace vps {

/// Throws exceptions of OpenVDB and of streams. OpenVDB does not check whether a read was complete; the
/// stream does.
class VdbArchive : private openvdb::io::Archive {
 public:
  struct Entry {
    openvdb::io::GridDescriptor descriptor;
    openvdb::GridBase::Ptr grid;  ///< metadata and transform; includes the tree only if it had to be read
    bool is_read = false;
    [[nodiscard]] std::string name() const;
    /// Size of the tree in memory as recorded in the file; 0 if it is not recorded.
    [[nodiscard]] double bytes() const;
  };

  /// Lists the grids. A file that was written as a stream has no table of grids: all grids are read, up to
  /// the first one that is recorded as larger than `limit_bytes`, with which the list ends.
  VdbArchive(std::string bytes, double limit_bytes);

  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  /// Reads the grid with its tree.
  openvdb::GridBase::Ptr read(std::size_t entry);

 private:
  void list(Entry& entry);

  std::istringstream stream_;
  std::vector<Entry> entries_;
};

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

/// Determines the directory: all cells with a value below the background, one cell more below for borders,
/// and one empty cell around. Throws LoadError if the directory would not fit in memory.
void layOut(const openvdb::FloatTree& tree, double quantum_m, const std::string& file, VoxLayout& layout);

/// Fills the directory with bricks: every node is the tree's value, rounded and clamped to the band. If the
/// bricks would not fit in memory, throws LoadError before memory is allocated. O(cells + nodes of bricks),
/// parallel.
void readNodes(const openvdb::FloatTree& tree, double quantum_m, const std::string& file, VoxLayout& layout);

}  // namespace vps
