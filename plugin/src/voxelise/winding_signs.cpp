// SPDX-License-Identifier: BSD-3-Clause
#include "voxelise/winding_signs.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>

#include "mesh/mesh_edges.h"
#include "voxelise/brick_assembly.h"
#include "voxmap/node_steps.h"

namespace vps::inline v0 {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
/// A winding number this far from 0.5 is certain, and may be passed to neighbours.
constexpr double kCertainMargin = 0.25;
/// Subtracted from the margin before a value is passed on: many times the clusters' measured error.
constexpr double kDoubt = 0.02;
/// Values are limited to this distance from 0.5: crossing a facet inside the solid, which distances do not
/// show, changes the winding number from 2 to 1.
constexpr double kMaxMargin = 0.5;

double boxGap2(const Box& a, const Box& b) {
  return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0.0).squaredNorm();
}

/// Nodes that may be inside. Nothing is inside at a band or more from the box of the surface, whatever the
/// winding number: walls that face the wrong way raise it above 0.5 far from the part. So the directory's
/// rim, whose outermost nodes are that far, is outside, and with it everything beyond, which reads as the
/// rim.
class Within {
 public:
  Within(const VoxLayout& layout, double voxel_m, double quantum_m) {
    const Box& box = layout.parts.front().bounds;
    const double band_m = kFullBand * quantum_m;
    // Computed like the directory: a cell is eight voxels, so that both are rounded alike.
    low_ = ((box.min.array() - band_m) / voxel_m).floor().cast<int>();
    high_ = ((box.max.array() + band_m) / voxel_m).ceil().cast<int>();
  }
  [[nodiscard]] bool holds(const Index3& node) const {
    return (node.array() > low_.array()).all() && (node.array() < high_.array()).all();
  }
  [[nodiscard]] bool holdsAllOf(const Index3& cell) const {
    return holds(kBrick * cell) && holds(kBrick * (cell + Index3::Ones()));
  }
  [[nodiscard]] bool holdsNoneOf(const Index3& cell) const {
    return (kBrick * cell.array() >= high_.array()).any() ||
           (kBrick * (cell.array() + 1) <= low_.array()).any();
  }

 private:
  Index3 low_, high_;
};

/// Calls visit(other) for the up to six neighbours of a node among size^3 nodes.
template <typename Visit>
void forEachNeighbour(const Index3& at, const Index3& size, Visit visit) {
  for (int axis = 0; axis < 3; ++axis)
    for (const int step : {-1, 1}) {
      const Index3 other = at + step * Index3::Unit(axis);
      if (other[axis] >= 0 && other[axis] < size[axis]) visit(other);
    }
}

}  // namespace

WindingSlope::WindingSlope(const Mesh& mesh) {
  forEachEdge(sortedHalfEdges(mesh), [&](std::span<const HalfEdge> same) {
    int net = 0;
    for (const HalfEdge& e : same) net += e.is_forward ? 1 : -1;
    if (net == 0) return;
    const Vec3 &a = mesh.vertices[same[0].low], &b = mesh.vertices[same[0].high];
    Box box;
    box.add(a);
    box.add(b);
    edges_.emplace_back(box, std::abs(net) * (b - a).norm());
  });
  if (edges_.empty()) return;
  constexpr std::uint32_t kLeafEdges = 4;
  nodes_.emplace_back().count = static_cast<std::uint32_t>(edges_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const std::uint32_t first = nodes_[n].first, size = nodes_[n].count, half = size / 2;
    Box box;
    double length_m = 0;
    for (std::uint32_t i = first; i < first + size; ++i) {
      box.add(edges_[i].first.min);
      box.add(edges_[i].first.max);
      length_m += edges_[i].second;
    }
    nodes_[n].box = box;
    nodes_[n].length_m = length_m;
    if (size <= kLeafEdges) continue;
    int axis = 0;
    box.size().maxCoeff(&axis);
    const auto range = edges_.begin() + first;
    std::stable_sort(range, range + size, [&](const auto& a, const auto& b) {
      return a.first.min[axis] + a.first.max[axis] < b.first.min[axis] + b.first.max[axis];
    });
    nodes_[n].first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[n].count = 0;
    nodes_.push_back({{}, 0, first, half});
    nodes_.push_back({{}, 0, first + half, size - half});
  }
}

double WindingSlope::bound(const Box& box) const noexcept {
  if (nodes_.empty()) return 0;
  double sum = 0;
  std::uint32_t stack[64];  // halving by count: 32 levels at most, one waiting child each
  int waiting = 0;
  stack[waiting++] = 0;
  while (waiting > 0) {
    const Node& node = nodes_[stack[--waiting]];
    const double gap2 = boxGap2(node.box, box);
    if (gap2 > 4 * node.box.size().squaredNorm()) {
      sum += node.length_m / gap2;
    } else if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const double edge_gap2 = boxGap2(edges_[i].first, box);
        if (!(edge_gap2 > 0)) return kInfinite;
        sum += edges_[i].second / edge_gap2;
      }
    } else {
      stack[waiting++] = node.first + 1;
      stack[waiting++] = node.first;
    }
  }
  return sum / (4 * std::numbers::pi);
}

WindingSigner::Count WindingSigner::signBrick(NodeValue* nodes, const Index3& low, double voxel_m,
                                              double quantum_m) const {
  Box box;
  box.add(voxel_m * low.cast<double>());
  box.add(voxel_m * (low + Index3::Constant(kBrick)).cast<double>());
  const double loss = slope_.bound(box) * voxel_m;  // of margin, per step
  Count count;
  std::array<int, kBrickNodes> size;
  std::array<float, kBrickNodes> margin;
  for (int i = 0; i < kBrickNodes; ++i) {
    size[i] = std::abs(int{nodes[i]});
    margin[i] = -1;
    count.nodes += size[i] < kFullBand;
  }
  // Distances are rounded by half a quantum each.
  const double step = voxel_m / quantum_m * (1 + 1e-5) + 1;
  std::array<std::int16_t, kBrickNodes> queue;
  for (int seed = 0; seed < kBrickNodes; ++seed) {
    if (margin[seed] >= 0) continue;
    const double w = winding_.at(voxel_m * (low + nodeAt(seed)).cast<double>()).w;
    const int sign = w > 0.5 ? -1 : 1;
    margin[seed] = static_cast<float>(std::min(std::abs(w - 0.5), kMaxMargin));
    int end = 0;
    queue[end++] = static_cast<std::int16_t>(seed);
    for (int next = 0; next < end; ++next) {
      const int i = queue[next];
      const double left = margin[i] - loss - (i == seed ? kDoubt : 0);
      // On the surface itself both signs are right, and the winding number leaves it open.
      count.certain += size[i] < kFullBand && (margin[i] > kCertainMargin || size[i] <= 1);
      nodes[i] = static_cast<NodeValue>(sign * size[i]);
      if (!(left > kCertainMargin)) continue;
      forEachNeighbour(nodeAt(i), Index3::Constant(kNodes), [&](const Index3& other) {
        const int j = nodeIndex(other.x(), other.y(), other.z());
        if (margin[j] >= 0 || !(size[i] + size[j] > step)) return;
        margin[j] = static_cast<float>(left);
        queue[end++] = static_cast<std::int16_t>(j);
      });
    }
  }
  return count;
}

namespace {

/// Sets those nodes of a brick outside that cannot be inside.
void clip(NodeValue* nodes, const Index3& cell, const Within& within) {
  if (within.holdsAllOf(cell)) return;
  for (int i = 0; i < kBrickNodes; ++i) {
    if (!within.holds(kBrick * cell + nodeAt(i))) nodes[i] = static_cast<NodeValue>(std::abs(int{nodes[i]}));
  }
}

std::vector<std::size_t> cellsWithBricks(const VoxLayout& layout) {
  std::vector<std::size_t> cells;
  for (std::size_t i = 0; i < layout.bricks.size(); ++i)
    if (!isConstant(layout.bricks[i])) cells.push_back(i);
  return cells;
}

}  // namespace

void WindingSigner::signBricks(VoxLayout& layout, double voxel_m, double quantum_m) {
  signCells(layout, cellsWithBricks(layout), voxel_m, quantum_m);
}

void WindingSigner::signCells(VoxLayout& layout, const std::vector<std::size_t>& cells, double voxel_m,
                              double quantum_m) {
  std::atomic<std::size_t> nodes = 0, certain = 0;
  std::atomic<int> steepest = 0;
  const Within within(layout, voxel_m, quantum_m);
  tbb::parallel_for(std::size_t{0}, cells.size(), [&](std::size_t i) {
    NodeValue* of_brick = layout.pool->nodes(layout.bricks[cells[i]]);
    const Count count = signBrick(of_brick, kBrick * layout.cellAt(cells[i]), voxel_m, quantum_m);
    clip(of_brick, layout.cellAt(cells[i]), within);
    nodes += count.nodes;
    certain += count.certain;
    const int most = mostAlongAxes(of_brick);
    for (int seen = steepest; most > seen && !steepest.compare_exchange_weak(seen, most);) {
    }
  });
  count_.nodes += nodes;
  count_.certain += certain;
  layout.steepest = std::max(layout.steepest, steepnessOf(steepest, voxel_m, quantum_m));
  layout.is_metric = layout.steepest <= 1;
}

std::vector<std::size_t> WindingSigner::cutCells(const VoxLayout& layout, double voxel_m, double quantum_m,
                                                 const std::vector<std::uint8_t>& is_uncertain) const {
  const CellBox corners = {layout.low, layout.size + Index3::Ones()};  // each by the cell above it
  const auto cornerOf = [&](std::size_t cell, int corner) {
    return corners.cellIndex(layout.cellAt(cell) + Index3(corner >> 2, corner >> 1 & 1, corner & 1));
  };
  enum : std::uint8_t { Skipped, Pending, Out, In };
  std::vector<std::uint8_t> side(corners.cellCount(), Skipped);
  for (std::size_t i = 0; i < is_uncertain.size(); ++i)
    for (int k = 0; k < 8 && is_uncertain[i] != 0; ++k) side[cornerOf(i, k)] = Pending;
  const Within within(layout, voxel_m, quantum_m);
  tbb::parallel_for(std::size_t{0}, side.size(), [&](std::size_t i) {
    if (side[i] != Pending) return;
    const Index3 node = kBrick * corners.cellAt(i);
    side[i] = within.holds(node) && winding_.at(voxel_m * node.cast<double>()).w > 0.5 ? In : Out;
  });
  std::vector<std::size_t> cut;
  for (std::size_t i = 0; i < is_uncertain.size(); ++i) {
    if (is_uncertain[i] == 0) continue;
    const std::uint8_t center = layout.bricks[i] == kInside ? In : Out;
    for (int k = 0; k < 8; ++k) {
      if (side[cornerOf(i, k)] == center) continue;
      cut.push_back(i);
      break;
    }
  }
  return cut;
}

void WindingSigner::signEmptyCells(VoxLayout& layout, double voxel_m, double quantum_m) {
  if (slope_.isZero()) return;
  const double cell_m = kBrick * voxel_m;
  const auto boxOf = [&](std::size_t i) {
    const Vec3 low = cell_m * layout.cellAt(i).cast<double>();
    return Box{low, low + Vec3::Constant(cell_m)};
  };
  std::vector<float> loss(layout.bricks.size()), margin(layout.bricks.size(), -1);
  tbb::parallel_for(std::size_t{0}, layout.bricks.size(), [&](std::size_t i) {
    if (isConstant(layout.bricks[i]))
      loss[i] = static_cast<float>(std::min(1.0, slope_.bound(boxOf(i)) * cell_m));
  });
  std::vector<std::size_t> queue;
  for (std::size_t seed = 0; seed < layout.bricks.size(); ++seed) {
    if (!isConstant(layout.bricks[seed]) || margin[seed] >= 0) continue;
    const double w = winding_.at(boxOf(seed).center()).w;
    const std::uint32_t brick = w > 0.5 ? kInside : kOutside;
    margin[seed] = static_cast<float>(std::min(std::abs(w - 0.5), kMaxMargin));
    queue.assign(1, seed);
    for (std::size_t next = 0; next < queue.size(); ++next) {
      const std::size_t i = queue[next];
      layout.bricks[i] = brick;
      forEachNeighbour(layout.cellAt(i) - layout.low, layout.size, [&](const Index3& at) {
        const std::size_t j = layout.cellIndex(layout.low + at);
        // Empty cells are adjacent, and the surface is at least a band away from both.
        const float left = margin[i] - std::max(loss[i], loss[j]) - (i == seed ? float{kDoubt} : 0.0f);
        if (!isConstant(layout.bricks[j]) || margin[j] >= 0 || !(left > float{kCertainMargin})) return;
        margin[j] = left;
        queue.push_back(j);
      });
    }
  }

  const Within within(layout, voxel_m, quantum_m);
  std::vector<std::uint8_t> is_uncertain(layout.bricks.size());
  for (std::size_t i = 0; i < is_uncertain.size(); ++i) {
    if (!isConstant(layout.bricks[i])) continue;
    if (within.holdsNoneOf(layout.cellAt(i))) {
      layout.bricks[i] = kOutside;
      continue;
    }
    // The distance from a cell's centre to its corners: half its diagonal. Where passing values on ends,
    // corners may disagree.
    is_uncertain[i] = margin[i] < 0.87f * loss[i] + float{kDoubt} || !within.holdsAllOf(layout.cellAt(i));
  }
  const std::vector<std::size_t> cut = cutCells(layout, voxel_m, quantum_m, is_uncertain);
  if (cut.empty()) return;
  std::uint32_t brick = takeBricks(layout, cut.size());
  for (const std::size_t cell : cut) {
    std::fill_n(layout.pool->nodes(brick), kBrickNodes, NodeValue{kFullBand});
    std::fill_n(layout.pool->nodes(brick) + kBrickNodes, kBrickStride - kBrickNodes, NodeValue{0});
    layout.bricks[cell] = brick;
    brick += kBrickStride;
  }
  signCells(layout, cut, voxel_m, quantum_m);
}

double WindingSigner::certainShare() const noexcept {
  return count_.nodes == 0 ? 1 : static_cast<double>(count_.certain) / static_cast<double>(count_.nodes);
}

namespace {

/// True if any of `count` pairs of neighbours in the band have opposite signs and are more than a step apart
/// in sum; a mask of 0 leaves a pair out. In 16 bits and without branches, so that it is vectorised.
bool hasJump(const NodeValue* a, const NodeValue* b, int count, std::uint16_t step,
             const std::uint16_t* mask) {
  using U16 = std::uint16_t;
  U16 seen = 0;
  for (int i = 0; i < count; ++i) {
    const U16 size_a = static_cast<U16>(a[i] < 0 ? -a[i] : a[i]),
              size_b = static_cast<U16>(b[i] < 0 ? -b[i] : b[i]);
    const U16 apart = static_cast<U16>(size_a + size_b);  // at most 65534
    const U16 opposite = static_cast<U16>(a[i] ^ b[i]);   // in its highest bit
    const U16 far = apart > step ? 0x8000 : 0;
    const U16 in_band = (size_a > size_b ? size_a : size_b) < kFullBand ? 0x8000 : 0;
    seen |= static_cast<U16>(opposite & far & in_band & mask[i]);
  }
  return seen != 0;
}

bool hasJump(const NodeValue* nodes, std::uint16_t step) {
  constexpr int kPlane = kNodes * kNodes;
  using Mask = std::array<std::uint16_t, kBrickNodes>;
  // Pairs across the end of a row or a plane do not count.
  static constexpr auto kHasNext = [] {
    std::array<Mask, 3> mask = {};
    for (int i = 0; i < kBrickNodes; ++i) {
      mask[0][i] = 0xffff;
      mask[1][i] = i / kNodes % kNodes < kNodes - 1 ? 0xffff : 0;
      mask[2][i] = i % kNodes < kNodes - 1 ? 0xffff : 0;
    }
    return mask;
  }();
  constexpr std::array<int, 3> kStride = {kPlane, kNodes, 1};
  bool found = false;
  for (std::size_t k = 0; k < 3; ++k)
    found |= hasJump(nodes, nodes + kStride[k], kBrickNodes - kStride[k], step, kHasNext[k].data());
  return found;
}

}  // namespace

bool signsAgree(const VoxLayout& layout, double voxel_m, double quantum_m) {
  const auto step =
      static_cast<std::uint16_t>(voxel_m / quantum_m * (1 + 1e-4) + 2);  // below 2^15: h < band / 3
  const std::vector<std::size_t> cells = cellsWithBricks(layout);
  std::atomic<bool> agree = true;
  tbb::parallel_for(std::size_t{0}, cells.size(), [&](std::size_t i) {
    // Beyond the band signs are only copied from neighbours.
    if (hasJump(layout.nodesOf(cells[i]), step)) agree.store(false, std::memory_order_relaxed);
  });
  return agree;
}

}  // namespace vps::inline v0
