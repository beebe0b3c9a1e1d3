// SPDX-License-Identifier: BSD-3-Clause
#include "pass_through.h"

#include <algorithm>

namespace vps::search {

bool hasPassedThrough(const OverlapMesh& a, const OverlapMesh& b, const Pose& X_BA_before,
                      const Pose& X_BA_after, double margin_m) {
  std::vector<double> crossings;
  for (const Vec3& p_A : a.mesh().vertices) {
    const Vec3 from = X_BA_before * p_A, to = X_BA_after * p_A;
    Box path;
    path.add(from);
    path.add(to);
    if (!overlap(path, b.box()) || (to - from).squaredNorm() < margin_m * margin_m) continue;
    crossings.clear();
    b.solid().appendCrossings(from, to, crossings);
    if (crossings.size() < 2) continue;
    if (b.solid().signedDistance(from) < 0 || b.solid().signedDistance(to) < 0) continue;
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
      const Vec3 middle = from + 0.5 * (crossings[i] + crossings[i + 1]) * (to - from);
      if (b.solid().signedDistance(middle) < -margin_m) return true;
    }
  }
  return false;
}

}  // namespace vps::search
