// SPDX-License-Identifier: BSD-3-Clause
#include "rows.h"

namespace vps::stability {

std::vector<Row> allRows() {
  std::vector<Row> all;
  for (const auto& rows : {loadRows(), scaleRows(), impactRows(), shapeRows(), restRows(), inputRows()})
    all.insert(all.end(), rows.begin(), rows.end());
#ifdef VPS_STABILITY_HAS_DEVICE
  const std::vector<Row> rows = deviceRows();
  all.insert(all.end(), rows.begin(), rows.end());
#endif
  return all;
}

}  // namespace vps::stability
