// SPDX-License-Identifier: BSD-3-Clause
// Rows that compare with rivals in the same run.
#pragma once

#include "rows.h"

namespace vps::bench {

/// The ring over the peg: ours against GImpact at its best margin.
void ringRow(const Options& options, Table& table);

/// The peg and its bore cut into convex hulls by HACD, in the stock solver. The cut takes many minutes.
void hullRow(const Options& options, Table& table);

/// M16 nut on a bolt at poses in contact: milliseconds for a query, ours and others.
void queryRow(const Options& options, Table& table);

}  // namespace vps::bench
