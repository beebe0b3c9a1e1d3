// SPDX-License-Identifier: BSD-3-Clause
// Pegs from 50 um too large to 50 um of clearance, as cases and as a table of verdicts: the answer to "does
// it fit?" changes at zero.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hand_scenes.h"
#include "vps_scenes/run/result.h"

namespace vps::hand {

struct EdgeCase {
  PegFit fit;
  bool is_faulty = false;  ///< the meshes have the faults of CAD exports (tests/search/faults.h)
  std::uint64_t seed = 1;  ///< of the faults and of the hand
};

/// Round and rectangular, 4, 8, 12 and 16 mm, sharp and chamfered, -50 to 50 um in steps of 5 um, closed and
/// faulty: 672 cases. The corners of a round peg point at the middle of the hole's flats, so that the parts
/// as drawn have exactly this clearance.
std::vector<EdgeCase> edgeCases(std::uint64_t seed);

/// "round 8 mm chamfered faulty"
std::string rowName(const EdgeCase& edge);
/// "round 8 mm chamfered faulty -15 um"
std::string caseName(const EdgeCase& edge);
scenes::Scene edgeScene(const EdgeCase& edge);

/// The verdict "not shown" is allowed if the clearance is nearer to zero than this: 2 um, and the chord of
/// one mesh across its diameter.
double edgeBand_m(const EdgeCase& edge);

enum class EdgeOutcome {
  Right,
  NotShown,   ///< Not shown, within the band
  MissedFit,  ///< Not shown, although the clearance is greater than the band
  Wrong,      ///< Fits or Not shown although the peg is too large, or Blocked although it fits
};
EdgeOutcome outcomeOf(const EdgeCase& edge, scenes::Verdict verdict);

struct EdgeTableSettings {
  std::size_t every = 1;  ///< runs each every-th case
  std::size_t first = 0;  ///< index of the first case
  std::uint64_t seed = 1;
  std::string only;         ///< runs only rows whose name contains this text
  bool has_wall = true;     ///< false: only the bottom of each hole is left
  std::string rows_file;    ///< a file that gets the rows too (support/table_rows.h)
  bool is_verbose = false;  ///< prints a line for each case
};

/// Runs the cases and prints the table. Returns the number of wrong verdicts.
int printEdgeTable(const EdgeTableSettings& settings);

}  // namespace vps::hand
