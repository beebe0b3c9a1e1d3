// SPDX-License-Identifier: BSD-3-Clause
// Finds an order and paths for the parts of an assembly by simulated disassembly.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "vps_scenes/fits/check.h"
#include "vps_scenes/planning/plan_types.h"

namespace vps::scenes {

/// Plans the assembly of parts as drawn. The result is the same for any number of threads. Throws LoadError
/// if there are no parts, if a part cannot be measured (see checkAssembly()), or if the settings name an
/// unknown part.
VPS_SCENES_API PlanResult planAssembly(const std::string& name, const std::vector<DrawnPart>& parts,
                                       const PlanSettings& settings = {}, const Progress& progress = {});
/// Plans the parts of a scene at their targets, without its scenery. The scene's fixed parts stand still
/// unless the settings name others; its gravity defines the upward direction.
VPS_SCENES_API PlanResult planAssembly(const Scene& scene, PlanSettings settings = {},
                                       const Progress& progress = {});

/// The precedence graph of all assemblies, in the DOT language of Graphviz; edges that follow from other
/// edges are left out.
VPS_SCENES_API std::string planDot(const PlanResult& plan);

/// The precedence graph as a picture (SVG), with the steps from left to right.
VPS_SCENES_API std::string planSvg(const PlanResult& plan);

/// The parts of a CAD file as a scene without steps.
VPS_SCENES_API Scene sceneOf(const ImportedCad& cad);

/// A scene for each assembly of a plan, in the order of the plan, with the settings of the scene that was
/// planned. The parts of a subassembly are one part of the scene that mounts it.
VPS_SCENES_API std::vector<Scene> plannedScenes(const Scene& scene, const PlanResult& plan);

/// Memory limit of the models of a planned scene [bytes]; larger voxels are chosen to keep this limit.
inline constexpr double kMostModels_bytes = 1e9;
/// Sets voxel and spacing of a planned scene whose values are those of the preset `normal`: smaller values if
/// a moved part is less than eight voxels across, larger values if the models would exceed the memory limit
/// (estimated from areas and edges). The choice depends on the scene alone.
/// @return the chosen values and the reason, in words; empty: the preset is kept
VPS_SCENES_API std::string fitFidelity(Scene& scene, double most_bytes = kMostModels_bytes);

/// Checks the paths of all steps. Conservative advancement finds each overlap that is deeper than allowed,
/// however thin the wall is, along straight legs and threads, and along turning legs within 2 um. The depth
/// of overlap is then measured at 24 poses of each leg and at the poses where the advancement stopped. A
/// screw is followed along its thread, starting at its target. A part that no step holds has to be carried by
/// parts in place.
/// @param planned_clearance_m  clearance by part; a smaller clearance is a fault (PlannedStep::clearance_m)
/// @return the worst fault of each step, in order; empty: no fault
VPS_SCENES_API std::vector<WayFault> checkWays(const Scene& scene, const Progress& progress = {},
                                               const std::map<std::string, double>& planned_clearance_m = {});

}  // namespace vps::scenes
