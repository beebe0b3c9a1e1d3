// SPDX-License-Identifier: BSD-3-Clause
#include "vps/representative_points.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "query/points/coherent_walk.h"
#include "query/points/contact_collector.h"

namespace vps {

std::uint32_t RepresentativePoints::groupOf(std::uint32_t id) const noexcept {
  if (group_of_[id] == kNoGroup) return kNone;
  const auto leaf = std::partition_point(
      shell_->blocks.begin(), shell_->blocks.begin() + static_cast<std::ptrdiff_t>(shell_->leaf_blocks),
      [id](const ShellBlock& block) { return block.first + block.count <= id; });
  const auto index = static_cast<std::size_t>(leaf - shell_->blocks.begin());
  return tiles_[tile_of_leaf_[index]].first_group + group_of_[id];
}

/// One walk over the near leaves.
class RepresentativePoints::Search {
 public:
  Search(RepresentativePoints& self, const MapReading& reading, const Pose& X_MP, const Request& request,
         double cutoff_m) noexcept
      : self_(self),
        quantum_m_(reading.field.quantum_m),
        cutoff_(static_cast<float>(cutoff_m / quantum_m_)),
        turn_P_(X_MP.R.transpose() * request.step_M.w),
        shift_P_(X_MP.R.transpose() * (request.step_M.v + request.step_M.w.cross(X_MP.p))),
        required_(request.required) {
    self_.chosen_.clear();
    self_.of_groups_.clear();
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
    // A leaf whose points were read one by one comes in as many pieces.
    if (leaf.block.count == self_.shell_->blocks[leaf.index].count)
      best_[group].area.add(self_.area_of_leaf_[leaf.index]);
    else
      best_[group].area.add(leaf.block, 0);
    updateNow(leaf, best_[group]);
    if (best_[group].has_slope) updateThen(leaf, best_[group]);
  }

  /// Call after the last leaf.
  void finish() noexcept {
    if (tile_ == kNone) return;
    const Tile& tile = self_.tiles_[tile_];
    for (std::uint32_t g = 0; g < tile.group_count; ++g) {
      const GroupBest& best = best_[g];
      if (best.now.point.id == kNone) continue;
      Nearest nearest{tile.first_group + g, best.now, best.has_slope ? best.then : best.now, best.area};
      nearest.then.value += best.common;
      self_.of_groups_.push_back(nearest);
    }
    tile_ = kNone;
  }

  [[nodiscard]] float least() const noexcept { return least_; }
  [[nodiscard]] std::size_t near() const noexcept { return near_; }

 private:
  /// The nearest points of a group, now and after the step.
  struct GroupBest {
    Best now, then;    ///< `then` does not include `common`
    float common = 0;  ///< change of the gap at the group's centre in the step
    Area area;
    bool has_slope = false;
    Vec3 center;
    Eigen::Vector3f slope;  ///< gradient, by position, of the gap's change in the step [quanta/m]
    float steepest = 0;
  };

  void begin(std::uint32_t index) noexcept {
    tile_ = index;
    const Tile& tile = self_.tiles_[index];
    for (std::size_t g = 0; g < tile.group_count; ++g) {
      const Group& group = self_.groups_[tile.first_group + g];
      GroupBest& best = best_[g];
      const Vec3 way = shift_P_ + turn_P_.cross(group.center);
      const Vec3 slope = group.bend.transpose() * way + group.inward.cross(turn_P_);
      const double length = slope.norm();
      best.now = best.then = {};
      best.area = {};
      best.common = static_cast<float>(group.inward.dot(way) / quantum_m_);
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

  /// Compares gaps at the end of the step, without the change that all points of the group have in common.
  void updateThen(const ReadLeaf& leaf, GroupBest& best) const noexcept {
    const ShellBlock& block = leaf.block;
    const float at_center = slopeAt(best, block);
    if (leaf.least() + at_center - best.steepest * static_cast<float>(block.radius_m) >= best.then.value)
      return;
    // Unused lanes repeat the first lane.
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
      best.area.add(block, i);
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
  GroupBest best_[kNoGroup];  ///< by group of the tile
  float least_ = std::numeric_limits<float>::infinity();
  std::size_t near_ = 0;
};

void RepresentativePoints::choose(std::span<const Nearest> nearest) noexcept {
  for (const Nearest& n : nearest) {
    chosen_.push_back(n.now.point);
    chosen_.back().area = static_cast<std::uint32_t>(areas_.size());
    areas_.push_back(n.area);
    if (n.then.point.id != n.now.point.id) chosen_.push_back(n.then.point);
  }
}

void RepresentativePoints::mergeTo(const Level& level) noexcept {
  of_cells_.clear();
  for (const Nearest& n : of_groups_) {
    const std::uint32_t cell = level.cell_of_group[n.of];
    const std::uint32_t place = place_of_cell_[cell];
    if (place < of_cells_.size() && of_cells_[place].of == cell) {
      of_cells_[place].take(n);
      continue;
    }
    place_of_cell_[cell] = static_cast<std::uint32_t>(of_cells_.size());
    of_cells_.push_back(n);
    of_cells_.back().of = cell;
  }
}

// Adds the nearest points of the groups or, if there are too many groups, of the smallest cells of which
// there are few enough.
void RepresentativePoints::merge(const Request& request) noexcept {
  if (request.most_groups > 0 && of_groups_.size() > request.most_groups)
    for (const Level& level : levels_) {
      if (level.cell_m > request.most_cell_m) break;
      mergeTo(level);
      merged_to_m_ = level.cell_m;
      if (of_cells_.size() <= request.most_groups) break;
    }
  choose(merged_to_m_ > 0 ? of_cells_ : of_groups_);
  // Of two entries for a point, the entry with an area comes first.
  std::sort(chosen_.begin(), chosen_.end(),
            [](const Chosen& a, const Chosen& b) { return a.id != b.id ? a.id < b.id : a.area < b.area; });
  const auto isSame = [](const Chosen& a, const Chosen& b) { return a.id == b.id; };
  chosen_.erase(std::unique(chosen_.begin(), chosen_.end(), isSame), chosen_.end());
}

// The surface that a point represents. A point that is reported only because it is required represents none,
// since the nearest point of its group represents it.
RepresentativePoints::Surface RepresentativePoints::surfaceOf(const Chosen& chosen) const noexcept {
  if (chosen.area == kNone) {
    const double own_m2 = group_of_[chosen.id] == kNoGroup ? shell_->area_m2[chosen.id] : 0;
    return {own_m2, shell_->points[chosen.id], Mat3::Zero()};
  }
  const Area& area = areas_[chosen.area];
  if (!(area.size > 0)) return {0, shell_->points[chosen.id], Mat3::Zero()};
  const Vec3 center = area.first / area.size;
  return {area.size, center, area.second / area.size - center * center.transpose()};
}

QueryResult RepresentativePoints::find(const VoxMap& map, const Pose& X_MP, const Request& request,
                                       ContactSet& out, QueryMemory* memory) noexcept {
  const QueryOptions& options = request.options;
  merged_to_m_ = 0;
  surfaces_.clear();
  areas_.clear();
  if (!X_MP.isFinite() || !reduces_contacts_) return queryContacts(map, *shell_, X_MP, options, out, memory);
  out.contacts.clear();
  out.left_out = 0;
  QueryResult result;
  const MapReading reading(map, *shell_, X_MP, options.simd);
  const double cutoff_m = usedCutoff(map, options.cutoff_m);
  Search search(*this, reading, X_MP, request, cutoff_m);
  const double least_skipped =
      readNearLeaves(reading, X_MP, options, cutoff_m, memoryFor(memory, map, *shell_), result.points_tested,
                     [&](const ReadLeaf& leaf) { search.take(leaf); });
  if (search.near() <= request.full_count) return queryContacts(map, *shell_, X_MP, options, out, memory);
  search.finish();
  merge(request);

  // The chosen points are in few leaves, which are read again, because a batch keeps its
  // readings only until the next batch.
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
  if (out.left_out > 0)
    result.status = Status::Truncated;
  else
    for (const Chosen& c : chosen_) surfaces_.push_back(surfaceOf(c));
  setDistance(map, reading, search.least(), least_skipped, result);
  return result;
}

}  // namespace vps
