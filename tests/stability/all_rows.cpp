// SPDX-License-Identifier: BSD-3-Clause
#include "rows.h"

namespace vps::stability {

std::vector<Row> allRows() {
  std::vector<Row> all;
  for (const auto& rows : {scaleRows(), loadRows(), impactRows(), shapeRows()}) all.insert(all.end(), rows.begin(), rows.end());
  return all;
}

}  // namespace vps::stability
