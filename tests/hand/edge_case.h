// SPDX-License-Identifier: BSD-3-Clause
// Pegs from 50 um too large to 50 um of clearance: the answer to "does it fit?" changes at zero.
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

/// Nearer to zero than this, Not shown is allowed: 2 um, and the chord of one mesh across its diameter.
double edgeBand_m(const EdgeCase& edge);

enum class EdgeOutcome {
  Right,
  NotShown,   ///< within the band
  MissedFit,  ///< not shown, though it has more clearance than the band
  Wrong,      ///< fits or not shown though it is too large, or blocked though it fits
};
EdgeOutcome outcomeOf(const EdgeCase& edge, scenes::Verdict verdict);

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
