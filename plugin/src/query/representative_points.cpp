// SPDX-License-Identifier: BSD-3-Clause
#include "vps/representative_points.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "query/coherent_walk.h"
#include "query/contact_collector.h"

namespace vps::inline v0 {
namespace {

constexpr double kCosSameNormal = 0.94;  // 20 degrees, as PointShellSettings::edge_angle_rad

/// The leaf's first normal if all its normals are within 20 degrees of it; zero otherwise.
Vec3 commonNormal(const PointShell& shell, const ShellBlock& leaf) {
  const Vec3& normal = shell.inward[leaf.first];
  for (std::uint32_t id = leaf.first + 1; id < leaf.first + leaf.count; ++id)
    if (normal.dot(shell.inward[id]) < kCosSameNormal) return Vec3::Zero();
  return normal;
}

/// A tile to which leaves are added while they fit.
class TileGrowth {
 public:
  TileGrowth(const PointShell& shell, double size_m) : shell_(shell), size_m_(size_m) {}

  [[nodiscard]] bool takes(const ShellBlock& leaf, const Vec3& normal) {
    Box grown = box_;
    for (std::uint32_t id = leaf.first; id < leaf.first + leaf.count; ++id) grown.add(shell_.points[id]);
    if (count_ > 0 && (normal.dot(normal_) < kCosSameNormal || grown.size().norm() > size_m_)) return false;
    if (count_ == 0) normal_ = normal;
    box_ = grown;
    ++count_;
    return true;
  }

 private:
  const PointShell& shell_;
  const double size_m_;
  Box box_;
  Vec3 normal_ = Vec3::Zero();
  int count_ = 0;
};

}  // namespace

RepresentativePoints::RepresentativePoints(const PointShell& shell, double tile_size_m)
    : shell_(&shell), tile_of_leaf_(shell.leaf_blocks, kNone) {
  if (!(tile_size_m > 0)) throw std::invalid_argument("RepresentativePoints: a tile's size must be positive");
  chosen_.reserve(shell.size());
  for (std::size_t leaf = 0; leaf < shell.leaf_blocks;) {
    const std::size_t first = leaf;
    TileGrowth tile(shell, tile_size_m);
    for (; leaf < shell.leaf_blocks; ++leaf) {
      const Vec3 normal = commonNormal(shell, shell.blocks[leaf]);
      if (normal.isZero(0) || !tile.takes(shell.blocks[leaf], normal)) break;
    }
    if (leaf == first)
      ++leaf;  // a leaf at an edge belongs to no tile
    else
      addTile(first, leaf);
    reduces_contacts_ |= leaf - first > 1;
  }
}

void RepresentativePoints::addTile(std::size_t first_leaf, std::size_t end_leaf) {
  const auto tile_index = static_cast<std::uint32_t>(tiles_.size());
  std::fill(tile_of_leaf_.begin() + static_cast<std::ptrdiff_t>(first_leaf),
            tile_of_leaf_.begin() + static_cast<std::ptrdiff_t>(end_leaf), tile_index);
  const std::uint32_t first = shell_->blocks[first_leaf].first;
  const ShellBlock& last = shell_->blocks[end_leaf - 1];
  const std::uint32_t end = last.first + last.count;
  Tile tile;
  for (std::uint32_t id = first; id < end; ++id) {
    tile.center += shell_->points[id] / (end - first);
    tile.inward += shell_->inward[id] / (end - first);
  }
  // Least squares: bend = sum(dn dp^T) sum(dp dp^T)^-1. A flat tile does not determine the derivative along
  // its own normal; the ridge makes it zero.
  Mat3 places = Mat3::Zero(), turns = Mat3::Zero();
  for (std::uint32_t id = first; id < end; ++id) {
    const Vec3 dp = shell_->points[id] - tile.center;
    places += dp * dp.transpose();
    turns += (shell_->inward[id] - tile.inward) * dp.transpose();
    tile.radius_m = std::max(tile.radius_m, dp.norm());
  }
  constexpr double kRidge = 1e-3;
  if (const double size = places.trace(); size > 0)
    tile.bend = turns * (places + kRidge * size * Mat3::Identity()).inverse();
  tiles_.push_back(tile);
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
    takeRequired(leaf);
    const std::uint32_t tile = self_.tile_of_leaf_[leaf.index];
    if (tile == kNone) return takeAll(leaf);
    if (tile != tile_) {
      finish();
      begin(tile);
    }
    updateNow(leaf);
    if (has_slope_) updateThen(leaf);
  }

  /// After the last leaf.
  void finish() noexcept {
    if (tile_ == kNone) return;
    add(now_);
    if (has_slope_) add(then_);
    tile_ = kNone;
  }

  [[nodiscard]] float least() const noexcept { return least_; }
  [[nodiscard]] std::size_t near() const noexcept { return near_; }

 private:
  struct Best {
    float value = std::numeric_limits<float>::infinity();
    Chosen point{kNone, kNone};
  };

  void begin(std::uint32_t index) noexcept {
    tile_ = index;
    now_ = then_ = {};
    const Tile& tile = self_.tiles_[index];
    const Vec3 slope =
        tile.bend.transpose() * (shift_P_ + turn_P_.cross(tile.center)) + tile.inward.cross(turn_P_);
    const double length = slope.norm();
    has_slope_ = length * tile.radius_m > kSame_m;
    slope_ = (slope / quantum_m_).cast<float>();
    steepest_ = static_cast<float>(length / quantum_m_);
  }

  void updateNow(const ReadLeaf& leaf) noexcept {
    if (!(leaf.least() < now_.value)) return;
    std::uint32_t lane = 0;
    while (leaf.value(static_cast<int>(lane)) != leaf.least()) ++lane;
    now_ = {leaf.least(), {leaf.index, leaf.block.first + lane}};
  }

  /// Compares gaps at the end of the step; the part that the whole tile has in common is left out.
  void updateThen(const ReadLeaf& leaf) noexcept {
    const Vec3& center = self_.tiles_[tile_].center;
    const ShellBlock& block = leaf.block;
    float at_center = 0;
    for (int k = 0; k < 3; ++k) at_center += slope_[k] * static_cast<float>(block.center[k] - center[k]);
    if (leaf.least() + at_center - steepest_ * static_cast<float>(block.radius_m) >= then_.value) return;
    // Unused lanes repeat the first.
    float then[kLanes];
    for (int i = 0; i < kLanes; ++i) {
      const float now = leaf.value(i);
      const float to =
          now + at_center + slope_[0] * block.x[i] + slope_[1] * block.y[i] + slope_[2] * block.z[i];
      then[i] = now <= cutoff_ ? to : std::numeric_limits<float>::infinity();
    }
    const float least = *std::min_element(then, then + kLanes);
    if (!(least < then_.value)) return;
    const auto lane = static_cast<std::uint32_t>(std::find(then, then + kLanes, least) - then);
    then_ = {least, {leaf.index, block.first + lane}};
  }

  void takeAll(const ReadLeaf& leaf) noexcept {
    for (std::uint32_t lane = 0; lane < leaf.block.count; ++lane)
      if (leaf.value(static_cast<int>(lane)) <= cutoff_) add({0, {leaf.index, leaf.block.first + lane}});
  }

  void takeRequired(const ReadLeaf& leaf) noexcept {
    const std::uint32_t first = leaf.block.first, end = first + leaf.block.count;
    while (!required_.empty() && required_.front() < first) required_ = required_.subspan(1);
    for (; !required_.empty() && required_.front() < end; required_ = required_.subspan(1))
      if (leaf.value(static_cast<int>(required_.front() - first)) <= cutoff_)
        add({0, {leaf.index, required_.front()}});
  }

  /// Ids arrive nearly in order, some of them twice.
  void add(const Best& best) noexcept {
    if (best.point.id == kNone) return;
    auto& chosen = self_.chosen_;
    auto at = chosen.end();
    while (at != chosen.begin() && std::prev(at)->id > best.point.id) --at;
    if (at != chosen.begin() && std::prev(at)->id == best.point.id) return;
    chosen.insert(at, best.point);  // there is capacity for every point
  }

  RepresentativePoints& self_;
  const double quantum_m_;
  const float cutoff_;
  const Vec3 turn_P_, shift_P_;  ///< the step, about P's origin, in P
  std::span<const std::uint32_t> required_;
  std::uint32_t tile_ = kNone;
  Best now_, then_;
  bool has_slope_ = false;
  Eigen::Vector3f slope_ = Eigen::Vector3f::Zero();  ///< of the change of the gap in the step [quanta/m]
  float steepest_ = 0;
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
