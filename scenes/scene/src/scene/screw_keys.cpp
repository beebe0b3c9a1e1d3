// SPDX-License-Identifier: BSD-3-Clause
#include "scene/screw_keys.h"

#include <algorithm>
#include <cmath>

#include "scene/insertion_axis.h"
#include "scene/thread_form.h"
#include "vps/mesh_repair.h"

namespace vps::scenes {

namespace {

// Around the axis of insertion, through the part's centre of mass.
double leadOnMesh_m(const Mesh& mesh, const SceneStep& step) {
  const Pose X_PG = Pose::translation(solidMass(mesh).com);
  const Vec3 axis_W = insertionAxis(step, X_PG);
  if (axis_W.isZero(0)) return 0;
  const auto form = findThread(mesh, X_PG.p, step.X_WP_target.R.transpose() * axis_W);
  return form ? form->lead_m : 0;
}

}  // namespace

void completeScrew(const SceneKeys& keys, const Mesh& mesh, SceneStep& step) {
  constexpr double kTurned_rad = 1e-6;  // beyond rounding of the file's numbers
  if (step.motion != StepMotion::Screw) {
    for (const char* key : {"pitch", "torque_Nm"})
      if (keys.has(key)) keys.fail(key, "is of a screw; say motion = \"screw\" as well, or leave it out");
    return;
  }
  const auto turns = [&](const Pose& X_WP) {
    return rotationVector(X_WP.R * step.X_WP_target.R.transpose()).norm() > kTurned_rad;
  };
  if (turns(step.X_WP_start) || std::any_of(step.way_points.begin(), step.way_points.end(), turns))
    keys.fail("motion",
              "is a screw, but the path turns it; give start and way points the rotation of the "
              "target, since the hand turns it by itself");
  if (step.pitch_m == 0) step.pitch_m = leadOnMesh_m(mesh, step);
  if (step.pitch_m == 0)
    keys.fail(
        "motion",
        "is a screw, whose 'pitch' is not found in the mesh: around its axis of insertion there are no two "
        "turns of a thread; give 'pitch', negative for a left-hand thread");
  if (std::abs(step.pitch_m) > bounds(mesh).size().norm())
    keys.fail("pitch", "is longer than the part itself; give the way in one turn");
}

}  // namespace vps::scenes
