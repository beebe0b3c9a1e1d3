// SPDX-License-Identifier: BSD-3-Clause
#include "voxelise/splat_rows.h"

#include <algorithm>

#include "voxelise/splat_rows_kernel.h"

namespace vps {

#ifdef VPS_SPLAT_AVX2
int findRowsAvx2(const SplatRegion& region, SplatRow* rows);
#endif

namespace {

using FindRows = int (*)(const SplatRegion&, SplatRow*);

FindRows chosen() {
#ifdef VPS_SPLAT_AVX2
  if (__builtin_cpu_supports("avx2")) return findRowsAvx2;
#endif
  return findRowsBaseline;
}

}  // namespace

int findRowsBaseline(const SplatRegion& region, SplatRow* rows) {
  return findRowsHere(region, rows);
}

void SplatRegion::add(double a, double b, double c, double d, double scale) {
  // Nearly vertical planes are tilted slightly; within a tile this moves them by less than the margin.
  const double least = 1e-6 * scale;
  const double lean = c >= 0 ? std::max(c, least) : std::min(c, -least);
  const double per = -1 / lean;
  const int k = count++;
  at[k] =
      static_cast<float>((d + a * origin[0] + b * origin[1] + c * origin[2] + kRoundingMargin * scale) * per);
  per_x[k] = static_cast<float>(a * per);
  per_y[k] = static_cast<float>(b * per);
  lift[k] = lean > 0 ? 0 : -kNoBound;
  drop[k] = lean > 0 ? kNoBound : 0;
}

int findRows(const SplatRegion& region, SplatRow* rows) {
  static const FindRows find = chosen();
  return find(region, rows);
}

}  // namespace vps
