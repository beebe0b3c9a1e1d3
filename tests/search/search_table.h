// SPDX-License-Identifier: BSD-3-Clause
// Runs random cases row by row and prints what was found.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "case_run.h"
#include "families.h"

namespace vps::search {

/// A row is a family, a time step, and closed or faulty meshes.
struct SearchOptions {
  std::uint64_t seed = 0;             ///< of the first case of each row; the others count up
  double minutes = 0;                 ///< of the clock, for all rows; 0: no limit
  double seconds_simulated = 0;       ///< of each row; 0: no limit
  long runs = 0;                      ///< of each row; 0: no limit
  std::vector<std::string> families;  ///< empty: all
  std::vector<double> steps_s{1e-3, 4e-3, 10e-3};
  bool has_closed = true, has_faulty = true;
  dynamics::Mode mode = dynamics::Mode::Constraint;
  std::string save_folder = "out/search";  ///< for cases that exceed the bound
  std::string rows_file;  ///< the rows go to this file as well (support/table_rows.h); empty: to none
  bool is_verbose = false;
};

/// Rows take turns, a case each, so that a limit of time is shared. Prints each case that exceeds the bound
/// with the command that repeats it, then the table.
/// @return true if no case exceeded its bound: 10 um with steps of 1 ms and constraint contact; with others
/// no tunnelling. A case that the engine refuses counts as a failure.
bool printTable(const SearchOptions& options);

}  // namespace vps::search
