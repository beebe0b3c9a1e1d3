// SPDX-License-Identifier: BSD-3-Clause
// How MeshDistance divides a mesh into nodes of eight boxes. buildHierarchy() makes binary trees; here the
// part that is largest is divided next until there are eight, so that queries compare a point with eight
// boxes at once.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "vps/bounding_volume_hierarchy.h"
#include "vps/mesh_distance.h"
#include "vps/stoppable.h"

namespace vps {
namespace {

using Range = std::span<std::uint32_t>;  // of triangles

double halfArea(const Box& box) {
  const Vec3 s = box.size();
  return s[0] * s[1] + s[1] * s[2] + s[2] * s[0];
}

void add(Box& box, const Box& other) {
  if (other.isEmpty()) return;
  box.add(other.min);
  box.add(other.max);
}

/// Divides ranges of triangles in two.
class Divider {
 public:
  /// The first part of a divided range has a multiple of `whole` triangles, the second takes the remainder.
  Divider(const std::vector<Box>& boxes, std::size_t whole) : boxes_(boxes), whole_(whole) {}

  [[nodiscard]] Box around(Range range) const {
    Box box;
    for (const std::uint32_t i : range) add(box, boxes_[i]);
    return box;
  }

  /// Divides a range of more than `whole` triangles along the longest side of the box around their centres.
  /// @param by_area  true: divides where the surface area heuristic says; false: at the median
  [[nodiscard]] std::pair<Range, Range> divided(Range range, bool by_area) const {
    Box centers;
    for (const std::uint32_t i : range) centers.add(boxes_[i].center());
    const int axis = longestAxis(centers);
    const std::size_t wished = by_area ? bestCount(range, axis, centers) : range.size() / 2;
    const std::size_t count =
        std::clamp((wished + whole_ / 2) / whole_ * whole_, whole_, (range.size() - 1) / whole_ * whole_);
    divideByKey(range, count, [&](std::uint32_t i) { return boxes_[i].min[axis] + boxes_[i].max[axis]; });
    return {range.first(count), range.subspan(count)};
  }

 private:
  struct Bin {
    Box box;
    std::size_t count = 0;

    void join(const Bin& other) {
      add(box, other.box);
      count += other.count;
    }
    [[nodiscard]] double cost() const { return count > 0 ? static_cast<double>(count) * halfArea(box) : 0; }
  };

  // How many triangles, in order along an axis, go to the first side so that the sum of count times area of
  // both boxes is least, tried at the borders of some bins. Source: Wald, On fast construction of SAH-based
  // bounding volume hierarchies, 2007.
  [[nodiscard]] std::size_t bestCount(Range range, int axis, const Box& centers) const {
    constexpr int kBins = 16;
    Bin bins[kBins];
    const double low = centers.min[axis], width = centers.size()[axis];
    if (!(width > 0)) return range.size() / 2;
    for (const std::uint32_t i : range) {
      const double fraction = (boxes_[i].center()[axis] - low) / width;
      Bin& bin = bins[std::clamp(static_cast<int>(fraction * kBins), 0, kBins - 1)];
      add(bin.box, boxes_[i]);
      ++bin.count;
    }
    double cost_above[kBins] = {};  // cost of the bins from k on
    Bin above;
    for (int k = kBins - 1; k > 0; --k) {
      above.join(bins[k]);
      cost_above[k] = above.cost();
    }
    Bin below;
    std::size_t best = range.size() / 2;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k + 1 < kBins; ++k) {
      below.join(bins[k]);
      const double cost = below.cost() + cost_above[k + 1];
      if (below.count == range.size() || !(cost < least)) continue;
      least = cost;
      best = below.count;
    }
    return best;
  }

  const std::vector<Box>& boxes_;
  std::size_t whole_;
};

}  // namespace

MeshDistance::Node::Node() {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  for (int k = 0; k < 3; ++k) {
    std::fill_n(min[k], kLanes, kFar);
    std::fill_n(max[k], kLanes, -kFar);
  }
}

void MeshDistance::Node::set(int lane, const Vec3& min_m, const Vec3& max_m, std::uint32_t to) {
  for (int k = 0; k < 3; ++k) {
    min[k][lane] = static_cast<float>(min_m[k]);
    max[k][lane] = static_cast<float>(max_m[k]);
  }
  child[lane] = to;
}

void MeshDistance::buildTree() {
  const auto count = static_cast<std::uint32_t>(mesh_.triangles.size());
  if (count == 0) return;
  const std::vector<Box> boxes = triangleBoxes(mesh_);
  Box all;
  for (const Box& box : boxes) add(all, box);
  center_ = all.center();
  // Boxes and points are rounded to floats relative to the centre: a point as far away as the mesh is large
  // has an error of 2^-24 of its distance, a corner of a box half that error.
  constexpr double kRounding = 2.5e-7;
  const double margin_m = kRounding * 0.5 * all.size().norm();
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);

  constexpr std::size_t kFull = kLanes;
  const Divider divider(boxes, kFull);
  struct Open {
    std::uint32_t node;
    Range range;
    int level;
  };
  std::vector<Open> open{{0, order, 0}};
  nodes_.reserve(count / 6 + 1);
  nodes_.emplace_back();
  StridedPoll poll;
  while (!open.empty()) {
    poll();
    const Open next = open.back();
    open.pop_back();
    int lane = 0;
    const auto setLane = [&](const Box& box, std::uint32_t to) {
      nodes_[next.node].set(lane++, (box.min - center_).array() - margin_m,
                            (box.max - center_).array() + margin_m, to);
    };
    if (next.range.size() <= kFull) {
      for (const std::uint32_t i : next.range) setLane(boxes[i], kTriangle | i);
      continue;
    }
    struct Part {
      Range range;
      Box box;
      double size;
    };
    const bool by_area = next.level < kLevelsByArea;
    const auto partOf = [&](Range range) {
      const Box box = divider.around(range);
      const double size = by_area ? halfArea(box) : static_cast<double>(range.size());
      return Part{range, box, range.size() > kFull ? size : -1};
    };
    std::vector<Part> parts{{next.range, {}, 1}};  // is divided in any case
    while (parts.size() < kFull) {
      const auto largest = std::max_element(parts.begin(), parts.end(),
                                            [](const Part& a, const Part& b) { return a.size < b.size; });
      if (largest->size < 0) break;
      const auto [a, b] = divider.divided(largest->range, by_area);
      *largest = partOf(a);
      parts.push_back(partOf(b));
    }
    for (const Part& part : parts) {
      const auto child = static_cast<std::uint32_t>(nodes_.size());
      nodes_.emplace_back();
      open.push_back({child, part.range, next.level + 1});
      setLane(part.box, child);
    }
  }
}

}  // namespace vps
