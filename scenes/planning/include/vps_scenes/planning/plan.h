// SPDX-License-Identifier: BSD-3-Clause
// Finds an order and ways for the parts of an assembly by taking it apart.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "vps_scenes/fits/check.h"
#include "vps_scenes/planning/plan_types.h"

namespace vps::scenes {

/// Plans the assembly of parts as drawn. The same result on any number of threads. Throws LoadError for parts
/// that cannot be measured (see checkAssembly()), no parts, and names that are none.
VPS_SCENES_API PlanResult planAssembly(const std::string& name, const std::vector<DrawnPart>& parts,
                                       const PlanSettings& settings = {}, const Progress& progress = {});
/// The same of the parts of a scene at their targets, without its scenery. Its fixed parts stand still unless
/// the settings name others; its gravity says what is up.
VPS_SCENES_API PlanResult planAssembly(const Scene& scene, PlanSettings settings = {},
                                       const Progress& progress = {});

/// The graph of precedence of all assemblies, in the DOT language of Graphviz; what follows from other edges
/// is left out.
VPS_SCENES_API std::string planDot(const PlanResult& plan);

/// The same graph as a picture (SVG), the steps from left to right.
VPS_SCENES_API std::string planSvg(const PlanResult& plan);

/// The parts of a CAD file as a scene without steps.
VPS_SCENES_API Scene sceneOf(const ImportedCad& cad);

/// A scene for each assembly of a plan, in its order, with the settings of the scene that was planned. The
/// parts of a subassembly are one part of the scene that mounts it.
VPS_SCENES_API std::vector<Scene> plannedScenes(const Scene& scene, const PlanResult& plan);

/// Models of a planned scene take no more than this, where larger voxels can help [bytes].
inline constexpr double kMostModels_bytes = 1e9;
/// Sets voxel and spacing of a planned scene that has those of the preset `normal`: smaller ones where a part
/// that is moved is less than eight voxels across, larger ones where the models would take too much memory
/// (estimated from areas and edges). Depends on the scene alone.
/// @return what was chosen and why, in words; empty: the preset serves
VPS_SCENES_API std::string fitFidelity(Scene& scene, double most_bytes = kMostModels_bytes);

/// Follows the ways of all steps: conservative advancement finds what is deeper than allowed however thin it
/// is, along straight legs and threads, and along turning legs within 2 um; the depth is then measured at 24
/// poses of the leg, and where it was stopped. A screw is followed along its thread from its target on. A
/// part that no step holds has to be carried by what is in place. The worst fault of each step, in order;
/// empty: none.
/// @param planned_clearance_m  of the ways, by part, where less is a fault (PlannedStep::clearance_m)
VPS_SCENES_API std::vector<WayFault> checkWays(const Scene& scene, const Progress& progress = {},
                                               const std::map<std::string, double>& planned_clearance_m = {});

}  // namespace vps::scenes
