// SPDX-License-Identifier: BSD-3-Clause
// What is wrong with a mesh, and a mesh on which inside and outside are as sure as they can be.
#pragma once

#include <string>

#include "vps/export.h"
#include "vps/mesh.h"

namespace vps {

/// What repairMesh() makes of a mesh.
struct RepairedMesh {
  /// Facing out all over, for winding numbers: without duplicates, walls within the solid and free sheets.
  Mesh solid;
  /// What distances are measured to: `solid` without facets that have solid on both sides, and with the
  /// sheets.
  Mesh surface;
  MeshReport report;
  /// Closed, facing out, no two shells' boxes meet: pseudonormals give the right sign on `surface`, unless it
  /// crosses itself.
  bool is_sound = false;
};

/// Whether the mesh was seen to cross itself, which its edges do not tell.
enum class Crossing { Unknown, Seen };

/// Surveys a mesh with shared vertices (see welded()) that requireUsable() accepts, and repairs what cannot
/// wait until the sign is asked for:
/// - of triangles with the same corners one is kept; of a pair back to back none, where it is a wall between
///   two solids, but one where it is all there is (a surface exported for both sides);
/// - facets are turned to agree across edges of two, the fewer to the more;
/// - closed shells that face in are turned, unless they are a cavity: one within a shell that faces out. What
///   lies in a shell that is turned turns with it;
/// - open patches are turned where the rest of the mesh says clearly on which side the solid is;
/// - facets with winding number above 0.5 on both sides are no surface.
/// A sound mesh comes back as it was: O(n). Others need about two winding numbers a triangle.
/// `surface` is never empty.
VPS_API RepairedMesh repairMesh(Mesh mesh, Crossing crossing = Crossing::Unknown);

/// In words, for a person: "12 shells, 34 open edges in 2 holes, 3 flipped facets turned; the sign is sure
/// for 99.8 %".
VPS_API std::string describe(const MeshReport& report);

}  // namespace vps
