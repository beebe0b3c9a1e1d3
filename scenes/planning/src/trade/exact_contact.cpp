// SPDX-License-Identifier: BSD-3-Clause
#include "trade/exact_contact.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace vps::scenes {

ExactContact exactContact(const JudgedBody& solid, const std::vector<SurfaceSample>& samples,
                          const Pose& X_SB, const Vec3& p_SO) {
  std::vector<double> estimate_m(samples.size());
  tbb::parallel_for(std::size_t{0}, samples.size(),
                    [&](std::size_t i) { estimate_m[i] = solid.model->map->distance(X_SB * samples[i].p); });
  const double error_m = solid.model->map->sampleError_m();
  const double least_m = estimate_m.empty() ? 0 : *std::min_element(estimate_m.begin(), estimate_m.end());
  const double cutoff_m = std::max(least_m + 2 * error_m, error_m);
  std::vector<Solid::Closest> found(samples.size());
  std::vector<double> exact(samples.size(), std::numeric_limits<double>::infinity());
  tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
    if (estimate_m[i] > cutoff_m || estimate_m[i] >= solid.model->map->band_m()) return;
    const Vec3 p_S = X_SB * samples[i].p;
    found[i] = solid.model->solid->closest(p_S);
    const bool is_inside = (p_S - found[i].q).dot(found[i].normal) < 0;
    exact[i] = is_inside ? -found[i].distance_m : found[i].distance_m;
  });
  ExactContact contact;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    contact.least_m = std::min(contact.least_m, exact[i]);
    if (!(exact[i] < 0)) continue;
    const Vec3 f_S = kProbeStiffness_N_per_m3 * samples[i].area_m2 * -exact[i] * found[i].normal;
    contact.F_S.f += f_S;
    contact.F_S.tau += (X_SB * samples[i].p - p_SO).cross(f_S);
  }
  return contact;
}

}  // namespace vps::scenes
