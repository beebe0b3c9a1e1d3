// SPDX-License-Identifier: BSD-3-Clause
// The poses at which a trade study probes the models.
#include <algorithm>

#include "trade/probe.h"
#include "trade/seeded_draw.h"

namespace vps::scenes {

std::vector<Pose> probePoses(const Scene& scene, const AssembleResult& run, std::size_t count) {
  std::vector<const TraceRow*> touching;
  for (const TraceRow& row : run.trace)
    if (row.step == 0 && row.contacts > 0 && row.phase < 3) touching.push_back(&row);
  std::vector<Pose> poses;
  SeededDraw draw(1);
  const double reach_m = scene.steps.front().clearance_m + 20e-6;
  for (std::size_t i = 0; i < std::min(count, touching.size()); ++i) {
    Pose X_WP = touching[i * touching.size() / std::min(count, touching.size())]->X_WP;
    const double length_m =
        draw() * reach_m;  // drawn before the direction, since the order of draws matters; see inUnitCube()
    const Vec3 offset = draw.inUnitCube().normalized() * length_m;
    if (i % 2 == 1) X_WP.p += offset;
    poses.push_back(X_WP);
  }
  return poses;
}

}  // namespace vps::scenes
