// SPDX-License-Identifier: BSD-3-Clause
// The body of findRows() compiled for AVX2; see splat_rows.cpp.
#include "voxelise/splat_rows_kernel.h"

namespace vps {

int findRowsAvx2(const SplatRegion& region, SplatRow* rows) {
  return findRowsHere(region, rows);
}

}  // namespace vps
