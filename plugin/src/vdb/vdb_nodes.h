// SPDX-License-Identifier: BSD-3-Clause
// Converts the values of an OpenVDB tree to bricks.
#pragma once

#include "vdb/vdb_format.h"

namespace vps {

/// Determines the directory: all cells with a value below the background, one cell more below for borders,
/// and one empty cell around. Throws LoadError if the directory would not fit in memory.
void layOut(const openvdb::FloatTree& tree, double quantum_m, const std::string& file, VoxLayout& layout);

/// Fills the directory with bricks: every node is the tree's value, rounded and clamped to the band. If the
/// bricks would not fit in memory, throws LoadError before memory is allocated. O(cells + nodes of bricks),
/// parallel.
void readNodes(const openvdb::FloatTree& tree, double quantum_m, const std::string& file, VoxLayout& layout);

}  // namespace vps
