// SPDX-License-Identifier: BSD-3-Clause
#include "voxelise/winding_signs.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "voxelise/brick_assembly.h"
#include "voxmap/field_bounds.h"
#include "vps/stoppable.h"

namespace vps {
namespace {

/// A winding number that differs from 0.5 by more than this is certain, and may be passed to neighbours.
constexpr double kCertainMargin = 0.25;
/// The margin is limited to this: crossing a facet inside the solid, which distances do not show, changes the
/// winding number from 2 to 1.
constexpr double kMaxMargin = 0.5;

/// Tells which nodes and cells may be inside. The directory's rim, a band or more from the surface's box, is
/// outside, so all space beyond it reads as outside.
class Within {
 public:
  Within(const Interior& interior, double voxel_m) : interior_(interior), voxel_m_(voxel_m) {}
  [[nodiscard]] bool holds(const Index3& node) const {
    return interior_.mayHold(voxel_m_ * node.cast<double>());
  }
  [[nodiscard]] bool holdsAllOf(const Index3& cell) const {
    return holds(kBrick * cell) && holds(kBrick * (cell + Index3::Ones()));
  }
  [[nodiscard]] bool holdsNoneOf(const Index3& cell) const {
    const Vec3 low = voxel_m_ * (kBrick * cell).cast<double>();
    const Vec3 high = voxel_m_ * (kBrick * (cell + Index3::Ones())).cast<double>();
    const Box& box = interior_.box();
    return (low.array() >= box.max.array()).any() || (high.array() <= box.min.array()).any();
  }

 private:
  const Interior& interior_;
  double voxel_m_;
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

/// A sign that a signed node passes on, and the rest of its margin; a margin below 0 means no sign.
struct Passed {
  int sign = 1;
  double margin = -1;
};

/// The sign that a node takes from one of its up to 26 neighbours: the surface cannot pass between two nodes
/// if the sum of their distances exceeds the distance between them.
/// @param lossAt  returns the loss of margin per voxel around a node
template <typename Loss>
Passed passedAcross(int node, const NodeValue* nodes, const std::array<int, kBrickNodes>& size,
                    const std::array<float, kBrickNodes>& margin, double voxel_quanta, const Loss& lossAt) {
  // Lengths of offsets, rounded up.
  constexpr std::array<double, 4> kLength = {0, 1, 1.4142135623731, 1.7320508075689};
  const Index3 at = nodeAt(node), low = (at.array() - 1).max(0), high = (at.array() + 1).min(kNodes - 1);
  Passed best;
  for (int x = low.x(); x <= high.x(); ++x)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int z = low.z(); z <= high.z(); ++z) {
        const int other = nodeIndex(x, y, z);
        if (!(margin[other] >= 0) || size[other] == 0) continue;  // zero has no sign
        const double length = kLength[(Index3(x, y, z) - at).cwiseAbs().sum()];
        // Distances are rounded by half a quantum each.
        if (!(size[node] + size[other] > length * voxel_quanta * (1 + 1e-5) + 1)) continue;
        // The doubt about the winding number from which a sign spread is subtracted again, to be safe.
        const double left = margin[other] - lossAt(other) * length - Interior::kDoubt;
        if (left > best.margin) best = {nodes[other] < 0 ? -1 : 1, left};
      }
  return best;
}

}  // namespace

WindingSigner::Count WindingSigner::signBrick(NodeValue* nodes, const Index3& low, double voxel_m,
                                              double quantum_m) const {
  Box box;
  box.add(voxel_m * low.cast<double>());
  box.add(voxel_m * (low + Index3::Constant(kBrick)).cast<double>());
  const double loss = interior_.slope().bound(box) * voxel_m;  // loss of margin per step, bound for the brick
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
  // Near a border, with one bound for the whole brick, each of its nodes would need a winding number of its
  // own.
  constexpr double kSmallLoss = 0.005;  // per step, from a margin of 0.25; a brick has sixteen steps
  std::array<float, kBrickNodes> loss_of;
  if (loss > kSmallLoss) loss_of.fill(-1);
  const auto lossAt = [&](int i) {
    if (!(loss > kSmallLoss)) return loss;
    if (loss_of[i] < 0) {
      const Vec3 p = voxel_m * (low + nodeAt(i)).cast<double>();
      const Box around = {p.array() - voxel_m, p.array() + voxel_m};
      loss_of[i] = static_cast<float>(interior_.slope().bound(around) * voxel_m * (1 + 1e-6));
    }
    return static_cast<double>(loss_of[i]);
  };
  // Signs a node, and all nodes to which it can pass its sign along the axes.
  const auto spread = [&](int from, int sign, double margin_there, double doubt) {
    margin[from] = static_cast<float>(margin_there);
    int end = 0;
    queue[end++] = static_cast<std::int16_t>(from);
    for (int next = 0; next < end; ++next) {
      const int i = queue[next];
      const double left = margin[i] - lossAt(i) - (i == from ? doubt : 0);
      // On the surface itself both signs are right, and the winding number does not decide.
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
  };
  // The first pass signs the nodes from which a sign spreads. Nodes next to the surface follow; most take
  // their sign across a diagonal, because next to an oblique surface no neighbour along an axis is far
  // enough.
  for (const bool is_first : {true, false})
    for (int seed = 0; seed < kBrickNodes; ++seed) {
      if (margin[seed] >= 0 || (is_first && !(2 * size[seed] > step))) continue;
      if (size[seed] == 0) {  // on the surface, no sign; a face along the grid has 81 such nodes in a brick
        margin[seed] = 0;
        ++count.certain;
        continue;
      }
      if (!is_first) {
        const Passed passed = passedAcross(seed, nodes, size, margin, voxel_m / quantum_m, lossAt);
        if (passed.margin > kCertainMargin) {
          spread(seed, passed.sign, passed.margin, 0);
          continue;
        }
      }
      const double w = interior_.windingNumber(voxel_m * (low + nodeAt(seed)).cast<double>());
      spread(seed, w > 0.5 ? -1 : 1, std::min(std::abs(w - 0.5), kMaxMargin), Interior::kDoubt);
    }
  return count;
}

namespace {

/// Makes nodes of a brick positive that cannot be inside.
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
  const Within within(interior_, voxel_m);
  onAllCores(cells.size(), [&](std::size_t i) {
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

std::vector<std::size_t> WindingSigner::cutCells(const VoxLayout& layout, double voxel_m,
                                                 const std::vector<std::uint8_t>& is_uncertain) const {
  // A corner has the index of the cell above it.
  const CellBox corners = {layout.low, layout.size + Index3::Ones()};
  const auto cornerOf = [&](std::size_t cell, int corner) {
    return corners.cellIndex(layout.cellAt(cell) + Index3(corner >> 2, corner >> 1 & 1, corner & 1));
  };
  enum : std::uint8_t { Skipped, Pending, Out, In };
  std::vector<std::uint8_t> side(corners.cellCount(), Skipped);
  for (std::size_t i = 0; i < is_uncertain.size(); ++i)
    for (int k = 0; k < 8 && is_uncertain[i] != 0; ++k) side[cornerOf(i, k)] = Pending;
  const Within within(interior_, voxel_m);
  onAllCores(side.size(), [&](std::size_t i) {
    if (side[i] != Pending) return;
    const Index3 node = kBrick * corners.cellAt(i);
    side[i] = within.holds(node) && interior_.windingNumber(voxel_m * node.cast<double>()) > 0.5 ? In : Out;
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
  if (interior_.slope().isZero()) return;
  const double cell_m = kBrick * voxel_m;
  const auto boxOf = [&](std::size_t i) {
    const Vec3 low = cell_m * layout.cellAt(i).cast<double>();
    return Box{low, low + Vec3::Constant(cell_m)};
  };
  std::vector<float> loss(layout.bricks.size()), margin(layout.bricks.size(), -1);
  onAllCores(layout.bricks.size(), [&](std::size_t i) {
    if (isConstant(layout.bricks[i]))
      loss[i] = static_cast<float>(std::min(1.0, interior_.slope().bound(boxOf(i)) * cell_m));
  });
  std::vector<std::size_t> queue;
  for (std::size_t seed = 0; seed < layout.bricks.size(); ++seed) {
    if (!isConstant(layout.bricks[seed]) || margin[seed] >= 0) continue;
    const double w = interior_.windingNumber(boxOf(seed).center());
    const std::uint32_t brick = w > 0.5 ? kInside : kOutside;
    margin[seed] = static_cast<float>(std::min(std::abs(w - 0.5), kMaxMargin));
    queue.assign(1, seed);
    for (std::size_t next = 0; next < queue.size(); ++next) {
      const std::size_t i = queue[next];
      layout.bricks[i] = brick;
      forEachNeighbour(layout.cellAt(i) - layout.low, layout.size, [&](const Index3& at) {
        const std::size_t j = layout.cellIndex(layout.low + at);
        // Empty cells are adjacent, and the surface is at least a band away from both.
        const float left =
            margin[i] - std::max(loss[i], loss[j]) - (i == seed ? float{Interior::kDoubt} : 0.0f);
        if (!isConstant(layout.bricks[j]) || margin[j] >= 0 || !(left > float{kCertainMargin})) return;
        margin[j] = left;
        queue.push_back(j);
      });
    }
  }

  const Within within(interior_, voxel_m);
  std::vector<std::uint8_t> is_uncertain(layout.bricks.size());
  for (std::size_t i = 0; i < is_uncertain.size(); ++i) {
    if (!isConstant(layout.bricks[i])) continue;
    if (within.holdsNoneOf(layout.cellAt(i))) {
      layout.bricks[i] = kOutside;
      continue;
    }
    // 0.87 is half a cell's diagonal, the distance from its centre to its corners. If passing the centre's
    // value to the corners uses up the margin, corners may disagree.
    is_uncertain[i] =
        margin[i] < 0.87f * loss[i] + float{Interior::kDoubt} || !within.holdsAllOf(layout.cellAt(i));
  }
  const std::vector<std::size_t> cut = cutCells(layout, voxel_m, is_uncertain);
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

/// True if any of `count` pairs of neighbours in the band have opposite signs and distances whose sum exceeds
/// a step. A mask of 0 leaves a pair out. Uses 16 bits and no branches, so that compilers vectorise it.
bool hasJump(const NodeValue* a, const NodeValue* b, int count, std::uint16_t step,
             const std::uint16_t* mask) {
  using U16 = std::uint16_t;
  U16 seen = 0;
  for (int i = 0; i < count; ++i) {
    const U16 size_a = static_cast<U16>(a[i] < 0 ? -a[i] : a[i]),
              size_b = static_cast<U16>(b[i] < 0 ? -b[i] : b[i]);
    const U16 apart = static_cast<U16>(size_a + size_b);  // at most 65534
    const U16 opposite = static_cast<U16>(a[i] ^ b[i]);   // the highest bit is set if the signs are opposite
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
  onAllCores(cells.size(), [&](std::size_t i) {
    // Beyond the band signs are only copied from neighbours.
    if (hasJump(layout.nodesOf(cells[i]), step)) agree.store(false, std::memory_order_relaxed);
  });
  return agree;
}

}  // namespace vps
