// SPDX-License-Identifier: BSD-3-Clause
// Runs rows in both contact modes, looks for their edges, and prints the table.
#pragma once

#include "row.h"

namespace vps::stability {

struct Options {
  bool is_short = false;     ///< what must hold alone: no search for edges, no known breaks
  bool is_thorough = false;  ///< hours at rest
  std::vector<Mode> modes = {Mode::Constraint, Mode::Penalty};
};

/// What a row came to in one mode.
struct Result {
  std::string asked;    ///< the worst of what was asked for
  std::string edge;     ///< where it breaks, and how
  bool is_met = true;   ///< all that was asked for holds
  bool is_bar = true;   ///< what must hold holds
  std::string failure;  ///< else what did not
};

Result runRow(const Row& row, Mode mode, const Options& options);

/// Prints Markdown, a line a row. Returns how many bars were missed.
int printTable(const std::vector<Row>& rows, const Options& options);

}  // namespace vps::stability
