// SPDX-License-Identifier: BSD-3-Clause
#include "trade/front.h"

#include <algorithm>

namespace vps::scenes {

namespace {

bool isComplete(const TradeRow& row) {
  return row.has_run && row.has_probe && row.run.completed;
}

bool dominates(const TradeRow& a, const TradeRow& b) {
  const double t_a = a.run.physics.cpu_p99_us, t_b = b.run.physics.cpu_p99_us;
  const bool is_no_worse = t_a <= t_b && errorOf(a) <= errorOf(b) && a.bytes <= b.bytes;
  return is_no_worse && (t_a < t_b || errorOf(a) < errorOf(b) || a.bytes < b.bytes);
}

}  // namespace

double errorOf(const TradeRow& row) {
  return std::max(row.run.deepest_m, row.probe.penetration_m);
}

double rateOf(const TradeRow& row) {
  return row.has_run && row.run.physics.cpu_p99_us > 0 ? 1e6 / row.run.physics.cpu_p99_us : 0;
}

void markFront(std::vector<TradeRow>& rows) {
  for (TradeRow& row : rows)
    row.is_on_front = isComplete(row) && std::none_of(rows.begin(), rows.end(), [&](const TradeRow& other) {
                        return isComplete(other) && dominates(other, row);
                      });
}

}  // namespace vps::scenes
