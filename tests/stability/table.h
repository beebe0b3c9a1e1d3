// SPDX-License-Identifier: BSD-3-Clause
// Runs rows with both contact methods, searches for their limits, and prints the table.
#pragma once

#include "row.h"
#include "support/table_rows.h"

namespace vps::stability {

struct Options {
  bool is_short = false;     ///< only the values that must hold, no search for limits
  bool is_thorough = false;  ///< hours at rest
  std::vector<Mode> modes = {Mode::Constraint, Mode::Penalty};
};

/// Result of a row in one mode.
struct Result {
  std::string promised;         ///< outcome of the promised values
  std::string limit;            ///< where it fails, and how
  bool is_met = true;           ///< all promised values hold
  bool is_required_met = true;  ///< all required values hold
  std::string failure;          ///< otherwise the reason
};

Result runRow(const Row& row, Mode mode, const Options& options);

/// Prints Markdown, one line for each row, and adds each to `file`. Returns how many rows miss a required
/// value.
int printTable(const std::vector<Row>& rows, const Options& options, test::TableRows& file);

}  // namespace vps::stability
