// SPDX-License-Identifier: BSD-3-Clause
#include "exact_fit.h"

#include <tbb/parallel_for.h>

#include <cmath>

namespace vps {

namespace {

/// Deepest probe of `probes` inside `solid`; p in the solid's frame.
struct Deepest {
  double depth_m = 0;
  Vec3 p_S = Vec3::Zero();
};

Deepest deepestProbe(const FitBody& solid, const FitBody& probes, const Pose& X_SP) {
  // Rounded edges make the field wrong by up to 0.43 h there (a cube's edge, measured), and trilinear error
  // is less elsewhere: whatever is inside by exact distance lies within half a voxel of zero by the field.
  QueryOptions options;
  options.cutoff_m = 0.5 * solid.map->voxel_m();
  ContactSet candidates(probes.shell->size());
  queryContacts(*solid.map, *probes.shell, X_SP, options, candidates);

  std::vector<double> depths(candidates.contacts.size());
  tbb::parallel_for(std::size_t{0}, depths.size(), [&](std::size_t i) {
    const Contact& contact = candidates.contacts[i];
    // Exact distance differs from the field's by less than a voxel, so the search need not go farther.
    const double reach_m = std::abs(contact.distance_m) + 2 * solid.map->voxel_m();
    depths[i] = -solid.distance->signedDistance(X_SP * probes.shell->points[contact.id], reach_m);
  });
  Deepest deepest;
  for (std::size_t i = 0; i < depths.size(); ++i)
    if (depths[i] > deepest.depth_m) deepest = {depths[i], candidates.contacts[i].p_M};
  return deepest;
}

}  // namespace

void ExactFit::mount(FitBody body, const Pose& X_WB) {
  mounted_.push_back({std::move(body), X_WB});
}

Penetration ExactFit::deepest(const FitBody& moving, const Pose& X_WP) const {
  Penetration worst;
  for (std::size_t i = 0; i < mounted_.size(); ++i) {
    const auto& [body, X_WB] = mounted_[i];
    const Pose X_BP = X_WB.inverse() * X_WP;
    const Deepest in_mounted = deepestProbe(body, moving, X_BP);
    if (in_mounted.depth_m > worst.depth_m) worst = {in_mounted.depth_m, X_WB * in_mounted.p_S, i};
    const Deepest in_moving = deepestProbe(moving, body, X_BP.inverse());
    if (in_moving.depth_m > worst.depth_m) worst = {in_moving.depth_m, X_WP * in_moving.p_S, i};
  }
  return worst;
}

}  // namespace vps
