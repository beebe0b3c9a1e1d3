// SPDX-License-Identifier: BSD-3-Clause
// The pointshell: points on a part's surface with inward normals, and the spheres that bound them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vps/errors.h"
#include "vps/export.h"
#include "vps/mesh.h"
#include "vps/simd.h"

namespace vps {

class Solid;

struct PointShellSettings {
  double spacing_m = 0.5e-3;     ///< wanted distance between neighbouring points
  double edge_angle_rad = 0.35;  ///< edges sharper than this (about 20 degrees) get points of their own
};

/// A node of the sphere hierarchy over points [first, first + count). Nodes are in depth-first order; a
/// search continues at `skip` when it does not descend into a node.
struct ShellNode {
  Vec3 center = Vec3::Zero();
  double radius_m = 0;
  std::uint32_t first = 0, count = 0;
  std::uint32_t skip = 0;  ///< index of the next node when this node is culled
  bool is_leaf = false;
};

/// Points on the surface, in the part's frame P. The arrays have one entry per point, in the order of a k-d
/// tree's leaves, so that neighbours in space are neighbours in memory. `order` lists the points such that
/// every prefix is an even, coarser sampling. A point's index is its stable id.
struct VPS_API PointShell {
  std::vector<Vec3> points;
  std::vector<Vec3> inward;     ///< unit normals into the part
  std::vector<double> area_m2;  ///< the surface area that each point represents; the sum is the mesh's area
  std::vector<std::uint32_t> order;  ///< progressive order, a permutation
  std::vector<ShellNode> nodes;      ///< sphere hierarchy, depth-first
  /// The hierarchy that queries use: leaves of sixteen points, then blocks of sixteen spheres around them,
  /// and so on; the root last.
  std::vector<ShellBlock> blocks;
  std::size_t leaf_blocks = 0;  ///< number of blocks that hold points; these blocks come first
  double spacing_m = 0;
  [[nodiscard]] std::size_t size() const noexcept { return points.size(); }
  [[nodiscard]] std::size_t memoryBytes() const noexcept;
};

/// Samples mesh corners, sharp edges (evenly, at half the spacing, on the vertices of rims) and faces (blue
/// noise). Every surface point has a shell point within spacing_m that faces the same way; face points are at
/// least 0.75 spacing_m apart, except on bumps: no vertex protrudes by more than a hundredth of spacing_m
/// beyond its nearest point. The protrusion is measured along the mean of both normals, so that even
/// curvature counts as none; if the normals are more than 20 degrees apart, along the vertex's own normal.
/// Face points have the triangle's normal, because interpolated normals would describe another surface than
/// the mesh's exact distance; points on edges and corners have the angle-weighted pseudonormal.
/// Deterministic. O(area / spacing^2). Throws LoadError for unusable meshes, for a spacing that is not
/// positive, and for a spacing that would give more points than fit in memory; the message names a spacing
/// that would fit.
VPS_API PointShell buildPointShell(const Mesh& mesh, const PointShellSettings& settings,
                                   const std::string& part = "", const Progress& progress = {});

/// buildPointShell() for a solid's repaired surface: the normals point into the solid. A sheet has each point
/// twice, once for each side with the whole area, and points on its border whose normals point into the
/// sheet.
VPS_API PointShell buildPointShell(const Solid& solid, const PointShellSettings& settings,
                                   const std::string& part = "", const Progress& progress = {});

/// The smallest spacing, not below the given one, at which buildPointShell() accepts the number of points.
/// O(triangles).
VPS_API double fittingSpacing_m(const Mesh& mesh, double spacing_m);

/// Merges shells at their poses into one, for mounted parts. Point i of shell s gets the id i plus the sizes
/// of the shells before s. The shells' hierarchies become children of one root.
VPS_API PointShell mergedShells(const std::vector<const PointShell*>& shells, const std::vector<Pose>& X_MPs);

/// A shell of the points in the boxes, in the same order and clusters: a query against a field that stays in
/// the boxes finds the same contacts to the bit, under smaller ids. O(points).
VPS_API PointShell croppedShell(const PointShell& shell, const std::vector<Box>& boxes_P);

/// Writes PLY with the properties x y z, nx ny nz (inward) and area, as binary little-endian doubles, so that
/// the shell is read back to the bit. An existing file is replaced whole or not at all. Throws LoadError.
VPS_API void savePly(const PointShell& shell, const std::string& file);
/// Reads a PLY file with the properties that savePly() writes, in any order and of any number type, binary
/// little-endian or ascii. Throws LoadError.
VPS_API PointShell loadPly(const std::string& file);

}  // namespace vps
