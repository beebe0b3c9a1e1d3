// SPDX-License-Identifier: BSD-3-Clause
// A scene whose parts are off their size or their place.
#pragma once

#include "vps_scenes/scene.h"

namespace vps::scenes::inline v0 {

/// Moves every face of a part outwards by `by_m`, or inwards for a negative one, and removes its models. The
/// other parts stay as they are.
void growPart(ScenePart& part, double by_m);

/// The scene whose step's part is larger by `by_m` on every face. What stood on a seat now stands higher by
/// that much, so that its path and its target are moved back by it, against the last leg of the path.
Scene withGrownStep(const Scene& scene, std::size_t step, double by_m);

}  // namespace vps::scenes::inline v0
