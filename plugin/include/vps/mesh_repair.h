// SPDX-License-Identifier: BSD-3-Clause
// Finds and repairs the faults of meshes that leave inside and outside ambiguous.
#pragma once

#include <string>

#include "vps/export.h"
#include "vps/mesh.h"

namespace vps {

/// Result of repairMesh().
struct RepairedMesh {
  /// Mesh for winding numbers: all facets face out; without duplicates, internal walls and free sheets.
  Mesh solid;
  /// Mesh for distances: `solid` without facets that have solid on both sides, and with the sheets.
  Mesh surface;
  MeshReport report;
  /// True if the mesh is closed and faces out and no two shells' boxes overlap: pseudonormals then give the
  /// right sign on `surface`, unless the mesh crosses itself.
  bool is_sound = false;
};

/// Whether the mesh is known to cross itself, which repairMesh() does not test.
enum class Crossing { Unknown, Seen };

/// Surveys a mesh with shared vertices (see welded()) that requireUsable() accepts, and repairs it:
/// - Corners on both sides of a crack narrower than 2 um and a ten-thousandth of the mesh's size are joined.
///   Wider cracks stay; in the following items "cracks" are only these wider cracks.
/// - Of triangles with the same corners, or with cracks between them, one is kept. Of a back-to-back pair no
/// facet is kept if the pair is a wall between two solids, and one facet if the pair is the only surface
/// there (a surface
///   exported for both sides, or given twice and turned once).
/// - Facets are turned to agree across edges of two facets, and across cracks and T-junctions; the minority
/// is
///   turned. The cracks in this comparison may be as wide as 1/600 of the mesh's size and a quarter of the
///   edges beside the crack.
/// - Closed shells that face in are turned, with all shells within them, except voids: shells that lie wholly
///   within a shell that faces out, which they may touch. Shells that cross or copy another are solids and
///   are turned first.
/// - Open patches are turned if the rest of the mesh shows clearly on which side the solid is.
/// - Closed shells that touch or cross each other are united: facets are cut along the intersections, and
///   pieces with solid on both sides, or on neither, are left out. Facets without area are left out first;
///   open patches stay next to the union. Shells touch within 2.4e-7 of the greatest coordinate, four
///   roundings of a float. If no closed surface is found, if the union would take more than about half a
///   minute, or if a crack separates parts of a shell that touches another, nothing is cut and the report
///   says so.
/// - Facets (of closed shells) with a winding number above 0.5 on both sides (or neither) leave the surface:
///   solid within solid adds nothing, nor does a void within a void, since voids unite as solids do, crossing
///   or nested. Within a cavity a shell that faces out is therefore a solid, and a shell that faces in is
///   ignored.
/// A sound mesh is returned unchanged: O(n). Other meshes need about two winding numbers for each triangle.
/// `surface` is never empty.
VPS_API RepairedMesh repairMesh(Mesh mesh, Crossing crossing = Crossing::Unknown);

/// Repairs a sound mesh again as a mesh that is known to cross itself. The report covers both repairs.
VPS_API RepairedMesh repairCrossing(const RepairedMesh& sound);

/// Lids for an open mesh: each group of connected open edges is joined to its centre, so that a flat hole is
/// closed exactly. An edge is open if its facets do not run along it equally often in both directions. Empty
/// for a closed mesh. Expects shared vertices (see welded()); the lids use the mesh's vertex numbers.
/// O(n log n).
VPS_API Mesh lidsOf(const Mesh& mesh);

/// Volume, centre and inertia of the repaired solid: of its surface if that is closed; otherwise of all
/// shells, with flat lids over their holes. A volume within its rounding error is 0, as that of a flat sheet.
/// Where a single shell crosses itself and encloses a region twice, the region counts twice, also after
/// repairCrossing().
VPS_API MassProperties massOf(const RepairedMesh& repaired);

/// Volume, centre and inertia of the solid that a mesh describes: equal to `Solid(mesh).mass()` to the bit,
/// without building the data for distances. O(n log n). Throws LoadError as requireUsable(), naming the part.
VPS_API MassProperties solidMass(const Mesh& mesh, const std::string& part = "");

/// The report as one line of text: "12 shells, 34 open edges in 2 holes, 3 flipped facets turned; the sign of
/// the distance is certain at 99.8 % of the nodes".
VPS_API std::string describe(const MeshReport& report);

}  // namespace vps
