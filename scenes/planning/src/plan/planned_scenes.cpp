// SPDX-License-Identifier: BSD-3-Clause
// Converts a plan into scenes that can be run.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "vps_scenes/planning/plan.h"
#include "vps_scenes/scene/scene_parts.h"

namespace vps::scenes {

namespace {

class SceneMaker {
 public:
  SceneMaker(const Scene& scene, const PlanResult& plan) : scene_(scene), plan_(plan) {
    for (std::size_t i = 0; i < scene.parts.size(); ++i) index_[scene.parts[i].part.name] = i;
    for (const SceneStep& step : scene.steps) given_[scene.parts[step.part].part.name] = &step;
    drawn_ = drawnParts(scene);
    for (const Fastener& fastener : plan.fasteners) fasteners_[fastener.part] = fastener.words;
    for (const OverlapChoice& choice : plan.choices) {
      if (!choice.changed.empty()) changes_[choice.changed].push_back(&choice);
      if (!choice.left_out.empty()) left_out_.insert(choice.left_out);
      if (choice.kind == OverlapKind::Clash) clashes_.insert(std::minmax(choice.a, choice.b));
    }
    std::erase_if(clashes_, [&](const auto& pair) { return depthOf(pair) < kDrawnThrough_m; });
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
    std::set<std::string> in_place(assembly.fixed.begin(), assembly.fixed.end());
    for (const PlannedStep& step : assembly.steps) {
      out.parts.push_back(step.parts.size() == 1 ? partNamed(step.name) : united(step));
      out.parts.back().is_fixed = false;
      out.steps.push_back(stepOf(step, out.parts.size() - 1, out.parts.back().X_WP));
      if (isDrawnThrough(step, in_place)) {
        out.steps.back().timeout_s = kProven_s;
        out.steps.back().is_held = true;  // a blocked part is not released
      }
      in_place.insert(step.parts.begin(), step.parts.end());
    }
    if (&assembly == &plan_.assemblies.front())
      for (const ScenePart& part : scene_.parts) {
        if (!part.is_scenery && !left_out_.contains(part.part.name)) continue;
        out.parts.push_back(part);
        out.parts.back().is_scenery = true;
        out.parts.back().is_fixed = false;
      }
    return out;
  }

 private:
  using Pair = std::pair<std::string, std::string>;
  /// Assumed: parts that are drawn this deep in each other are blocked whatever the hand does, and the user
  /// needs to correct the drawing.
  static constexpr double kDrawnThrough_m = 1e-3;
  static constexpr double kProven_s = 0.5;  ///< time limit of a step that is proven to be blocked

  [[nodiscard]] double depthOf(const Pair& pair) const {
    double depth_m = 0;
    for (const CheckedPair& drawn : plan_.overlaps)
      if (Pair(std::minmax(drawn.a, drawn.b)) == pair)
        depth_m = std::max(depth_m, drawn.interference_depth_m);
    return depth_m;
  }
  [[nodiscard]] bool isDrawnThrough(const PlannedStep& step, const std::set<std::string>& in_place) const {
    return std::ranges::any_of(clashes_, [&](const Pair& pair) {
      const auto moves = [&](const std::string& name) {
        return std::ranges::find(step.parts, name) != step.parts.end();
      };
      return (moves(pair.first) && in_place.contains(pair.second)) ||
             (moves(pair.second) && in_place.contains(pair.first));
    });
  }

  /// The part at its target.
  [[nodiscard]] ScenePart partNamed(const std::string& name) const {
    const std::size_t i = index_.at(name);
    ScenePart part = scene_.parts[i];
    part.X_WP = drawn_[i].X_WP;
    part.V_WP_W = {};
    if (const auto known = fasteners_.find(name); known != fasteners_.end()) part.fastener = known->second;
    const auto changes = changes_.find(name);
    if (changes == changes_.end()) return part;
    for (const OverlapChoice* choice : changes->second) {
      part.press_fit_m = std::max(part.press_fit_m, choice->press_fit_m);
      if (choice->resized) resize(part.part.mesh, *choice->resized);
    }
    return part;
  }

  /// The parts of a subassembly as one part, in the frame of the first part.
  [[nodiscard]] ScenePart united(const PlannedStep& step) const {
    std::vector<ScenePart> parts;
    for (const std::string& name : step.parts) parts.push_back(partNamed(name));
    return unitedPart(step.name, parts);
  }

  [[nodiscard]] SceneStep stepOf(const PlannedStep& planned, std::size_t part, const Pose& X_WP) const {
    SceneStep step;
    const auto given = given_.find(planned.name);
    if (given != given_.end()) step = *given->second;
    step.part = part;
    step.X_WP_target = X_WP;
    step.X_WP_start = planned.before_W.front() * X_WP;
    step.way_points.clear();
    for (std::size_t i = 1; i < planned.before_W.size(); ++i)
      step.way_points.push_back(planned.before_W[i] * X_WP);
    if (!planned.is_carried) step.is_held = true;
    if (given == given_.end() || planned.is_on_bench)
      step.timeout_s = std::max(step.timeout_s, timeFor(step));
    step.motion = planned.kind == WayKind::Screw ? StepMotion::Screw : StepMotion::Push;
    step.pitch_m = planned.kind == WayKind::Screw ? planned.lead_m : 0;
    if (step.motion == StepMotion::Push) step.torque_Nm = 0;
    return step;
  }

  /// Time limit of a step: the default limit, twice the hand's time for the path (with the device recentred
  /// every 0.2 m), and the time of two rounds of searches on each of the last legs. The hand moves at a third
  /// of its speed on the last leg, since the part may meet an edge there.
  [[nodiscard]] double timeFor(const SceneStep& step) const {
    constexpr double kBetween_m = 0.2, kRecentre_s = 2, kLastLeg = 3;
    // Measured: a slide reaches its dovetail after 52 s, in the second round of searches.
    constexpr double kSearches_s = 40;
    double way_m = 0;
    Vec3 from = step.X_WP_start.p;
    for (const Pose& point : step.way_points) {
      way_m += (point.p - from).norm();
      from = point.p;
    }
    const double last_m = (step.X_WP_target.p - from).norm();
    const double way_s =
        (way_m + kLastLeg * last_m) / scene_.hand.speed_m_s + kRecentre_s * (way_m + last_m) / kBetween_m;
    const double searches_s = kSearches_s * (step.way_points.empty() ? 1 : 2);
    return std::ceil(SceneStep().timeout_s + searches_s + 2 * way_s);
  }

  const Scene& scene_;
  const PlanResult& plan_;
  std::map<std::string, std::size_t> index_;
  std::map<std::string, const SceneStep*> given_;
  std::vector<DrawnPart> drawn_;
  std::map<std::string, std::string> fasteners_;
  std::map<std::string, std::vector<const OverlapChoice*>> changes_;  ///< by part
  std::set<std::string> left_out_;
  std::set<Pair> clashes_;  ///< pairs whose drawn overlap exceeds kDrawnThrough_m
};

}  // namespace

Scene sceneOf(const ImportedCad& cad) {
  Scene scene;
  scene.file = cad.file;
  scene.name = std::filesystem::path(cad.file).stem().string();
  scene.warnings = cad.warnings;
  scene.missing = cad.missing;
  for (const ImportedPart& imported : cad.parts) {
    ScenePart part;
    part.part.name = imported.name;
    part.part.mesh = imported.mesh;
    part.part.color = imported.color;
    part.part.face_colors = imported.face_colors;
    part.X_WP = imported.X_WP;
    part.file = cad.file;
    part.deflection_m = imported.deflection_m;
    part.rounding_m = imported.rounding_m;
    part.within = imported.within;
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

}  // namespace vps::scenes
