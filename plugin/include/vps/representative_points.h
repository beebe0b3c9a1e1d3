// SPDX-License-Identifier: BSD-3-Clause
// Reduces a contact of very many points to representative points, for solvers of rigid contact.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vps/export.h"
#include "vps/query.h"

namespace vps::inline v0 {

/// Divides a shell into tiles: runs of its leaves up to a given size whose normals agree within 20 degrees.
/// find() reports for each tile the point that is nearest to the map now and the point that will be nearest
/// after a given step. Of leaves at edges and corners, whose normals differ, all near points are reported.
/// The change of the gap within a tile is taken to first order: the tile's inward normals are a linear
/// function of position, fitted once.
///
/// find() reads the same points as queryContacts(), but computes normals for and reports only a few of each
/// thousand: with 153,000 near points it takes a fifth of the time (plugin/README.md).
class VPS_API RepresentativePoints {
 public:
  struct Request {
    QueryOptions options;  ///< as for queryContacts()
    Twist step_M;  ///< displacement of the shell's part against the map in the step, about M's origin, in M
                   ///< [rad, m]
    std::span<const std::uint32_t> required;  ///< ids, ascending, that are always reported if they are near
    /// With this many near points or fewer (counted in leaves of sixteen) all are reported, as by
    /// queryContacts().
    std::size_t full_count = 0;
  };

  /// The shell must outlive this object and not change. O(points); about 200 bytes for each tile and 4 for
  /// each leaf of 16 points. Throws std::invalid_argument if the size is not positive.
  RepresentativePoints(const PointShell& shell, double tile_size_m);

  /// False if no tile holds two leaves: find() then reports the same contacts as queryContacts().
  [[nodiscard]] bool reducesContacts() const noexcept { return reduces_contacts_; }
  /// Tile of a leaf of the shell; kNone if the leaf's normals differ.
  [[nodiscard]] std::uint32_t tileOf(std::size_t leaf) const noexcept { return tile_of_leaf_[leaf]; }
  static constexpr std::uint32_t kNone = UINT32_MAX;

  /// As queryContacts(), with fewer points; the reported contacts have the same bits. For each point left
  /// out, a reported point of the same tile is as near now, to 1/16384 voxel, and a reported point is as near
  /// after the step (to first order), or less than kSame_m farther. Never throws, allocates or locks.
  QueryResult find(const VoxMap& map, const Pose& X_MP, const Request& request, ContactSet& out,
                   QueryMemory* memory = nullptr) noexcept;

  /// Gaps that differ by less are treated as equal [m]. assumed: well below what matters, above rounding
  static constexpr double kSame_m = 0.1e-6;

 private:
  struct Tile {
    Vec3 center = Vec3::Zero();  ///< of its points, in P [m]
    Vec3 inward = Vec3::Zero();  ///< mean inward normal of its points, not of unit length
    Mat3 bend = Mat3::Zero();    ///< derivative of the normal with respect to position [1/m]
    double radius_m = 0;         ///< greatest distance of its points from the centre
  };
  struct Chosen {
    std::uint32_t leaf, id;
  };
  class Search;

  void addTile(std::size_t first_leaf, std::size_t end_leaf);

  const PointShell* shell_;
  std::vector<Tile> tiles_;
  std::vector<std::uint32_t> tile_of_leaf_;
  std::vector<Chosen> chosen_;  ///< with capacity for all points
  bool reduces_contacts_ = false;
};

}  // namespace vps::inline v0
