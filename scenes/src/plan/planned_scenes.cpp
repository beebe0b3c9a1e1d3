// SPDX-License-Identifier: BSD-3-Clause
// A plan as scenes that can be run.
#include <algorithm>
#include <filesystem>
#include <map>

#include "vps_scenes/plan.h"

namespace vps::scenes::inline v0 {

namespace {

class SceneMaker {
 public:
  SceneMaker(const Scene& scene, const PlanResult& plan) : scene_(scene), plan_(plan) {
    for (std::size_t i = 0; i < scene.parts.size(); ++i) index_[scene.parts[i].part.name] = i;
    for (const SceneStep& step : scene.steps) given_[scene.parts[step.part].part.name] = &step;
    drawn_ = drawnParts(scene);
  }

  Scene make(const PlannedAssembly& assembly) const {
    Scene out = scene_;
    out.parts.clear();
    out.steps.clear();
    if (&assembly != &plan_.assemblies.front()) out.name = scene_.name + ", " + assembly.name;
    for (const std::string& name : assembly.fixed) {
      out.parts.push_back(partNamed(name));
      out.parts.back().is_fixed = true;
    }
    for (const PlannedStep& step : assembly.steps) {
      out.parts.push_back(step.parts.size() == 1 ? partNamed(step.name) : united(step));
      out.parts.back().is_fixed = false;
      out.steps.push_back(stepOf(step, out.parts.size() - 1, out.parts.back().X_WP));
    }
    if (&assembly == &plan_.assemblies.front())
      for (const ScenePart& part : scene_.parts)
        if (part.is_scenery) out.parts.push_back(part);
    return out;
  }

 private:
  /// Where it belongs.
  [[nodiscard]] ScenePart partNamed(const std::string& name) const {
    const std::size_t i = index_.at(name);
    ScenePart part = scene_.parts[i];
    part.X_WP = drawn_[i].X_WP;
    part.V_WP_W = {};
    return part;
  }

  /// The parts of a subassembly as one, in the frame of the first.
  [[nodiscard]] ScenePart united(const PlannedStep& step) const {
    ScenePart whole = partNamed(step.parts.front());
    whole.part.name = step.name;
    for (std::size_t i = 1; i < step.parts.size(); ++i) {
      const ScenePart part = partNamed(step.parts[i]);
      append(whole.part.mesh, transformed(part.part.mesh, whole.X_WP.inverse() * part.X_WP));
      if (part.deflection_m)
        whole.deflection_m = std::max(*part.deflection_m, whole.deflection_m.value_or(0));
    }
    return whole;
  }

  [[nodiscard]] SceneStep stepOf(const PlannedStep& planned, std::size_t part, const Pose& X_WP) const {
    SceneStep step;
    if (const auto given = given_.find(planned.name); given != given_.end()) step = *given->second;
    step.part = part;
    step.X_WP_target = X_WP;
    step.X_WP_start = planned.before_W.front() * X_WP;
    step.way_points.clear();
    for (std::size_t i = 1; i < planned.before_W.size(); ++i)
      step.way_points.push_back(planned.before_W[i] * X_WP);
    if (!planned.is_carried) step.is_held = true;
    step.motion = planned.kind == WayKind::Screw ? StepMotion::Screw : StepMotion::Push;
    step.pitch_m = planned.kind == WayKind::Screw ? planned.lead_m : 0;
    if (step.motion == StepMotion::Push) step.torque_Nm = 0;
    return step;
  }

  const Scene& scene_;
  const PlanResult& plan_;
  std::map<std::string, std::size_t> index_;
  std::map<std::string, const SceneStep*> given_;
  std::vector<DrawnPart> drawn_;
};

}  // namespace

Scene sceneOf(const ImportedCad& cad) {
  Scene scene;
  scene.file = cad.file;
  scene.name = std::filesystem::path(cad.file).stem().string();
  scene.warnings = cad.warnings;
  for (const ImportedPart& imported : cad.parts) {
    ScenePart part;
    part.part.name = imported.name;
    part.part.mesh = imported.mesh;
    part.part.color = imported.color;
    part.X_WP = imported.X_WP;
    part.file = cad.file;
    part.deflection_m = imported.deflection_m;
    scene.parts.push_back(std::move(part));
  }
  return scene;
}

std::vector<Scene> plannedScenes(const Scene& scene, const PlanResult& plan) {
  const SceneMaker maker(scene, plan);
  std::vector<Scene> out;
  for (const PlannedAssembly& assembly : plan.assemblies) out.push_back(maker.make(assembly));
  return out;
}

}  // namespace vps::scenes::inline v0
