// SPDX-License-Identifier: BSD-3-Clause
// The tiles, groups and cells of RepresentativePoints.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

#include "vps/contact_tolerances.h"
#include "vps/representative_points.h"

namespace vps {
namespace {

constexpr double kEdgeShare = 0.25;  // share of a tile's size; assumed
// Regularisation (ridge regression) in fitted(), as a share of the trace of the points' second moment. It
// bounds Group::bend in directions in which the points do not spread. The recorded motion of a peg depends on
// this share
// (Replay.TheCommittedRecordingRunsAgainBitForBit).
constexpr double kRidge = 1e-3;

}  // namespace

/// Sorts the points of a tile into groups: each point joins the first group that takes it.
class RepresentativePoints::Grouping {
 public:
  Grouping(const PointShell& shell, double size_m, std::span<const std::uint8_t> on_edge)
      : shell_(shell), edge_size_m_(kEdgeShare * size_m), on_edge_(on_edge) {}

  std::uint8_t add(std::uint32_t id) {
    const bool is_edge = !on_edge_.empty() && on_edge_[id] != 0;
    for (std::size_t g = 0; g < members_.size(); ++g)
      if (takes(members_[g], id, is_edge)) return join(g, id);
    if (members_.size() == kNoGroup) return kNoGroup;
    members_.push_back({shell_.inward[id], is_edge, {}, {}});
    return join(members_.size() - 1, id);
  }
  [[nodiscard]] std::size_t size() const { return members_.size(); }
  [[nodiscard]] std::span<const std::uint32_t> ids(std::size_t g) const { return members_[g].ids; }
  [[nodiscard]] bool isEdge(std::size_t g) const { return members_[g].is_edge; }

 private:
  struct Members {
    Vec3 normal;
    bool is_edge;
    Box box;
    std::vector<std::uint32_t> ids;
  };

  [[nodiscard]] bool takes(const Members& group, std::uint32_t id, bool is_edge) const {
    if (group.is_edge != is_edge || group.normal.dot(shell_.inward[id]) < kCosSameFace) return false;
    if (!is_edge) return true;
    Box grown = group.box;
    grown.add(shell_.points[id]);
    return grown.size().norm() <= edge_size_m_;
  }
  std::uint8_t join(std::size_t g, std::uint32_t id) {
    members_[g].box.add(shell_.points[id]);
    members_[g].ids.push_back(id);
    return static_cast<std::uint8_t>(g);
  }

  const PointShell& shell_;
  const double edge_size_m_;
  std::span<const std::uint8_t> on_edge_;
  std::vector<Members> members_;
};

RepresentativePoints::RepresentativePoints(const PointShell& shell, double tile_size_m,
                                           std::span<const std::uint8_t> on_edge)
    : shell_(&shell),
      tile_of_leaf_(shell.leaf_blocks, kNone),
      group_of_(shell.size(), kNoGroup),
      group_of_leaf_(shell.leaf_blocks, kMixed) {
  if (!(tile_size_m > 0)) throw std::invalid_argument("RepresentativePoints: a tile's size must be positive");
  for (std::size_t leaf = 0; leaf < shell.leaf_blocks; ++leaf) {
    Area& area = area_of_leaf_.emplace_back();
    for (std::uint32_t lane = 0; lane < shell.blocks[leaf].count; ++lane)
      area.add(shell.blocks[leaf], static_cast<int>(lane));
  }
  surfaces_.reserve(shell.size());
  chosen_.reserve(4 * shell.size());  // a point may be listed as required, loose, and nearest twice
  // Nodes of the hierarchy keep their size when a shell is cropped, so that the tiles of the remaining points
  // are the same.
  std::size_t leaf = 0;
  for (std::size_t i = 0; i < shell.nodes.size();) {
    const ShellNode& node = shell.nodes[i];
    const std::size_t first = leaf;
    if (2 * node.radius_m <= tile_size_m) {
      while (leaf < shell.leaf_blocks && shell.blocks[leaf].first < node.first + node.count) ++leaf;
      addTile(first, leaf, tile_size_m, on_edge);
      i = node.skip;
    } else {
      if (node.is_leaf) addLoose(leaf++);
      ++i;
    }
  }
  addLevels(tile_size_m);
  of_groups_.reserve(groups_.size());
  of_cells_.reserve(groups_.size());
  areas_.reserve(groups_.size());
  place_of_cell_.resize(groups_.size());
}

// Adds a leaf that is larger than a tile may be: each of its points represents only itself.
void RepresentativePoints::addLoose(std::size_t leaf) {
  tile_of_leaf_[leaf] = static_cast<std::uint32_t>(tiles_.size());
  tiles_.push_back({static_cast<std::uint32_t>(groups_.size()), 0});
}

void RepresentativePoints::addTile(std::size_t first_leaf, std::size_t end_leaf, double tile_size_m,
                                   std::span<const std::uint8_t> on_edge) {
  Grouping grouping(*shell_, tile_size_m, on_edge);
  for (std::size_t leaf = first_leaf; leaf < end_leaf; ++leaf) {
    const ShellBlock& block = shell_->blocks[leaf];
    tile_of_leaf_[leaf] = static_cast<std::uint32_t>(tiles_.size());
    for (std::uint32_t id = block.first; id < block.first + block.count; ++id)
      group_of_[id] = grouping.add(id);
    const std::uint8_t first = group_of_[block.first];
    const auto begin = group_of_.begin() + block.first;
    if (std::all_of(begin, begin + block.count, [first](std::uint8_t g) { return g == first; }))
      group_of_leaf_[leaf] = first;
  }
  tiles_.push_back({static_cast<std::uint32_t>(groups_.size()), static_cast<std::uint32_t>(grouping.size())});
  for (std::size_t g = 0; g < grouping.size(); ++g) {
    groups_.push_back(fitted(grouping.ids(g)));
    groups_.back().is_edge = grouping.isEdge(g);
    reduces_contacts_ |= grouping.ids(g).size() > 2;
  }
}

RepresentativePoints::Group RepresentativePoints::fitted(std::span<const std::uint32_t> ids) const {
  Group group;
  const auto count = static_cast<double>(ids.size());
  for (const std::uint32_t id : ids) {
    group.center += shell_->points[id] / count;
    group.inward += shell_->inward[id] / count;
  }
  // Least squares for the derivative of the inward normal n by the position p: bend = sum(dn dp^T)
  // sum(dp dp^T)^-1. The points of a flat group do not determine the derivative along the group's normal. The
  // regularisation with kRidge makes this derivative zero.
  Mat3 places = Mat3::Zero(), turns = Mat3::Zero();
  for (const std::uint32_t id : ids) {
    const Vec3 dp = shell_->points[id] - group.center;
    places += dp * dp.transpose();
    turns += (shell_->inward[id] - group.inward) * dp.transpose();
    group.radius_m = std::max(group.radius_m, dp.norm());
  }
  if (const double size = places.trace(); size > 0)
    group.bend = turns * (places + kRidge * size * Mat3::Identity()).inverse();
  return group;
}

// Adds levels, each with cells of twice the size, until a cell is as large as the part.
void RepresentativePoints::addLevels(double tile_size_m) {
  Box box;
  for (const Group& group : groups_) box.add(group.center);
  const double most_m = groups_.empty() ? 0 : box.size().maxCoeff();
  for (double cell_m = tile_size_m; cell_m < 2 * most_m; cell_m *= 2) {
    Level& level = levels_.emplace_back();
    level.cell_m = cell_m;
    std::map<std::array<std::int64_t, 4>, std::uint32_t> cells;
    for (const Group& group : groups_) {
      const Vec3 at = (group.center - box.min) / cell_m;
      const std::array<std::int64_t, 4> key = {
          static_cast<std::int64_t>(at.x()), static_cast<std::int64_t>(at.y()),
          static_cast<std::int64_t>(at.z()), 2 * directionCell(group.inward) + (group.is_edge ? 1 : 0)};
      level.cell_of_group.push_back(
          cells.emplace(key, static_cast<std::uint32_t>(cells.size())).first->second);
    }
  }
}

}  // namespace vps
