// SPDX-License-Identifier: BSD-3-Clause
// Converts the values of an OpenVDB tree to bricks.
#pragma once

#include "vdb/vdb_format.h"

namespace vps {

/// Determines the directory: all cells with a value below the background, one more below for borders, and one
/// empty cell around. Throws LoadError if it would not fit in memory.
void layOut(const openvdb::FloatTree& tree, double quantum_m, const std::string& file, VoxLayout& layout);

/// Fills the directory with bricks: every node is the tree's value, rounded and clamped to the band. Throws
/// LoadError before memory is allocated if they would not fit. O(cells + nodes of bricks), parallel.
void readNodes(const openvdb::FloatTree& tree, double quantum_m, const std::string& file, VoxLayout& layout);

}  // namespace vps
