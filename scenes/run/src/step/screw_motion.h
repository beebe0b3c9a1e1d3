// SPDX-License-Identifier: BSD-3-Clause
// Whether a part that was screwed on followed its thread.
#pragma once

#include <span>
#include <string>

#include "vps_scenes/run/result.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Sets turns, advance_per_turn_m and lean_rad from the last time that the part was screwed on.
/// @param axis_W  insertion axis
/// @param X_PG    grasp frame G, whose origin lies on the axis
void measureScrew(std::span<const TraceRow> rows, const SceneStep& step, const Vec3& axis_W, const Pose& X_PG,
                  StepResult& result);

/// Why the part is not on its thread, by turns, advance_per_turn_m and lean_rad; empty if the part followed
/// the thread, or if a person moved the part.
std::string threadFault(const SceneStep& step, const StepResult& result);

/// The pose without its rotation about the axis through G, since the target of a screw is a height, not an
/// angle.
Pose turnedBack(const Pose& X_WP, const SceneStep& step, const Vec3& axis_W, const Pose& X_PG);

}  // namespace vps::scenes
