// SPDX-License-Identifier: BSD-3-Clause
// The flat faces of a part, from the facets of its mesh.
#pragma once

#include <vector>

#include "fits/round_faces.h"
#include "fits/thread_faces.h"
#include "surface/part_surface.h"

namespace vps::scenes {

/// Facets in one plane that are connected, or beside each other across a crack, outside of round faces and
/// threads.
struct FlatFace {
  Vec3 n = Vec3::UnitZ();  ///< outward, unit, in the part's frame
  double offset_m = 0;     ///< n . x of its points
  double area_m2 = 0;
  double residual_m = 0;              ///< greatest distance of a corner from the plane
  std::vector<std::uint32_t> facets;  ///< ascending
};

/// The largest `most` faces, the largest first. O(n log n).
std::vector<FlatFace> flatFaces(const PartSurface& surface, const std::vector<RoundFace>& round,
                                const std::vector<ThreadFace>& threads, std::size_t most);

}  // namespace vps::scenes
