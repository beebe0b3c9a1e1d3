// SPDX-License-Identifier: BSD-3-Clause
// Properties of a scene's steps: direction of insertion, parts in place, size and point spacing of the moved
// parts.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// The direction in which a step moves its part to the target: unit vector, in W, of the last leg of the path
/// of the part's point G. A step that takes its part off has the direction of the first leg, along which the
/// part comes free. Zero for a leg on which the part only rotates.
Vec3 insertionAxis(const SceneStep& step, const Pose& X_PG);

/// A part that is in place before a step.
struct PartInPlace {
  std::size_t part = 0;
  Pose X_WP;
};

/// The parts in place: fixed parts, in the scene's order; then parts that later steps take off, the last step
/// first; then parts that earlier steps mounted. The parts that are in place in two steps therefore come
/// first, and in the same order, in the lists of both steps.
std::vector<PartInPlace> partsInPlace(const Scene& scene, std::size_t before_step);

/// The moved part whose box, in the part's frame, has the least dimension. Moved parts are the parts of the
/// steps or, in a scene without steps, the parts that are not fixed.
struct SmallestPart {
  std::string name;     ///< empty: no part moves
  double across_m = 0;  ///< infinite: no part moves
};
SmallestPart smallestMoved(const Scene& scene);

/// Spacing of the points in a scene that states no spacing: a quarter of the smallest moved part, between two
/// and four voxels. In penalty contact each point stands for an area, and the distance is always two voxels.
/// O(vertices of moved parts).
///
/// Measured: a peg of 8 mm penetrates its hole by less than 1 um on the way to its target with points every 2
/// mm, and the rim of the hole by 129 um with points every 4 mm. Edges have points at half the spacing, and
/// crossings of edges are found without points, so more points on faces add time and no accuracy to rigid
/// contacts (FIDELITY.md).
double usualSpacing_m(const Scene& scene);

}  // namespace vps::scenes
