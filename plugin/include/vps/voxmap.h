// SPDX-License-Identifier: BSD-3-Clause
// The voxmap: a part's signed distance on a sparse grid.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "vps/errors.h"
#include "vps/export.h"
#include "vps/mesh.h"

namespace vps {

struct VoxMapSettings {
  double voxel_m = 0.25e-3;  ///< grid step h
  double band_voxels = 4;    ///< half width of the narrow band in voxels, >= 3 (nodal gradients need it)
};

/// How the normal is read from the field. `Continuous` interpolates nodal gradients: the force does not jump
/// from cell to cell, but is only nearly conservative. `Trilinear` is the exact derivative of the
/// interpolated distance, and jumps at cell borders. Cost and error of both: plugin/method.md.
enum class Gradient { Continuous, Trilinear };

class Solid;
struct VoxLayout;  // cells and bricks

/// Signed distance [m] to a part's surface in frame M, negative inside. At the grid's nodes within the band
/// it is exact to half a quantum_m() (nodes have 16 bits); between nodes it is trilinear. Beyond the band the
/// distance saturates at +-band_m() with the right sign, and lowerBound() gives a coarse lower bound of the
/// distance. A map is immutable, and copies share its data. Reading is thread-safe and never allocates or
/// throws.
class VPS_API VoxMap {
 public:
  static constexpr int kBrick = 8;  ///< grid cells per brick edge

  struct Sample {
    double distance_m = 0;
    Vec3 normal = Vec3::Zero();
  };

  /// An empty map: every point is outside.
  VoxMap();

  [[nodiscard]] double voxel_m() const noexcept { return voxel_m_; }
  [[nodiscard]] double band_m() const noexcept { return band_m_; }
  /// The step in which nodes store distances: band_m() / 32767.
  [[nodiscard]] double quantum_m() const noexcept { return quantum_m_; }
  /// Box of the part's surface, in M (without the band).
  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }
  /// The number of parts merged into the map.
  [[nodiscard]] std::size_t partCount() const noexcept;
  /// True if both are copies of one map.
  [[nodiscard]] bool isSame(const VoxMap& other) const noexcept { return layout_ == other.layout_; }
  /// Bricks of 8^3 cells that store nodes.
  /// Number of bricks of 8^3 cells that store nodes.
  [[nodiscard]] std::size_t brickCount() const noexcept;
  /// Memory of this map. A map and the map that it was mounted on share most of it.
  [[nodiscard]] std::size_t memoryBytes() const noexcept;
  /// Memory of this map that it does not share with `other`.
  [[nodiscard]] std::size_t additionalMemoryBytes(const VoxMap& other) const noexcept;

  /// Trilinear signed distance [m] at p_M, saturated at +-band_m().
  [[nodiscard]] double distance(const Vec3& p_M) const noexcept;
  /// Unit outward normal (the direction in which the distance grows); zero beyond the band.
  [[nodiscard]] Vec3 normal(const Vec3& p_M, Gradient gradient = Gradient::Continuous) const noexcept;
  /// Distance and normal together, at less cost than two calls.
  [[nodiscard]] Sample sample(const Vec3& p_M, Gradient gradient = Gradient::Continuous) const noexcept;
  /// A lower bound of the true unsigned distance to the surface, from the grid of cells; outside the grid it
  /// grows with the distance to the part's box. Not negative. Used to skip whole clusters of points.
  [[nodiscard]] double lowerBound(const Vec3& p_M) const noexcept;
  /// A lower bound of the signed distance at p_M; -band_m() where nothing better is known. The bound also
  /// serves a sphere of points: every distance(q) with |q - p_M| <= r is at least min(leastDistance(p_M) - r,
  /// band_m()) - sampleError_m().
  [[nodiscard]] double leastDistance(const Vec3& p_M) const noexcept;
  /// A bound of the difference between distance() and the saturated true distance: sqrt(3)/2 voxel and half a
  /// quantum, reached at the middle of a cell where surfaces meet in a corner. (On smooth surfaces the
  /// difference is h^2/8 times the curvature.)
  [[nodiscard]] double sampleError_m() const noexcept;
  /// True if p_M is inside. Also valid beyond the band, where distance() has saturated.
  [[nodiscard]] bool isInsideCoarse(const Vec3& p_M) const noexcept;
  /// Index of the part (in the order of merging, from 0) whose surface is nearest at the node nearest to p_M.
  [[nodiscard]] std::uint16_t owner(const Vec3& p_M) const noexcept;

 private:
  friend class VoxMapAccess;
  double voxel_m_ = 0, band_m_ = 0, quantum_m_ = 0;
  Box bounds_;
  std::shared_ptr<const VoxLayout> layout_;  // never null
};

/// Builds the map of one mesh, with the exact distance to its triangles at every node within the band. The
/// sign comes from pseudonormals if the mesh is closed, faces out and does not overlap itself, and otherwise
/// from the winding number of the mesh as repaired by repairMesh(). A Solid of the mesh decides in the same
/// way, except that it also detects crossings that are smaller than a voxel. `report`, if given, tells which
/// faults were found and for what fraction of the nodes the sign is certain. O(surface area / h^2). Throws
/// LoadError for a mesh that requireUsable() refuses, a voxel size that is not positive, or a grid that would
/// not fit in memory; the message names a voxel size that would fit.
VPS_API VoxMap buildVoxMap(const Mesh& mesh, const VoxMapSettings& settings, const std::string& part = "",
                           const Progress& progress = {}, MeshReport* report = nullptr);

/// A solid at its pose in a map's frame.
struct PlacedSolid {
  const Solid* solid = nullptr;
  Pose X_MP;
};

/// buildVoxMap() for a solid that exists already: uses its surface and its signs. O(surface area / h^2).
VPS_API VoxMap buildVoxMap(const Solid& solid, const VoxMapSettings& settings, const std::string& part = "",
                           const Progress& progress = {}, MeshReport* report = nullptr);
VPS_API VoxMap buildVoxMap(const PlacedSolid& solid, const VoxMapSettings& settings,
                           const std::string& part = "", const Progress& progress = {},
                           MeshReport* report = nullptr);

/// A mesh at its pose in a map's frame.
struct PlacedMesh {
  const Mesh* mesh = nullptr;
  Pose X_MP;
};

/// "Cooks" mounted parts into one voxmap: the union, as the minimum of the parts' own exact distances on one
/// grid. Nothing is resampled, and the order of the parts does not matter; owner() tells them apart. Throws
/// LoadError as buildVoxMap(), for a pose that is not finite, and for parts so far apart that one map would
/// not fit in memory; mounting and resampling throw for the same reasons. Source: Tripicchio et al.,
/// section 5.
VPS_API VoxMap cookVoxMap(const std::vector<PlacedMesh>& parts, const VoxMapSettings& settings,
                          const Progress& progress = {});
VPS_API VoxMap cookVoxMap(const std::vector<PlacedSolid>& parts, const VoxMapSettings& settings,
                          const Progress& progress = {});

/// Adds a part to a cooked map and returns the new map; the old map is unchanged. The cost is proportional to
/// the new part's surface.
VPS_API VoxMap mountVoxMap(const VoxMap& cooked, const PlacedMesh& part);
VPS_API VoxMap mountVoxMap(const VoxMap& cooked, const PlacedSolid& part);

/// A map at its pose in another map's frame.
struct PlacedMap {
  const VoxMap* map = nullptr;
  Pose X_MP;
};

/// Resamples a placed map onto the grid of `settings`: every node is read from the map's own field. The
/// errors of both fields add up; sampleError_m() bounds them. Resampling is much faster than building the map
/// at the new pose. Throws LoadError if the map's band is narrower than the requested one, or as
/// buildVoxMap().
VPS_API VoxMap resampledVoxMap(const PlacedMap& part, const VoxMapSettings& settings);

/// As mountVoxMap() for a mesh, but resamples the part's own map: milliseconds instead of a tenth of a second
/// or more.
VPS_API VoxMap mountVoxMap(const VoxMap& cooked, const PlacedMap& part);

/// Estimates the bytes that building a mesh's map takes: the bricks that meet a slab of the surface's area,
/// as thick as the band, and the directory of its box. buildVoxMap() uses this estimate to refuse maps that
/// would not fit. The estimate holds for surfaces of many bricks; a part smaller than a brick may take
/// somewhat more. O(triangles).
VPS_API double expectedMapBytes(const Mesh& mesh, const VoxMapSettings& settings);
/// The limit of expectedMapBytes() above which buildVoxMap() refuses to build a map.
VPS_API double largestMapBytes();
/// The smallest voxel size, not below the settings' own, at which the estimate is at most `most_bytes`; to
/// 0.1 %. Infinite if no voxel size is large enough. O(triangles).
VPS_API double fittingVoxel_m(const Mesh& mesh, const VoxMapSettings& settings, double most_bytes);

/// A copy of the map that keeps only the nodes in and around the boxes; readings there are the same to the
/// bit. Elsewhere the copy reads as saturated, with the right sign for each cell, and its bounds do not hold:
/// use it only for queries whose points, and the centres of their clusters, stay in one of the boxes. More
/// parts can be mounted on the copy. O(cells).
VPS_API VoxMap croppedVoxMap(const VoxMap& map, const std::vector<Box>& boxes_M);

}  // namespace vps
