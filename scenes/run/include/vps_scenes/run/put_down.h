// SPDX-License-Identifier: BSD-3-Clause
// Assemblies that begin with what has been put down before: to undo a step and go on from there, and to take
// parts in hand without a procedure. All are scenes, so that a run of them is judged, recorded and replayed
// as any other, and the same scene gives the same bits.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "vps_scenes/export.h"
#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

struct PutDown {
  std::size_t part = 0;  ///< index into Scene::parts
  Pose X_WP;
};

/// What is left of a scene's procedure from that step on: what has been put down is fixed there. Each step
/// has the seed that it has in the whole procedure.
/// @param first  at most the number of steps
VPS_SCENES_API Scene sceneFromStep(const Scene& scene, std::size_t first, std::span<const PutDown> before);

/// Where the parts lie at first when they are taken freely: as their steps start, and moved aside along x
/// where their boxes would overlap. One pose for each part.
VPS_SCENES_API std::vector<Pose> laidOut(const Scene& scene);

/// A scene whose only step takes that part from where it lies, never ends by itself, and judges nothing; its
/// target is a hint. All others are fixed where they lie.
/// @param X_WP  of each part
VPS_SCENES_API Scene sceneOfOnePart(const Scene& scene, std::span<const Pose> X_WP, std::size_t part);

/// Of a run with so many planned steps.
VPS_SCENES_API Verdict verdictOf(const std::vector<StepResult>& steps, std::size_t planned);

}  // namespace vps::scenes
