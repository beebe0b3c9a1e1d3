// SPDX-License-Identifier: BSD-3-Clause
// The table of verdicts at the edge between fit and misfit.
#pragma once

#include <cstdint>
#include <string>

namespace vps::hand {

struct EdgeTableSettings {
  std::size_t every = 1;  ///< runs each every-th case
  std::size_t first = 0;  ///< from this one
  std::uint64_t seed = 1;
  std::string only;         ///< of the rows whose name contains this
  bool has_wall = true;     ///< false: only the bottom of each hole is left
  std::string rows_file;    ///< the rows go to this file as well (support/table_rows.h)
  bool is_verbose = false;  ///< a line for each case
};

/// Runs the cases and prints the table. The number of wrong verdicts.
int printEdgeTable(const EdgeTableSettings& settings);

}  // namespace vps::hand
