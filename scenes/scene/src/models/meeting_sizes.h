// SPDX-License-Identifier: BSD-3-Clause
// The least dimensions that have to be resolved where the parts of a scene meet.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Opposite walls of one mesh, up to a distance.
struct WallSizes {
  double thinnest_m = std::numeric_limits<double>::infinity();  ///< least thickness of material
  std::vector<double> gaps_m;                                   ///< widths of bores, slots and tooth spaces
};

/// Measured along the normals of at most some 4000 facets, to the next facet if that faces the other way
/// within 45 degrees: a V-groove, a thread and a wedge have no walls in this sense. Walls farther apart than
/// `most_m` are left out, and nearer than 1e-3 of the mesh (doubled facets). O(n log n).
WallSizes wallSizes(const Mesh& mesh, double most_m);

/// The least size of a part's box [m]; of a flat sheet, the least that is not its thickness. Infinite for a
/// mesh without extent.
double across_m(const Mesh& mesh);

/// What has to be resolved of one part.
struct MeetingSize {
  double least_m = std::numeric_limits<double>::infinity();
  std::string words;  ///< "the gap of 100 um in 'gear'"
};

/// For each part of the scene, the least of
/// - its size across, if it moves, or if the scene has no steps,
/// - its bores, slots and tooth spaces into which a wall of another part fits,
/// - its walls that fit into such a gap of another part,
/// as far as these are below `most_m`. One of the two parts moves. Where a small part may go in the course of
/// a run is not asked: a fit is found from the sizes, wherever the parts begin. O(triangles log triangles).
std::vector<MeetingSize> meetingSizes(const Scene& scene, double most_m);

}  // namespace vps::scenes
