// SPDX-License-Identifier: BSD-3-Clause
#include "scene/scene_file_tables.h"

#include <algorithm>
#include <cmath>

#include "scene/read_fields.h"
#include "scene/steps.h"
#include "scene/thread_form.h"
#include "vps/mesh_repair.h"
#include "vps_scenes/scene/settings_fields.h"

namespace vps::scenes {

namespace {

/// Lead of a thread around the axis of insertion through the part's centre of mass; 0 if no thread is found.
double leadOnMesh_m(const Mesh& mesh, const SceneStep& step) {
  const Pose X_PG = Pose::translation(solidMass(mesh).com);
  const Vec3 axis_W = insertionAxis(step, X_PG);
  if (axis_W.isZero(0)) return 0;
  const auto form = findThread(mesh, X_PG.p, step.X_WP_target.R.transpose() * axis_W);
  return form ? form->lead_m : 0;
}

class FidelityReader {
 public:
  FidelityReader(const SceneKeys& top, const SceneFileContext& context, Scene& scene)
      : top_(top), context_(context), scene_(scene) {}

  void read() {
    scene_.fidelity = fidelityPreset("normal");
    if (top_.has("fidelity")) return top_.isText("fidelity") ? readName() : readTable();
    scene_.fidelity.spacing_m = usualSpacing_m(scene_);
    scene_.chooses_voxel = scene_.chooses_spacing = true;
  }

 private:
  void readName() {
    const std::vector<std::string> names = {"fast", "normal", "fine", "auto"};
    std::size_t index = 1;
    top_.word("fidelity", names, index);
    if (names[index] == "auto") return setWish({});
    scene_.fidelity = fidelityPreset(names[index]);
  }

  void readTable() {
    const SceneKeys keys(*top_.table("fidelity"), context_, "[fidelity]", keysOf(kFidelityKeys));
    const std::vector<std::string> presets = {"fast", "normal", "fine"};
    std::size_t index = 1;
    if (keys.word("preset", presets, index)) scene_.fidelity = fidelityPreset(presets[index]);
    readFields(keys, scene_.fidelity, kFidelityFields);
    if (scene_.fidelity.substeps == 0 && !keys.isText("substeps"))
      keys.fail("substeps", "must be a number from 1 to 10000, or \"auto\"");
    readWish(keys);
    const bool is_open = !keys.has("preset") && !scene_.fidelity_wish;
    scene_.chooses_voxel = is_open && !keys.has("voxel");
    scene_.chooses_spacing = is_open && !keys.has("spacing");
    if (!keys.has("preset") && !keys.has("spacing")) scene_.fidelity.spacing_m = usualSpacing_m(scene_);
  }

  void readWish(const SceneKeys& keys) {
    FidelityWish wish;
    bool is_auto = false;
    keys.flag("auto", is_auto);
    readFields(keys, wish, kFidelityWishFields);
    if (!is_auto) {
      for (const std::string_view key : keysOf(kFidelityWishFields))
        if (keys.has(key))
          keys.fail(key, "has an effect with 'auto = true' only; add 'auto = true', or leave the key out");
      return;
    }
    for (const char* key : {"voxel", "spacing"})
      if (keys.has(key))
        keys.fail(key, "cannot be combined with 'auto = true', which chooses voxel and spacing");
    setWish(wish);
  }

  void setWish(FidelityWish wish) {
    constexpr double kTolerance_m = 10e-6;  // assumed: a usual bound in mechanical design
    if (!wish.budget_hz && !wish.tolerance_m && !wish.memory_bytes) wish.tolerance_m = kTolerance_m;
    wish.place = top_.placeOf("fidelity");
    scene_.fidelity_wish = wish;
  }

  const SceneKeys& top_;
  const SceneFileContext& context_;
  Scene& scene_;
};

}  // namespace

void completeScrew(const SceneKeys& keys, const Mesh& mesh, SceneStep& step) {
  constexpr double kTurned_rad = 1e-6;  // above the rounding error of the file's numbers
  if (step.motion != StepMotion::Screw) {
    for (const char* key : {"pitch", "torque_Nm"})
      if (keys.has(key))
        keys.fail(key, "applies to a screw only; add motion = \"screw\", or leave the key out");
    return;
  }
  const auto turns = [&](const Pose& X_WP) {
    return rotationVector(X_WP.R * step.X_WP_target.R.transpose()).norm() > kTurned_rad;
  };
  if (turns(step.X_WP_start) || std::any_of(step.way_points.begin(), step.way_points.end(), turns))
    keys.fail(
        "motion",
        "is a screw, but the path rotates the part; give start and way points the rotation of the target, "
        "since the hand turns a screw by itself");
  if (step.pitch_m == 0) step.pitch_m = leadOnMesh_m(mesh, step);
  if (step.pitch_m == 0)
    keys.fail("motion",
              "is a screw, but the mesh has no thread of two turns around the axis of insertion; give "
              "'pitch', negative for a left-hand thread");
  if (std::abs(step.pitch_m) > bounds(mesh).size().norm())
    keys.fail("pitch", "is longer than the part itself; give the travel in one turn");
}

void readFidelity(const SceneKeys& top, const SceneFileContext& context, Scene& scene) {
  FidelityReader(top, context, scene).read();
}

}  // namespace vps::scenes
