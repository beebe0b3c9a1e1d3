// SPDX-License-Identifier: BSD-3-Clause
// Of a contact with very many points, those that lead: a solver of rigid contact has no use for the others.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vps/export.h"
#include "vps/query.h"

namespace vps {

/// A shell in tiles: runs of its leaves that are no larger than asked for and face one way within 20 degrees.
/// find() gives of each tile the point that is nearest to the map, and the one that will be; where edges and
/// corners have several directions in one leaf, all that are near. What a step does to the gap within a tile
/// is taken to first order: the tile's inward normals are a linear function of place, fitted once.
///
/// Reads what queryContacts() reads, but carries, gives normals to and reports a few of each thousand points:
/// where 153,000 are near that takes a fifth of the time (plugin/README.md).
class VPS_API LeadingPoints {
 public:
  struct Ask {
    QueryOptions options;  ///< as queryContacts() takes them
    Twist step_M;  ///< how the shell's part will move against the map: about M's origin, in M [rad, m]
    std::span<const std::uint32_t> always;  ///< ids, ascending: given if they are near, leading or not
    std::size_t few =
        0;  ///< so many near points or fewer (to sixteen) are given all, as queryContacts() does
  };

  /// The shell must outlive it and not change. O(points); about 200 bytes a tile and 4 a leaf of 16 points.
  /// Throws std::invalid_argument if the size is not positive.
  LeadingPoints(const PointShell& shell, double tile_size_m);

  /// False if no tile holds two leaves: then find() gives what queryContacts() gives, and costs more.
  [[nodiscard]] bool isWorthIt() const noexcept { return is_worth_it_; }
  [[nodiscard]] std::size_t tileCount() const noexcept { return tiles_.size(); }
  /// Tile of a leaf of the shell; kNone if its points face several ways.
  [[nodiscard]] std::uint32_t tileOf(std::size_t leaf) const noexcept { return tile_of_leaf_[leaf]; }
  static constexpr std::uint32_t kNone = UINT32_MAX;

  /// As queryContacts(), with fewer points; each that is given is as it gives it, to the bit. A point left
  /// out has one of its tile among those given that is as near now, to 1/16384 voxel, and one that comes as
  /// near (as far as the first order tells) or less than kSame_m farther. Never throws, allocates, locks.
  QueryResult find(const VoxMap& map, const Pose& X_MP, const Ask& ask, ContactSet& out,
                   QueryMemory* memory = nullptr) noexcept;

  /// A difference of gaps that decides nothing [m]. assumed: well below what matters, above what rounding
  /// does
  static constexpr double kSame_m = 0.1e-6;

 private:
  struct Tile {
    Vec3 center = Vec3::Zero();  ///< of its points, in P [m]
    Vec3 inward = Vec3::Zero();  ///< their mean normal, not of unit length
    Mat3 bend = Mat3::Zero();    ///< derivative of the normal by place [1/m]
    double radius_m = 0;         ///< about the centre
  };
  struct Lead {
    std::uint32_t leaf, id;
  };
  class Search;

  void addTile(std::size_t first_leaf, std::size_t end_leaf);

  const PointShell* shell_;
  std::vector<Tile> tiles_;
  std::vector<std::uint32_t> tile_of_leaf_;
  std::vector<Lead> leads_;  ///< room for all points
  bool is_worth_it_ = false;
};

}  // namespace vps
