// SPDX-License-Identifier: BSD-3-Clause
// The cases of the table, each a scene with its bounds.
#pragma once

#include <vector>

#include "dynamics/world.h"
#include "table.h"

namespace vps::bench {

struct Options {
  std::vector<dynamics::Mode> modes;
  bool is_short = false;
};

struct Case {
  const char* key;  ///< for --rows
  void (*run)(const Options&, Table&);
  bool is_optional = false;  ///< runs only if --rows names it
};

const std::vector<Case>& allCases();

// Rows that compare with other engines in the same run.
/// The ring over the peg, by VPS and by GImpact with its best margin.
void ringRow(const Options& options, Table& table);

/// The peg and its bore decomposed into convex hulls by HACD, with the stock solver. The decomposition takes
/// many minutes.
void hullRow(const Options& options, Table& table);

/// The peg in its bore by each kind of shape that Bullet has for it: time to build, memory, step, depth,
/// rays. btSdfCollisionShape is left out, since it reads a file of a program that is not packaged.
void shapesRow(const Options& options, Table& table);

/// Queries of a part against a mesh of 81,920 triangles and against a hull of 200 points.
void pairQueryRow(const Options& options, Table& table);
/// The first step of twenty gears, in which all pairs are new.
void firstStepRow(const Options& options, Table& table);

/// An M16 nut on a bolt at poses in contact: milliseconds for a query, by VPS and by others.
void queryRow(const Options& options, Table& table);

}  // namespace vps::bench
