// SPDX-License-Identifier: BSD-3-Clause
// Rows that compare with rivals in the same run.
#pragma once

#include "rows.h"

namespace vps::bench {

/// The ring over the peg: ours against GImpact at its best margin, and HACD's hulls.
void ringRow(const Options& options, Table& table);

/// M16 nut on a bolt at poses in contact: milliseconds for a query, ours and others.
void queryRow(const Options& options, Table& table);

}  // namespace vps::bench
