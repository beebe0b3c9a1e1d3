// SPDX-License-Identifier: BSD-3-Clause
// vps explain: prints which parts of a scene are modelled and which are not, why, and at what cost.
#include <cstdio>
#include <map>
#include <memory>

#include "input/scene_arguments.h"
#include "output/command.h"
#include "output/json_out.h"
#include "output/output.h"
#include "output/reports.h"
#include "output/table.h"
#include "output/terminal.h"

namespace vps::viewer {

namespace {

struct ExplainArguments {
  SceneArguments scene;
  std::string json;
  bool is_for_simulate =
      false;                 ///< explains vps simulate instead of vps assemble, as for a scene without steps
  bool is_measured = false;  ///< builds the models instead of estimating their cost
};

std::string megabytes(std::size_t bytes) {
  return fixed(1e-6 * static_cast<double>(bytes), 2);
}

constexpr std::size_t kNamed = 12;  // a longer list names one part and counts the others

std::string othersOf(std::size_t count) {
  return " and " + std::to_string(count) + " others";
}

std::string namesOf(const scenes::Scene& scene, const std::vector<std::size_t>& parts) {
  std::string names;
  const std::size_t shown = parts.size() <= kNamed ? parts.size() : 1;
  for (std::size_t i = 0; i < shown; ++i)
    names += (names.empty() ? "" : ", ") + scene.parts[parts[i]].part.name;
  if (shown < parts.size()) names += othersOf(parts.size() - shown);
  return names.empty() ? "-" : names;
}

std::string modelsOf(const scenes::PartModelPlan& part) {
  if (part.has_map && part.has_shell) return "map and shell";
  return part.has_map ? "map" : part.has_shell ? "shell" : "neither";
}

std::string whyOf(const scenes::Scene& scene, const scenes::PartModelPlan& part) {
  if (!part.same_as) return part.why;
  return part.why + "; shares the models of " + scene.parts[*part.same_as].part.name;
}

std::string whereOf(const scenes::PartModelPlan& part) {
  if (!part.has_map && !part.has_shell) return "-";
  if (part.kept_P.empty()) return "whole";
  return "near " + std::to_string(part.kept_P.size()) + (part.kept_P.size() == 1 ? " path" : " paths");
}

/// Groups the parts that are not modelled for the same reason. A group of more than kNamed parts has one row,
/// at its first part, because a product can have thousands of parts that no moving part comes near.
class Folded {
 public:
  Folded(const scenes::Scene& scene, const scenes::ModelPlan& plan) : first_(plan.parts.size()) {
    std::map<std::string, std::vector<std::size_t>> alike;
    for (std::size_t i = 0; i < first_.size(); ++i) {
      first_[i] = i;
      const scenes::PartModelPlan& part = plan.parts[i];
      if (!part.has_map && !part.has_shell && !part.same_as) alike[part.why].push_back(i);
    }
    for (const auto& [why, parts] : alike) {
      if (parts.size() <= kNamed) continue;
      Group& group = groups_[parts.front()];
      group.others = parts.size() - 1;
      for (const std::size_t i : parts) {
        first_[i] = parts.front();
        group.triangles += scene.parts[i].part.mesh.triangles.size();
      }
    }
  }
  [[nodiscard]] bool hasRow(std::size_t part) const { return first_[part] == part; }
  [[nodiscard]] std::string nameOf(const scenes::Scene& scene, std::size_t part) const {
    const auto group = groups_.find(part);
    const std::string& name = scene.parts[part].part.name;
    return group == groups_.end() ? name : name + othersOf(group->second.others);
  }
  [[nodiscard]] std::size_t trianglesOf(const scenes::Scene& scene, std::size_t part) const {
    const auto group = groups_.find(part);
    return group == groups_.end() ? scene.parts[part].part.mesh.triangles.size() : group->second.triangles;
  }

 private:
  struct Group {
    std::size_t others = 0, triangles = 0;
  };
  std::vector<std::size_t> first_;  // index of the part whose row includes part i; i if it has its own row
  std::map<std::size_t, Group> groups_;  // keyed by the first part of the group
};

std::string tableOfParts(const scenes::Scene& scene, const scenes::ExplainedModels& explained) {
  const bool is_measured = !explained.cost.is_estimated;
  Table table(
      {"<part", "<modelled", "<where", "MB", "points", is_measured ? "build [s]" : "triangles", "<why"});
  const Folded folded(scene, explained.plan);
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    if (!folded.hasRow(i)) continue;
    const scenes::PartModelPlan& part = explained.plan.parts[i];
    const scenes::PartCost& cost = explained.cost.parts[i];
    table.add({folded.nameOf(scene, i), modelsOf(part), whereOf(part),
               megabytes(cost.map_bytes + cost.shell_bytes), std::to_string(cost.points),
               is_measured ? fixed(cost.map_wall_s + cost.shell_wall_s, 3)
                           : std::to_string(folded.trianglesOf(scene, i)),
               whyOf(scene, part)});
  }
  return table.text();
}

std::string regionOf(const scenes::FieldPlan& step) {
  if (!step.region_W) return "anywhere";
  const Vec3 size = 1e3 * step.region_W->size();
  return fixed(size.x(), 0) + " x " + fixed(size.y(), 0) + " x " + fixed(size.z(), 0);
}

std::string tableOfSteps(const scenes::Scene& scene, const scenes::ExplainedModels& explained) {
  const bool is_measured = !explained.cost.is_estimated;
  Table table({"<step", "<moves", "<within [mm]", "<tested against the field of", "<left out", "field MB",
               "points", is_measured ? "cook [s]" : "<cooked"});
  for (std::size_t s = 0; s < explained.plan.steps.size(); ++s) {
    const scenes::FieldPlan& step = explained.plan.steps[s];
    const scenes::StepCost& cost = explained.cost.steps[s];
    table.add({std::to_string(s + 1),
               step.part ? scene.parts[*step.part].part.name : "all parts that are not fixed", regionOf(step),
               namesOf(scene, step.cooked), namesOf(scene, step.left_out), megabytes(cost.bytes),
               std::to_string(cost.points),
               !cost.is_cooked ? "as before"
               : is_measured   ? fixed(cost.cook_wall_s, 3)
                               : "anew"});
  }
  return table.text();
}

std::string totalOf(const char* words, const scenes::ModelPlanCost& cost) {
  const std::string size = words + (cost.is_estimated ? std::string("about ") : "") +
                           megabytes(cost.most.bytes) + " MB at most (" + std::to_string(cost.most.voxmaps) +
                           " voxmaps, " + std::to_string(cost.most.pointshells) + " pointshells, " +
                           std::to_string(cost.most.points) + " points and " +
                           std::to_string(cost.most.field_points) + " in the cooked fields)";
  if (cost.is_estimated) return size + "\n";
  return size + ", " + fixed(cost.build_wall_s, 2) + " s to build, " + fixed(cost.cook_wall_s, 2) +
         " s to cook\n";
}

int runExplain(const ExplainArguments& given) {
  OutputFile json(given.json, {given.scene.scene});
  ProgressBar bar;
  const scenes::Scene scene =
      sceneFrom(given.scene.scene, given.scene.fidelity, {given.json}, given.scene.cache);
  scenes::ModelOptions options;
  // Build times are measured, so models come from a cache only if --cache names its folder.
  const std::optional<VoxMapCache> cache = cacheFrom(given.scene.cache.folder);
  setModelOptions(options, bar, cache, given.scene.models_everything);
  const scenes::ModelPurpose purpose = given.is_for_simulate || scene.steps.empty()
                                           ? scenes::ModelPurpose::Simulate
                                           : scenes::ModelPurpose::Assemble;
  const auto costOf = [&] {
    return given.is_measured ? scenes::explain(scene, purpose, options)
                             : scenes::estimate(scene, purpose, options);
  };
  ExplainAnswer answer = {scene, costOf(), {}};
  if (!given.scene.models_everything) {
    options.models_everything = true;
    options.warn = {};  // the first call has printed the warnings
    answer.everything = costOf();
  }
  throwIfStopped();
  json.write(toJson(answer));
  bar.clear();

  const Fidelity& fidelity = scene.fidelity;
  std::printf("%s: %s, %s\n\n%s\n%s\n", scene.name.c_str(), fidelityWords(fidelity).c_str(),
              inWords(fidelity.sides), tableOfParts(scene, answer.chosen).c_str(),
              tableOfSteps(scene, answer.chosen).c_str());
  std::fputs(totalOf("total                    ", answer.chosen.cost).c_str(), stdout);
  if (answer.everything)
    std::fputs(totalOf("with --model-everything  ", answer.everything->cost).c_str(), stdout);
  if (!given.is_measured)
    std::fputs(
        "memory is estimated from areas and edges; --measure builds the models and measures memory and "
        "time\n",
        stdout);
  return kGood;
}

}  // namespace

std::function<int()> addExplain(CLI::App& command) {
  const auto given = std::make_shared<ExplainArguments>();
  addSceneOptions(command, given->scene);
  command.add_flag(
      "--simulate", given->is_for_simulate,
      "explain the models of vps simulate instead of vps assemble; the default for a scene without steps");
  command.add_flag("--measure", given->is_measured,
                   "build the models, and those of --model-everything, and measure their memory and time; "
                   "without this option the memory is estimated, and times are not given");
  addJsonOption(command, given->json);
  return [given] { return runExplain(*given); };
}

}  // namespace vps::viewer
