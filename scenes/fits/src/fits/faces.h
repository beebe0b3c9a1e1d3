// SPDX-License-Identifier: BSD-3-Clause
// The faces of a part that can take part in a fit: cylinders, planes and screw threads, from the facets of
// its mesh.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "surface/part_surface.h"
#include "surface/round_face.h"
#include "vps/pose.h"

namespace vps::scenes {

/// A screw thread: its flanks, crests and roots.
struct ThreadFace {
  Vec3 axis = Vec3::UnitZ();  ///< unit, in the part's frame
  Vec3 p = Vec3::Zero();      ///< point on the axis
  double lead_m = 0;          ///< axial advance in one turn; negative: a left-hand thread
  int starts = 1;
  bool is_inside = false;       ///< in a bore
  double from_m = 0, to_m = 0;  ///< along the axis, from p
  double least_m = 0;           ///< least radius of the flanks
  double greatest_m = 0;        ///< radius of the cylinder through the crests (in a bore: the roots)
  double residual_m = 0;        ///< greatest distance of a crest (or root) from the cylinder of greatest_m
  std::vector<std::uint32_t> facets;  ///< flanks, crests and roots; ascending
};

/// Finds threads of at least two turns with inclined flanks, around the axes of round faces and the principal
/// axes of inertia through the centre of mass. Square threads are not found, nor threads whose flanks are
/// divided into facets longer than a twelfth of a turn. O(facets) for each axis, and 0.1 s for each thread.
std::vector<ThreadFace> threadFaces(const PartSurface& surface, const std::vector<RoundFace>& round);

/// Facets in one plane that are connected or separated by a crack only, and that belong to no round face and
/// no thread.
struct FlatFace {
  Vec3 n = Vec3::UnitZ();  ///< outward, unit, in the part's frame
  double offset_m = 0;     ///< n . x for the points x of the face
  double area_m2 = 0;
  double residual_m = 0;              ///< greatest distance of a corner from the plane
  std::vector<std::uint32_t> facets;  ///< ascending
};

/// The `most` largest flat faces, in descending order of area. O(n log n).
std::vector<FlatFace> flatFaces(const PartSurface& surface, const std::vector<RoundFace>& round,
                                const std::vector<ThreadFace>& threads, std::size_t most);

/// All faces of a part that can take part in a fit.
struct FitFaces {
  std::vector<RoundFace> round;
  std::vector<FlatFace> flat;
  std::vector<ThreadFace> threads;
};
FitFaces fitFaces(const PartSurface& surface);

}  // namespace vps::scenes
