// SPDX-License-Identifier: BSD-3-Clause
#include "files/thinned_trace.h"

#include <algorithm>

namespace vps::viewer {

std::vector<scenes::TraceRow> thinned(const std::vector<scenes::TraceRow>& trace, double rate_hz) {
  std::vector<scenes::TraceRow> rows;
  double next_s = 0;
  for (const scenes::TraceRow& row : trace) {
    // The tolerance of half a microsecond is for the rounding of times, which are sums of steps.
    if (row.time_s < next_s - 0.5e-6) continue;
    rows.push_back(row);
    next_s = std::max(next_s + 1 / rate_hz, row.time_s);
  }
  return rows;
}

}  // namespace vps::viewer
