// SPDX-License-Identifier: BSD-3-Clause
#include "vps/representative_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "query/coherent_walk.h"
#include "query/contact_collector.h"

namespace vps::inline v0 {
namespace {

constexpr double kCosSameNormal = 0.94;  // 20 degrees, as PointShellSettings::edge_angle_rad

constexpr std::size_t kMostGroups = 254;  // of a tile
constexpr double kEdgeShare = 0.25;       // of a tile's size. assumed

}  // namespace

/// Sorts the points of a tile into groups: each joins the first that takes it.
class RepresentativePoints::Grouping {
 public:
  Grouping(const PointShell& shell, double size_m, std::span<const std::uint8_t> on_edge)
      : shell_(shell), edge_size_m_(kEdgeShare * size_m), on_edge_(on_edge) {}

  std::uint8_t add(std::uint32_t id) {
    const bool is_edge = !on_edge_.empty() && on_edge_[id] != 0;
    for (std::size_t g = 0; g < members_.size(); ++g)
      if (takes(members_[g], id, is_edge)) return join(g, id);
    if (members_.size() == kMostGroups) return kNoGroup;
    members_.push_back({shell_.inward[id], is_edge, {}, {}});
    return join(members_.size() - 1, id);
  }
  [[nodiscard]] std::size_t size() const { return members_.size(); }
  [[nodiscard]] std::span<const std::uint32_t> ids(std::size_t g) const { return members_[g].ids; }

 private:
  struct Members {
    Vec3 normal;
    bool is_edge;
    Box box;
    std::vector<std::uint32_t> ids;
  };

  [[nodiscard]] bool takes(const Members& group, std::uint32_t id, bool is_edge) const {
    if (group.is_edge != is_edge || group.normal.dot(shell_.inward[id]) < kCosSameNormal) return false;
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
  chosen_.reserve(2 * shell.size() + 2 * kMostGroups);  // a tile's may be there twice until sorted
  // Nodes of the hierarchy keep their size when a shell is cropped, so that the tiles of what is left are the
  // same.
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
}

// A leaf that is larger than a tile may be: its points stand for themselves.
void RepresentativePoints::addLoose(std::size_t leaf) {
  tile_of_leaf_[leaf] = static_cast<std::uint32_t>(tiles_.size());
  tiles_.push_back({static_cast<std::uint32_t>(groups_.size()), 0});
}

std::uint32_t RepresentativePoints::groupOf(std::uint32_t id) const noexcept {
  if (group_of_[id] == kNoGroup) return kNone;
  const auto leaf = std::partition_point(
      shell_->blocks.begin(), shell_->blocks.begin() + static_cast<std::ptrdiff_t>(shell_->leaf_blocks),
      [id](const ShellBlock& block) { return block.first + block.count <= id; });
  const auto index = static_cast<std::size_t>(leaf - shell_->blocks.begin());
  return tiles_[tile_of_leaf_[index]].first_group + group_of_[id];
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
  // Least squares: bend = sum(dn dp^T) sum(dp dp^T)^-1. A flat group does not determine the derivative along
  // its own normal; the ridge makes it zero.
  Mat3 places = Mat3::Zero(), turns = Mat3::Zero();
  for (const std::uint32_t id : ids) {
    const Vec3 dp = shell_->points[id] - group.center;
    places += dp * dp.transpose();
    turns += (shell_->inward[id] - group.inward) * dp.transpose();
    group.radius_m = std::max(group.radius_m, dp.norm());
  }
  constexpr double kRidge = 1e-3;
  if (const double size = places.trace(); size > 0)
    group.bend = turns * (places + kRidge * size * Mat3::Identity()).inverse();
  return group;
}

/// One walk over the near leaves.
class RepresentativePoints::Search {
 public:
  Search(RepresentativePoints& self, const Reading& reading, const Pose& X_MP, const Request& request,
         double cutoff_m) noexcept
      : self_(self),
        quantum_m_(reading.field.quantum_m),
        cutoff_(static_cast<float>(cutoff_m / quantum_m_)),
        turn_P_(X_MP.R.transpose() * request.step_M.w),
        shift_P_(X_MP.R.transpose() * (request.step_M.v + request.step_M.w.cross(X_MP.p))),
        required_(request.required) {
    self_.chosen_.clear();
  }

  void take(const ReadLeaf& leaf) noexcept {
    least_ = std::min(least_, leaf.least());
    if (!(leaf.least() <= cutoff_)) return;
    near_ += leaf.block.count;
    if (const std::uint32_t tile = self_.tile_of_leaf_[leaf.index]; tile != tile_) {
      finish();
      begin(tile);
    }
    takeRequired(leaf);
    const std::uint8_t group = self_.group_of_leaf_[leaf.index];
    if (group == kMixed) return takeMixed(leaf);
    updateNow(leaf, best_[group]);
    if (best_[group].has_slope) updateThen(leaf, best_[group]);
  }

  /// After the last leaf.
  void finish() noexcept {
    if (tile_ == kNone) return;
    auto& chosen = self_.chosen_;
    for (std::size_t g = 0; g < self_.tiles_[tile_].group_count; ++g)
      for (const Best* best : {&best_[g].now, &best_[g].then})
        if (best->point.id != kNone) chosen.push_back(best->point);
    const auto first = chosen.begin() + static_cast<std::ptrdiff_t>(first_chosen_);
    std::sort(first, chosen.end(), [](const Chosen& a, const Chosen& b) { return a.id < b.id; });
    chosen.erase(
        std::unique(first, chosen.end(), [](const Chosen& a, const Chosen& b) { return a.id == b.id; }),
        chosen.end());
    tile_ = kNone;
  }

  [[nodiscard]] float least() const noexcept { return least_; }
  [[nodiscard]] std::size_t near() const noexcept { return near_; }

 private:
  struct Best {
    float value = std::numeric_limits<float>::infinity();
    Chosen point{kNone, kNone};
  };

  /// The nearest points of a group, now and after the step.
  struct GroupBest {
    Best now, then;
    bool has_slope = false;
    Vec3 center;
    Eigen::Vector3f slope;  ///< of the change of the gap in the step [quanta/m]
    float steepest = 0;
  };

  void begin(std::uint32_t index) noexcept {
    tile_ = index;
    first_chosen_ = self_.chosen_.size();
    const Tile& tile = self_.tiles_[index];
    for (std::size_t g = 0; g < tile.group_count; ++g) {
      const Group& group = self_.groups_[tile.first_group + g];
      GroupBest& best = best_[g];
      const Vec3 slope =
          group.bend.transpose() * (shift_P_ + turn_P_.cross(group.center)) + group.inward.cross(turn_P_);
      const double length = slope.norm();
      best.now = best.then = {};
      best.has_slope = length * group.radius_m > kSame_m;
      best.center = group.center;
      best.slope = (slope / quantum_m_).cast<float>();
      best.steepest = static_cast<float>(length / quantum_m_);
    }
  }

  static void updateNow(const ReadLeaf& leaf, GroupBest& best) noexcept {
    if (!(leaf.least() < best.now.value)) return;
    std::uint32_t lane = 0;
    while (leaf.value(static_cast<int>(lane)) != leaf.least()) ++lane;
    best.now = {leaf.least(), {leaf.index, leaf.block.first + lane}};
  }

  static float slopeAt(const GroupBest& best, const ShellBlock& block) noexcept {
    float at = 0;
    for (int k = 0; k < 3; ++k) at += best.slope[k] * static_cast<float>(block.center[k] - best.center[k]);
    return at;
  }

  /// Compares gaps at the end of the step; the part that the whole group has in common is left out.
  void updateThen(const ReadLeaf& leaf, GroupBest& best) const noexcept {
    const ShellBlock& block = leaf.block;
    const float at_center = slopeAt(best, block);
    if (leaf.least() + at_center - best.steepest * static_cast<float>(block.radius_m) >= best.then.value)
      return;
    // Unused lanes repeat the first.
    float then[kLanes];
    for (int i = 0; i < kLanes; ++i) {
      const float now = leaf.value(i);
      const float to = now + at_center + best.slope[0] * block.x[i] + best.slope[1] * block.y[i] +
                       best.slope[2] * block.z[i];
      then[i] = now <= cutoff_ ? to : std::numeric_limits<float>::infinity();
    }
    const float least = *std::min_element(then, then + kLanes);
    if (!(least < best.then.value)) return;
    const auto lane = static_cast<std::uint32_t>(std::find(then, then + kLanes, least) - then);
    best.then = {least, {leaf.index, block.first + lane}};
  }

  void takeMixed(const ReadLeaf& leaf) noexcept {
    const ShellBlock& block = leaf.block;
    std::uint8_t last = kNoGroup;
    float at_center = 0;
    for (std::uint32_t lane = 0; lane < block.count; ++lane) {
      const auto i = static_cast<int>(lane);
      const float now = leaf.value(i);
      if (!(now <= cutoff_)) continue;
      const std::uint8_t group = self_.group_of_[block.first + lane];
      const Chosen point{leaf.index, block.first + lane};
      if (group == kNoGroup) {
        self_.chosen_.push_back(point);
        continue;
      }
      GroupBest& best = best_[group];
      if (now < best.now.value) best.now = {now, point};
      if (!best.has_slope) continue;
      if (std::exchange(last, group) != group) at_center = slopeAt(best, block);
      const float then = now + at_center + best.slope[0] * block.x[i] + best.slope[1] * block.y[i] +
                         best.slope[2] * block.z[i];
      if (then < best.then.value) best.then = {then, point};
    }
  }

  void takeRequired(const ReadLeaf& leaf) noexcept {
    const std::uint32_t first = leaf.block.first, end = first + leaf.block.count;
    while (!required_.empty() && required_.front() < first) required_ = required_.subspan(1);
    for (; !required_.empty() && required_.front() < end; required_ = required_.subspan(1))
      if (leaf.value(static_cast<int>(required_.front() - first)) <= cutoff_)
        self_.chosen_.push_back({leaf.index, required_.front()});
  }

  RepresentativePoints& self_;
  const double quantum_m_;
  const float cutoff_;
  const Vec3 turn_P_, shift_P_;  ///< the step, about P's origin, in P
  std::span<const std::uint32_t> required_;
  std::uint32_t tile_ = kNone;
  std::size_t first_chosen_ = 0;  ///< of the tile
  GroupBest best_[kMostGroups];   ///< of the tile
  float least_ = std::numeric_limits<float>::infinity();
  std::size_t near_ = 0;
};

QueryResult RepresentativePoints::find(const VoxMap& map, const Pose& X_MP, const Request& request,
                                       ContactSet& out, QueryMemory* memory) noexcept {
  const QueryOptions& options = request.options;
  if (!X_MP.isFinite() || !reduces_contacts_) return queryContacts(map, *shell_, X_MP, options, out, memory);
  out.contacts.clear();
  out.left_out = 0;
  QueryResult result;
  const Reading reading(map, *shell_, X_MP, options.simd);
  const double cutoff_m = usedCutoff(map, options.cutoff_m);
  Search search(*this, reading, X_MP, request, cutoff_m);
  const double least_skipped =
      readNearLeaves(reading, X_MP, options, cutoff_m, memoryFor(memory, map, *shell_), result.points_tested,
                     [&](const ReadLeaf& leaf) { search.take(leaf); });
  if (search.near() <= request.full_count) return queryContacts(map, *shell_, X_MP, options, out, memory);
  search.finish();

  // The chosen points are in few leaves, which are read again: a batch keeps its readings only until the
  // next.
  ContactCollector collector(map, reading, X_MP, options, cutoff_m, out);
  auto next = chosen_.begin();
  const auto takeChosen = [&](const ReadLeaf& leaf) {
    const std::uint32_t first = leaf.block.first;
    for (; next != chosen_.end() && next->id < first + leaf.block.count; ++next) {
      constexpr std::ptrdiff_t kAhead = 16;  // assumed; chosen points are too sparse to be in the cache
      if (chosen_.end() - next > kAhead) {
        __builtin_prefetch(&shell_->points[next[kAhead].id]);
        __builtin_prefetch(&shell_->area_m2[next[kAhead].id]);
      }
      collector.add(leaf, static_cast<int>(next->id - first));
    }
  };
  LeafReader<decltype(takeChosen)> reader(reading, takeChosen);
  std::uint32_t last = kNone;
  for (const Chosen& point : chosen_)
    if (std::exchange(last, point.leaf) != point.leaf) reader.add(point.leaf);
  reader.flush();
  collector.finish();
  if (out.left_out > 0) result.status = Status::Truncated;
  setDistance(map, reading, search.least(), least_skipped, result);
  return result;
}

}  // namespace vps::inline v0
