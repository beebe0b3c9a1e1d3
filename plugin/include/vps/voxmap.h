// SPDX-License-Identifier: BSD-3-Clause
// The voxmap: a part's signed distance on a sparse grid, sampled millions of times a second.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "vps/export.h"
#include "vps/mesh.h"
#include "vps/progress.h"

namespace vps {

struct VoxMapSettings {
  double voxel_m = 0.25e-3;  ///< grid step h
  double band_voxels = 4;    ///< half width of the narrow band in voxels, >= 3 (nodal gradients need it)
};

/// How the normal is read from the field. `Continuous` interpolates nodal gradients: the force never jumps
/// from cell to cell, and is only nearly the derivative of an energy. `Trilinear` is the exact derivative of
/// the interpolated distance, and turns abruptly at cell borders. Cost and error: plugin/README.md.
enum class Gradient { Continuous, Trilinear };

struct VoxLayout;  // cells and bricks: src/voxmap_layout.h

/// Signed distance [m] to a part's surface in frame M, negative inside: at the grid's nodes within the band
/// exact to half a quantum_m() (nodes are 16 bit), trilinear between them. Beyond the band the distance
/// saturates at +-band_m() with the right sign, and lowerBound() gives a coarse bound that still tells far
/// from near. Immutable once built; sampling is thread-safe, and never allocates or throws.
class VPS_API VoxMap {
 public:
  static constexpr int kBrick = 8;  ///< grid cells per brick edge

  struct Sample {
    double distance_m = 0;
    Vec3 normal = Vec3::Zero();
  };

  /// An empty map: outside everywhere.
  VoxMap();

  [[nodiscard]] double voxel_m() const noexcept { return voxel_m_; }
  [[nodiscard]] double band_m() const noexcept { return band_m_; }
  /// The step in which nodes store distances: band_m() / 32767.
  [[nodiscard]] double quantum_m() const noexcept { return quantum_m_; }
  /// Box of the part's surface, in M (without the band).
  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }
  /// Parts merged into it.
  [[nodiscard]] std::size_t partCount() const noexcept;
  /// True if both are copies of one map.
  [[nodiscard]] bool isSame(const VoxMap& other) const noexcept { return layout_ == other.layout_; }
  [[nodiscard]] std::size_t brickCount() const noexcept;
  /// What this map keeps in memory; maps that were mounted one on another share the most of it.
  [[nodiscard]] std::size_t memoryBytes() const noexcept;
  /// What it keeps in memory beside another that is kept anyway.
  [[nodiscard]] std::size_t memoryBytesBeside(const VoxMap& other) const noexcept;

  /// Trilinear signed distance [m] at p_M, saturated at +-band_m().
  [[nodiscard]] double distance(const Vec3& p_M) const noexcept;
  /// Unit outward normal (direction of growing distance); zero where the band gives none.
  [[nodiscard]] Vec3 normal(const Vec3& p_M, Gradient gradient = Gradient::Continuous) const noexcept;
  /// Both at once, for less than the two apart.
  [[nodiscard]] Sample sample(const Vec3& p_M, Gradient gradient = Gradient::Continuous) const noexcept;
  /// A value d with |true distance| >= d for the surface, from a coarse grid that covers all space: far away
  /// it grows with the distance to the part's box. Not negative. Used to skip whole clusters of points.
  [[nodiscard]] double lowerBound(const Vec3& p_M) const noexcept;
  /// A value that the signed distance at p_M is not below; -band_m() where that is all that is known. What a
  /// sphere of points needs: every distance(q) with |q - p_M| <= r is at least min(leastDistance(p_M) - r,
  /// band_m()) - sampleError_m().
  [[nodiscard]] double leastDistance(const Vec3& p_M) const noexcept;
  /// The most by which distance() can fall short of or exceed the true distance, saturated: sqrt(3)/2 voxel,
  /// and half a quantum, at the middle of a cell where surfaces meet at a corner. (On smooth surfaces it is
  /// h^2/8 times curvature.)
  [[nodiscard]] double sampleError_m() const noexcept;
  /// True if p_M is inside by the coarse sign; meaningful beyond the band, where distance() has saturated.
  [[nodiscard]] bool isInsideCoarse(const Vec3& p_M) const noexcept;
  /// Index of the part (order of merging, 0 first) whose surface is nearest at p_M's nearest node.
  [[nodiscard]] std::uint16_t owner(const Vec3& p_M) const noexcept;

 private:
  friend class VoxMapAccess;
  double voxel_m_ = 0, band_m_ = 0, quantum_m_ = 0;
  Box bounds_;
  std::shared_ptr<const VoxLayout> layout_;  // never null
};

/// Builds the map of one mesh: exact distance to its triangles at every node within the band. Sign by
/// pseudonormals where the mesh is closed, faces out and does not overlap itself; else by the winding number
/// of what repairMesh() makes of it, and `report`, if given, tells what was found and how sure the sign is.
/// O(surface area / h^2). Throws LoadError for a mesh that requireUsable() refuses, a voxel size that is not
/// positive, or a grid that would not fit in memory (says which voxel size would).
VPS_API VoxMap buildVoxMap(const Mesh& mesh, const VoxMapSettings& settings, const std::string& part = "",
                           const Progress& progress = {}, MeshReport* report = nullptr);

/// A part to be fused into one map, at its pose in the map's frame.
struct PlacedMesh {
  const Mesh* mesh = nullptr;
  Pose X_MP;
};

/// "Cooks" mounted parts into one voxmap (paper, section 5): the union, min over the parts' own exact
/// distances on one grid, so nothing is resampled and the order of mounting does not matter. owner() tells
/// the parts apart. Throws LoadError as buildVoxMap(), for a pose that is not finite, and for parts so far
/// apart that one map of them would not fit in memory; so do mounting, resampling and uniting.
VPS_API VoxMap cookVoxMap(const std::vector<PlacedMesh>& parts, const VoxMapSettings& settings,
                          const Progress& progress = {});

/// Adds one more part to a cooked map: returns the new map, leaves the old untouched. Cost follows the new
/// part.
VPS_API VoxMap mountVoxMap(const VoxMap& cooked, const PlacedMesh& part);

/// A map at its pose in another map's frame.
struct PlacedMap {
  const VoxMap* map = nullptr;
  Pose X_MP;
};

/// The field of a placed map on the grid of settings: every node is read from the map's own field, so it is
/// off by that field's error and adds its own; sampleError_m() says how much. Much quicker than building
/// anew. Throws LoadError if the map's band is narrower than the one asked for, or as buildVoxMap().
VPS_API VoxMap resampledVoxMap(const PlacedMap& part, const VoxMapSettings& settings);

/// As mountVoxMap() for a mesh, from the part's own field: milliseconds where the mesh takes a tenth of a
/// second or more, for the price of one resampling.
VPS_API VoxMap mountVoxMap(const VoxMap& cooked, const PlacedMap& part);

}  // namespace vps
