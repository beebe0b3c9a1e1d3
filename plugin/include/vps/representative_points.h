// SPDX-License-Identifier: BSD-3-Clause
// Reduces a contact of very many points to representative points, for solvers of rigid contact.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "vps/export.h"
#include "vps/query.h"

namespace vps {

/// Classifies directions, so that contacts that face different ways are kept apart: the cell of a direction
/// among 6 x 2 x 2 cells of a cube's surface: below 24.
inline std::uint32_t directionCell(const Vec3& n) {
  int axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  return static_cast<std::uint32_t>(((axis * 2 + (n[axis] > 0)) * 2 + (n[u] > 0)) * 2 + (n[v] > 0));
}

/// Divides a shell into tiles (nodes of its hierarchy up to a given size) and the points of each tile into
/// groups whose normals agree within 20 degrees. find() reports for each group the point that is nearest to
/// the map now and the point that will be nearest after a given step. The change of the gap within a group is
/// taken to first order: the group's inward normals are a linear function of position, fitted once.
///
/// find() reads the same points as queryContacts(), but computes normals for, and reports, only a few of each
/// thousand: with 153,000 near points it takes a fifth of the time.
class VPS_API RepresentativePoints {
 public:
  struct Request {
    QueryOptions options;  ///< as for queryContacts()
    Twist step_M;  ///< displacement of the shell's part against the map in the step, about M's origin, in M
                   ///< [rad, m]
    std::span<const std::uint32_t> required;  ///< ids, ascending, of points that are always reported if near
    /// If there are at most this many near points (counted in leaves of sixteen), all are reported, as by
    /// queryContacts().
    std::size_t full_count = 0;
    /// If there are more groups than this, groups whose centres and mean normals lie in the same cell are
    /// merged; the cell size is doubled until few enough groups remain or most_cell_m is reached. 0: groups
    /// are never merged.
    std::size_t most_groups = 0;
    double most_cell_m = 0;
  };

  /// The shell must outlive this object and not change. O(points); about 200 bytes for each group and 2 for
  /// each point. Throws std::invalid_argument if the size is not positive.
  /// @param on_edge  by point: nonzero for points on sharp edges. The plane in which such a point touches
  /// depends on the other part, so such points represent each other only within a quarter of a tile's size.
  /// May be empty.
  RepresentativePoints(const PointShell& shell, double tile_size_m,
                       std::span<const std::uint8_t> on_edge = {});

  /// False if every group has at most the two points that are reported of it: find() then reports the same
  /// contacts as queryContacts().
  [[nodiscard]] bool reducesContacts() const noexcept { return reduces_contacts_; }
  /// The group of a point; kNone if the point belongs to no group and is reported whenever it is near.
  [[nodiscard]] std::uint32_t groupOf(std::uint32_t id) const noexcept;
  static constexpr std::uint32_t kNone = UINT32_MAX;

  /// As queryContacts(), with fewer points; the reported contacts have the same bits. For each point left
  /// out, a reported point of the same group is as near now, to 1/16384 voxel, and a reported point is as
  /// near after the step (to first order), or less than kSame_m farther. If groups were merged, the reported
  /// point is of the same cell and not always of the same group. Never throws, allocates or locks.
  QueryResult find(const VoxMap& map, const Pose& X_MP, const Request& request, ContactSet& out,
                   QueryMemory* memory = nullptr) noexcept;

  /// A piece of the surface.
  struct Surface {
    double area_m2 = 0;
    Vec3 center = Vec3::Zero();  ///< in P [m]
    Mat3 spread = Mat3::Zero();  ///< mean of d d', d a point's place from the centre [m2]
  };
  /// The near surface that each contact of the last find() represents, accurate to a leaf of sixteen points
  /// at its border. Empty if each contact represents only itself.
  [[nodiscard]] std::span<const Surface> surfaces() const noexcept { return surfaces_; }

  /// Size of the cells in which the last find() merged groups; 0 if it merged none.
  [[nodiscard]] double mergedTo_m() const noexcept { return merged_to_m_; }

  /// Gaps that differ by less than this are treated as equal [m]. Assumed: far below any gap that matters,
  /// above rounding.
  static constexpr double kSame_m = 0.1e-6;

 private:
  /// Points of a tile with similar normals.
  struct Group {
    Vec3 center = Vec3::Zero();  ///< of its points, in P [m]
    Vec3 inward = Vec3::Zero();  ///< mean inward normal of its points, not of unit length
    Mat3 bend = Mat3::Zero();    ///< derivative of the normal with respect to position [1/m]
    double radius_m = 0;         ///< greatest distance of its points from the centre
    bool is_edge = false;        ///< its points are on sharp edges
  };
  /// A grid of cells, by position in P, direction of the normal, and whether the points are on an edge.
  struct Level {
    double cell_m = 0;
    std::vector<std::uint32_t> cell_of_group;
  };
  struct Tile {
    std::uint32_t first_group = 0, group_count = 0;
  };
  static constexpr std::uint8_t kNoGroup = 255, kMixed = 255;
  /// Surface of near points: its size, and its first and second moments about P's origin.
  struct Area {
    double size = 0;
    Vec3 first = Vec3::Zero();
    Mat3 second = Mat3::Zero();
    void add(const ShellBlock& leaf, int lane) noexcept {
      const Vec3 at(leaf.center[0] + leaf.x[lane], leaf.center[1] + leaf.y[lane],
                    leaf.center[2] + leaf.z[lane]);
      const double area_m2 = leaf.weight[lane];
      size += area_m2;
      first += area_m2 * at;
      second += area_m2 * at * at.transpose();
    }
    void add(const Area& other) noexcept {
      size += other.size;
      first += other.first;
      second += other.second;
    }
  };
  struct Chosen {
    std::uint32_t leaf, id;
    std::uint32_t area = kNone;  ///< index in areas_
  };
  struct Best {
    float value = std::numeric_limits<float>::infinity();  ///< [quanta]
    Chosen point{kNone, kNone};
  };
  /// The nearest points of a group, or of a cell of groups, now and after the step.
  struct Nearest {
    std::uint32_t of = kNone;
    Best now, then;
    Area area;
    void take(const Nearest& other) noexcept {
      area.add(other.area);
      if (other.now.value < now.value) now = other.now;
      if (other.then.value < then.value) then = other.then;
    }
  };
  class Grouping;
  class Search;

  [[nodiscard]] Surface surfaceOf(const Chosen& chosen) const noexcept;
  void addTile(std::size_t first_leaf, std::size_t end_leaf, double tile_size_m,
               std::span<const std::uint8_t> on_edge);
  void addLoose(std::size_t leaf);
  void addLevels(double tile_size_m);
  void merge(const Request& request) noexcept;
  void mergeTo(const Level& level) noexcept;
  void choose(std::span<const Nearest> nearest) noexcept;
  [[nodiscard]] Group fitted(std::span<const std::uint32_t> ids) const;

  const PointShell* shell_;
  std::vector<Tile> tiles_;
  std::vector<Group> groups_;
  std::vector<std::uint32_t> tile_of_leaf_;
  std::vector<Area> area_of_leaf_;
  std::vector<std::uint8_t> group_of_;       ///< by point: index of its group in its tile, or kNoGroup
  std::vector<std::uint8_t> group_of_leaf_;  ///< group of all points of the leaf, or kMixed
  std::vector<Level> levels_;                ///< in ascending size
  // Results of a find(), with capacity for all points or groups:
  std::vector<Chosen> chosen_;
  std::vector<Area> areas_;
  std::vector<Surface> surfaces_;
  std::vector<Nearest> of_groups_, of_cells_;
  std::vector<std::uint32_t> place_of_cell_;  ///< index in of_cells_
  double merged_to_m_ = 0;
  bool reduces_contacts_ = false;
};

}  // namespace vps
