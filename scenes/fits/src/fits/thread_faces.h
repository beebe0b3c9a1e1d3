// SPDX-License-Identifier: BSD-3-Clause
// The screw threads of a part, from the facets of its mesh.
#pragma once

#include <vector>

#include "fits/round_faces.h"

namespace vps::scenes {

struct ThreadFace {
  Vec3 axis = Vec3::UnitZ();  ///< unit, in the part's frame
  Vec3 p = Vec3::Zero();      ///< on the axis
  double lead_m = 0;          ///< its way in one turn; negative: a left-hand thread
  int starts = 1;
  bool is_inside = false;             ///< in a bore
  double from_m = 0, to_m = 0;        ///< along the axis, from p
  double least_m = 0;                 ///< least radius of the flanks
  double greatest_m = 0;              ///< radius of the cylinder through crests (of a bore: roots)
  double residual_m = 0;              ///< greatest distance of a crest from it
  std::vector<std::uint32_t> facets;  ///< flanks, crests and roots; ascending
};

/// Threads of two turns or more with inclined flanks, around the axes of round faces and the principal axes
/// of inertia through the centre of mass. Square threads, and those whose flanks are divided into facets
/// longer than a twelfth of a turn, are not found. O(facets) for each axis, and 0.1 s for each thread.
std::vector<ThreadFace> threadFaces(const PartSurface& surface, const std::vector<RoundFace>& round);

}  // namespace vps::scenes
