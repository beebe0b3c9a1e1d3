// SPDX-License-Identifier: BSD-3-Clause
// The least dimensions of parts that voxels have to resolve: sizes of parts, gaps, and walls that fit into
// gaps.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Distances between opposite walls of one mesh.
struct WallSizes {
  double thinnest_m = std::numeric_limits<double>::infinity();  ///< least thickness of material
  std::vector<double> gaps_m;                                   ///< widths of bores, slots and tooth spaces
};

/// Measures along the normals of at most about 4000 facets, to the next facet if this next facet is opposite
/// within 45 degrees: a V-groove, a thread and a wedge have no walls in this sense. Leaves out walls farther
/// apart than `most_m`, and walls closer than 1e-3 of the mesh's size (doubled facets). O(n log n).
WallSizes wallSizes(const Mesh& mesh, double most_m);

/// The least dimension of a part's box [m], without a dimension that is zero, as the thickness of a flat
/// sheet. The result is infinite for a mesh without extent.
double across_m(const Mesh& mesh);

/// The least dimension that has to be resolved in one part.
struct MeetingSize {
  double least_m = std::numeric_limits<double>::infinity();
  std::string words;  ///< the dimension in words: "the gap of 100 um in 'gear'"
};

/// For each part of the scene, the least of the following dimensions that is below `most_m`:
/// - across_m(), if the part moves or the scene has no steps,
/// - the widths of the part's bores, slots and tooth spaces into which a wall of another part fits,
/// - the thicknesses of the part's walls that fit into a bore, slot or tooth space of another part.
/// At least one of the two parts of a fit moves. Fits follow from the sizes alone,
/// independent of the poses and paths of the parts. O(triangles log triangles).
std::vector<MeetingSize> meetingSizes(const Scene& scene, double most_m);

}  // namespace vps::scenes
