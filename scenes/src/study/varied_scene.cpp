// SPDX-License-Identifier: BSD-3-Clause
#include "study/varied_scene.h"

#include "core/insertion_axis.h"
#include "models/shrunk_mesh.h"

namespace vps::scenes::inline v0 {

namespace {

/// Every pose of the step's part, from start to target.
template <class Change>
void changePath(SceneStep& step, Change change) {
  change(step.X_WP_start);
  for (Pose& X_WP : step.way_points) change(X_WP);
  change(step.X_WP_target);
}

}  // namespace

void growPart(ScenePart& part, double by_m) {
  if (by_m == 0) return;
  part.part.mesh = shrunkMesh(part.part.mesh, -by_m);
  part.model.reset();
  part.is_cropped = false;
}

Scene withGrownStep(const Scene& scene, std::size_t step, double by_m) {
  Scene grown = scene;
  SceneStep& of = grown.steps[step];
  growPart(grown.parts[of.part], by_m);
  const Vec3 back_W = -by_m * insertionAxis(of, Pose());
  changePath(of, [&](Pose& X_WP) { X_WP.p += back_W; });
  return grown;
}

}  // namespace vps::scenes::inline v0
