// SPDX-License-Identifier: BSD-3-Clause
// In place of iceoryx.cpp where iceoryx is missing.
#include "rows.h"

namespace vps::bench {

bool iceoryxRow(double) {
  printRow("iceoryx, shared memory", "for comparison", "not measured: this build has no iceoryx", true);
  return true;
}

}  // namespace vps::bench
