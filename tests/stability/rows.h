// SPDX-License-Identifier: BSD-3-Clause
// All rows, in the order of the table; each function has its own file.
#pragma once

#include <vector>

#include "row.h"

namespace vps::stability {

std::vector<Row> scaleRows();   ///< sizes, distances, steps
std::vector<Row> loadRows();    ///< masses, stiffness, friction, many contacts
std::vector<Row> impactRows();  ///< impacts, thin walls, spin
std::vector<Row> shapeRows();   ///< edges, tips, overlaps at the start, fits
std::vector<Row> restRows();    ///< long rest, copies of a scene
std::vector<Row> inputRows();   ///< values that are not finite
std::vector<Row> deviceRows();  ///< a hand with jerk; if vps::device is built

/// All of them.
std::vector<Row> allRows();

}  // namespace vps::stability
