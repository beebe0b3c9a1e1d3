// SPDX-License-Identifier: BSD-3-Clause
// Plans an assembly into a folder: what `vps plan` does, and `vps assemble` for a CAD file.
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
  CadArguments cad;
  std::vector<std::string> bases;
  bool is_forced = false;
  bool is_resumed = false;  ///< takes what an earlier plan into `out` had found when it was stopped
  bool has_bench = false;   ///< see scenes::PlanSettings
};

/// Adds --base, --bench and --resume.
void addPlanOptions(CLI::App& command, PlanArguments& given);

/// What planInto() came to.
struct PlannedFolder {
  int status = 0;         ///< the program's exit status
  std::size_t steps = 0;  ///< of all assemblies
  struct SceneFile {
    std::string path;
    bool has_steps = true;  ///< false: none of its parts can be taken off
  };
  /// Of the product, then of its subassemblies; each comes after the one that mounts it.
  std::vector<SceneFile> scene_files;
};

/// Where planInto() keeps what it had found when it was stopped.
inline constexpr const char* kUnfinishedPlan = "unfinished_plan.json";

/// Plans CAD files or a scene, writes scene.toml, the scene files of subassemblies, meshes, plan.json,
/// plan.dot and plan.svg, and prints the plan and what is wrong with it. Parts of a CAD file that have very
/// many triangles are read with a greater deflection, and this is said, unless --deflection is given.
PlannedFolder planInto(const PlanArguments& given, ProgressBar& bar);

/// The clearances of the ways of a scene file, by part, from the plan.json beside it; empty where there is
/// none, or where it has no assembly of that name. Those of more than kNearWay_m are that.
std::map<std::string, double> plannedClearances(const std::string& scene_file);

}  // namespace vps::viewer
