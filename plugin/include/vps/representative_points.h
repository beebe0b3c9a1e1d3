// SPDX-License-Identifier: BSD-3-Clause
// Reduces a contact of very many points to representative points, for solvers of rigid contact.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vps/export.h"
#include "vps/query.h"

namespace vps::inline v0 {

/// Divides a shell into tiles: nodes of its hierarchy up to a given size, and in each tile the points into
/// groups whose normals agree within 20 degrees. find() reports for each group the point that is nearest to
/// the map now and the point that will be nearest after a given step. The change of the gap within a group is
/// taken to first order: its inward normals are a linear function of position, fitted once.
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

  /// The shell must outlive this object and not change. O(points); about 200 bytes for each group and 2 for
  /// each point. Throws std::invalid_argument if the size is not positive.
  /// @param on_edge  by point: not 0 for those on sharp edges. The plane in which such a point touches
  /// depends on the other part, so these stand for each other only within a quarter of a tile's size. May be
  /// empty.
  RepresentativePoints(const PointShell& shell, double tile_size_m,
                       std::span<const std::uint8_t> on_edge = {});

  /// False if no group has more than the two points that are reported of it: find() then reports the same
  /// contacts as queryContacts().
  [[nodiscard]] bool reducesContacts() const noexcept { return reduces_contacts_; }
  /// The group of a point; kNone if it belongs to none and is reported whenever it is near.
  [[nodiscard]] std::uint32_t groupOf(std::uint32_t id) const noexcept;
  static constexpr std::uint32_t kNone = UINT32_MAX;

  /// As queryContacts(), with fewer points; the reported contacts have the same bits. For each point left
  /// out, a reported point of the same group is as near now, to 1/16384 voxel, and a reported point is as
  /// near after the step (to first order), or less than kSame_m farther. Never throws, allocates or locks.
  QueryResult find(const VoxMap& map, const Pose& X_MP, const Request& request, ContactSet& out,
                   QueryMemory* memory = nullptr) noexcept;

  /// Gaps that differ by less are treated as equal [m]. assumed: well below what matters, above rounding
  static constexpr double kSame_m = 0.1e-6;

 private:
  /// Points of a tile with similar normals.
  struct Group {
    Vec3 center = Vec3::Zero();  ///< of its points, in P [m]
    Vec3 inward = Vec3::Zero();  ///< mean inward normal of its points, not of unit length
    Mat3 bend = Mat3::Zero();    ///< derivative of the normal with respect to position [1/m]
    double radius_m = 0;         ///< greatest distance of its points from the centre
  };
  struct Tile {
    std::uint32_t first_group = 0, group_count = 0;
  };
  static constexpr std::uint8_t kNoGroup = 255, kMixed = 255;
  struct Chosen {
    std::uint32_t leaf, id;
  };
  class Grouping;
  class Search;

  void addTile(std::size_t first_leaf, std::size_t end_leaf, double tile_size_m,
               std::span<const std::uint8_t> on_edge);
  void addLoose(std::size_t leaf);
  [[nodiscard]] Group fitted(std::span<const std::uint32_t> ids) const;

  const PointShell* shell_;
  std::vector<Tile> tiles_;
  std::vector<Group> groups_;
  std::vector<std::uint32_t> tile_of_leaf_;
  std::vector<std::uint8_t> group_of_;       ///< by point: in its tile, or kNoGroup
  std::vector<std::uint8_t> group_of_leaf_;  ///< that of all its points, or kMixed
  std::vector<Chosen> chosen_;               ///< with capacity for all points
  bool reduces_contacts_ = false;
};

}  // namespace vps::inline v0
