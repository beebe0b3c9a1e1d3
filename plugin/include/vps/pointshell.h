// SPDX-License-Identifier: BSD-3-Clause
// The pointshell: points on a part's surface with inward normals, and the spheres that bound them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vps/export.h"
#include "vps/mesh.h"
#include "vps/progress.h"
#include "vps/shell_block.h"

namespace vps {

struct PointShellSettings {
  double spacing_m = 0.5e-3;     ///< wanted distance between neighbouring points
  double edge_angle_rad = 0.35;  ///< edges sharper than this (about 20 degrees) get points of their own
};

/// A node of the sphere hierarchy over points [first, first + count). Nodes are in depth-first order: if a
/// node is skipped the walk goes on at `skip`.
struct ShellNode {
  Vec3 center = Vec3::Zero();
  double radius_m = 0;
  std::uint32_t first = 0, count = 0;
  std::uint32_t skip = 0;  ///< index of the next node when this one is culled
  bool is_leaf = false;
};

/// Points on the surface, in the part's frame P. All arrays have one entry a point, in the order of a k-d
/// tree's leaves, so that neighbours in space are neighbours in memory. `order` lists the points so that
/// every prefix is an even, coarser sampling. A point's index is its stable id.
struct VPS_API PointShell {
  std::vector<Vec3> points;
  std::vector<Vec3> inward;          ///< unit normals into the part
  std::vector<double> area_m2;       ///< the surface each point stands for; sums to the mesh's area
  std::vector<std::uint32_t> order;  ///< progressive order, a permutation
  std::vector<ShellNode> nodes;      ///< sphere hierarchy, depth-first
  /// The same leaves sixteen points wide, then spheres around sixteen leaves each, and so on; the root last.
  /// What queries walk.
  std::vector<ShellBlock> blocks;
  std::size_t leaf_blocks = 0;  ///< how many of the blocks hold points; they come first
  double spacing_m = 0;
  [[nodiscard]] std::size_t size() const noexcept { return points.size(); }
  [[nodiscard]] std::size_t memoryBytes() const noexcept;
};

/// Samples mesh corners, sharp edges (evenly, at half the spacing, on the vertices of rims:
/// src/shell_samples.h) and faces (blue noise). Every point of the surface has a point within spacing_m that
/// faces its way; face points are no nearer than 0.75 spacing_m to each other. Normals: the triangle's on
/// faces, since interpolated ones would claim a surface that the mesh's exact distance does not know; the
/// angle-weighted pseudonormal on edges and corners. Deterministic. O(area / spacing^2). Throws LoadError for
/// unusable meshes and for a spacing that is not positive or would give more points than fit (says which
/// would).
VPS_API PointShell buildPointShell(const Mesh& mesh, const PointShellSettings& settings,
                                   const std::string& part = "", const Progress& progress = {});

/// One shell out of several at poses (for mounted parts). Points keep their places: id i of shell s becomes
/// i + the sizes of the shells before it. The shells' hierarchies hang side by side under one root.
VPS_API PointShell mergedShells(const std::vector<const PointShell*>& shells, const std::vector<Pose>& X_MPs);

/// PLY with x y z nx ny nz (nx.. inward) and area: written binary little-endian, to the bit, and replaced
/// whole or not at all; read binary little-endian or ascii, any order and type of properties. Throws
/// LoadError.
VPS_API void savePly(const PointShell& shell, const std::string& file);
VPS_API PointShell loadPly(const std::string& file);

}  // namespace vps
