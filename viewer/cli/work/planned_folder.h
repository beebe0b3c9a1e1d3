// SPDX-License-Identifier: BSD-3-Clause
// Plans an assembly into a folder, for `vps plan` and for `vps assemble` of CAD files.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "input/cad_arguments.h"
#include "output/terminal.h"
#include "vps_scenes/planning/plan.h"

namespace vps::viewer {

struct PlanArguments {
  std::vector<std::string> assembly;  ///< CAD files in one frame, or one scene file
  std::string out, json;
  std::string book;  ///< file of the instruction book, .html or .pdf; empty: none
  CadArguments cad;
  std::vector<std::string> bases;
  bool is_forced = false;
  bool is_resumed = false;  ///< continues from the results that a stopped plan left in `out`
  bool has_bench = false;   ///< see scenes::PlanSettings
  bool is_strict = false;   ///< scenes::OverlapWishes::is_strict
  std::string rules;        ///< file of rules, of which [[overlap]] counts; empty: none
};

/// Adds --base, --bench, --resume, --rules and --strict-overlaps.
void addPlanOptions(CLI::App& command, PlanArguments& given);

/// Result of planInto().
struct PlannedFolder {
  /// Blocked if a part is proven to have no path; see verdictOf(PlanResult, faults).
  scenes::Verdict verdict = scenes::Verdict::Fits;
  std::size_t steps = 0;  ///< number of steps of all assemblies
  struct SceneFile {
    std::string path;
    bool has_steps = true;  ///< false: no part of the assembly can be taken off
  };
  /// The scene of the product, then those of its subassemblies, each after the assembly that mounts it.
  std::vector<SceneFile> scene_files;
  std::vector<scenes::BlockedPart> enclosed;  ///< the parts that are proven to have no path
};

/// File in which a stopped planInto() keeps its results.
inline constexpr const char* kUnfinishedPlan = "unfinished_plan.json";

/// Plans CAD files or a scene, writes scene.toml, the scene files of subassemblies, meshes, plan.json,
/// plan.dot and plan.svg, and prints the plan and its faults. Unless --deflection is given, CAD parts with
/// very many triangles are read with a greater deflection, which is reported. Writes the instruction book
/// last, so that a failure of the book loses no other result.
PlannedFolder planInto(const PlanArguments& given, ProgressBar& bar);

/// The least clearance on the path of each part of a scene file, from the plan.json in the same folder.
/// Clearances of more than kNearWay_m count as kNearWay_m. Empty if there is no plan.json, or if plan.json
/// has no assembly with the scene file's name.
std::map<std::string, double> plannedClearances(const std::string& scene_file);

}  // namespace vps::viewer
