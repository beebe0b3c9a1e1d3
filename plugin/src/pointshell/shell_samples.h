// SPDX-License-Identifier: BSD-3-Clause
// The two parts of sampling a surface: sharp features, then faces.
#pragma once

#include <vector>

#include "vps/mesh.h"

namespace vps {

/// Spacing of points on edges, divided by the spacing on faces. Assumed: tight fits touch at edges, and the
/// cost of points on edges is proportional only to length. A vertex of a chain is left out if its omission
/// moves the rim by less than 1/500 of the spacing: 1 um at 0.5 mm, a fifth of the allowance of a 20 um fit.
inline constexpr double kEdgeStep = 0.5;
inline constexpr double kEdgeTolerance = 1.0 / 500;

/// A point on the surface, before sorting.
struct ShellSample {
  Vec3 p = Vec3::Zero();
  Vec3 outward = Vec3::Zero();  ///< unit
  double area_m2 = 0;
};

/// Unit normal of each triangle; zero for a triangle without a normal.
std::vector<Vec3> triangleNormals(const Mesh& mesh);

/// Samples corners first, then sharp edges.
///
/// A corner is a vertex where sharp edges end, meet or turn by more than edge_angle_rad, or the tip of a
/// cone. Between corners, sharp edges form chains. A chain approximates a curve, and the vertices of a convex
/// curve (the rim of a peg) touch first. Therefore points are put on the chain's vertices where it bends, at
/// most step_m apart along the chain, and evenly on longer segments. A vertex is left out only if the chain
/// stays within tolerance_m of the chord that skips it. All points lie on the mesh's edges. Normals are
/// angle-weighted pseudonormals (Baerentzen and Aanaes 2005). Expects shared vertices. O(n log n).
std::vector<ShellSample> sampleFeatures(const Mesh& mesh, const std::vector<Vec3>& normals, double step_m,
                                        double tolerance_m, double edge_angle_rad);

/// Adds points on faces to samples (which may already contain features). Afterwards every point of the
/// surface has a sample within spacing_m that faces the same way (normals less than 90 degrees apart, so that
/// a thin wall is sampled on both sides). No new point is within 0.75 spacing_m of another point that faces
/// the same way, except on bumps: no smooth vertex protrudes by more than a hundredth of spacing_m beyond its
/// nearest point. Then assigns to each sample the area nearest to it. Deterministic. O(area / spacing^2 +
/// vertices).
void sampleFaces(const Mesh& mesh, const std::vector<Vec3>& normals, double spacing_m,
                 std::vector<ShellSample>& samples);

/// For a sheet: adds a copy of each sample that faces the other way, and samples of the border. The border's
/// samples are at most step_m apart and face away from the sheet in its plane. Where sheets meet, coincident
/// edges of one facet each are no border.
void addOtherSides(const Mesh& mesh, double step_m, std::vector<ShellSample>& samples);

}  // namespace vps
