// SPDX-License-Identifier: BSD-3-Clause
// Assemblies of cubes that an exhaustive search takes apart, as ground truth for planning.
#pragma once

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include "vps/mesh.h"

namespace vps::test {

using Cell = std::array<int, 3>;

inline Cell operator+(const Cell& a, const Cell& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

/// All six steps from a cell to its neighbours.
inline std::array<Cell, 6> unitSteps() {
  return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};
}

/// Parts that share no cell. Translations by whole cells cover all motions without rotation: the free
/// positions of cubes in a grid are a union of closed cubes, faces and edges of this grid, and every path in
/// this union can be moved onto the edges.
class VoxelPuzzle {
 public:
  explicit VoxelPuzzle(std::vector<std::set<Cell>> parts) : parts_(std::move(parts)) {}

  [[nodiscard]] const std::vector<std::set<Cell>>& parts() const { return parts_; }

  /// The part's surface, with each face moved inwards, so that the parts have clearance.
  [[nodiscard]] Mesh mesh(std::size_t part, double cell_m, double inwards_m) const;

  /// Whether two hands can take the assembly apart: some parts, moved together along any path, leave the
  /// others, and both groups come apart in the same way. It does not matter in which order groups leave,
  /// since parts that are away do not obstruct others.
  [[nodiscard]] bool comesApart() const {
    std::vector<std::size_t> all(parts_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return comesApart(all);
  }

 private:
  [[nodiscard]] bool comesApart(const std::vector<std::size_t>& members) const {
    if (members.size() == 1) return true;
    // The first part stays, since it does not matter which of two groups moves.
    for (std::uint32_t subset = 1; subset < 1U << (members.size() - 1); ++subset) {
      std::vector<std::size_t> moved, held{members.front()};
      for (std::size_t i = 1; i < members.size(); ++i)
        ((subset >> (i - 1) & 1U) != 0 ? moved : held).push_back(members[i]);
      if (leave(moved, held)) return comesApart(moved) && comesApart(held);
    }
    return false;
  }

  [[nodiscard]] std::set<Cell> cellsOf(const std::vector<std::size_t>& members) const {
    std::set<Cell> cells;
    for (const std::size_t part : members) cells.insert(parts_[part].begin(), parts_[part].end());
    return cells;
  }

  /// Breadth-first search over all positions.
  [[nodiscard]] bool leave(const std::vector<std::size_t>& members,
                           const std::vector<std::size_t>& others) const {
    const std::set<Cell> moving = cellsOf(members), held = cellsOf(others);
    const auto isFree = [&](const Cell& moved) {
      return std::ranges::none_of(moving, [&](const Cell& cell) { return held.contains(cell + moved); });
    };
    std::set<Cell> seen{{0, 0, 0}};
    std::deque<Cell> waiting{{0, 0, 0}};
    while (!waiting.empty()) {
      const Cell at = waiting.front();
      waiting.pop_front();
      if (std::ranges::any_of(at, [](int x) { return std::abs(x) > kFar; })) return true;
      for (const Cell& step : unitSteps())
        if (const Cell next = at + step; !seen.contains(next) && isFree(next)) {
          seen.insert(next);
          waiting.push_back(next);
        }
    }
    return false;
  }

  static constexpr int kFar = 8;  ///< a distance in cells that is greater than any puzzle
  std::vector<std::set<Cell>> parts_;
};

inline Mesh VoxelPuzzle::mesh(std::size_t part, double cell_m, double inwards_m) const {
  const std::set<Cell>& own = parts_[part];
  // Each cell is divided into three along each axis, of which the outer ones are as wide as the faces move;
  // `fine` are the cells that remain.
  std::set<Cell> fine;
  for (const Cell& cell : own)
    for (int i = 0; i < 27; ++i) {
      const Cell side = {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
      bool is_inside = true;
      for (int around = 1; around < 8; ++around)
        is_inside &= own.contains(
            cell + Cell{side[0] * (around & 1), side[1] * (around >> 1 & 1), side[2] * (around >> 2)});
      if (is_inside)
        fine.insert({3 * cell[0] + side[0] + 1, 3 * cell[1] + side[1] + 1, 3 * cell[2] + side[2] + 1});
    }
  Mesh mesh;
  std::map<Cell, std::uint32_t> known;
  const auto vertex = [&](const Cell& corner) {
    const auto [at, is_new] = known.try_emplace(corner, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) {
      const std::array<double, 3> within_m = {0, inwards_m, cell_m - inwards_m};
      Vec3 p;
      for (int axis = 0; axis < 3; ++axis) {
        const int k = corner[static_cast<std::size_t>(axis)] + 3 * kFar;  // not negative
        p[axis] = cell_m * (k / 3 - kFar) + within_m[static_cast<std::size_t>(k % 3)];
      }
      mesh.vertices.push_back(p);
    }
    return at->second;
  };
  for (const Cell& cell : fine)
    for (const Cell& step : unitSteps()) {
      if (fine.contains(cell + step)) continue;
      const auto axis =
          static_cast<std::size_t>(std::ranges::find_if(step, [](int x) { return x != 0; }) - step.begin());
      const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      std::array<std::uint32_t, 4> quad{};
      for (std::size_t i = 0; i < 4; ++i) {
        Cell corner = cell;
        corner[axis] += step[axis] > 0;
        corner[u] += i == 1 || i == 2;
        corner[v] += i >= 2;
        quad[i] = vertex(corner);
      }
      if (step[axis] < 0) std::swap(quad[1], quad[3]);
      mesh.triangles.push_back({quad[0], quad[1], quad[2]});
      mesh.triangles.push_back({quad[0], quad[2], quad[3]});
    }
  return mesh;
}

/// A cube of `size` cells along each axis, divided by parts that grow from random cells. Parts may or may not
/// interlock.
inline VoxelPuzzle randomCube(int size, std::size_t parts, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::set<Cell>> grown(parts);
  std::set<Cell> free;
  for (int x = 0; x < size; ++x)
    for (int y = 0; y < size; ++y)
      for (int z = 0; z < size; ++z) free.insert({x, y, z});
  const auto drawn = [&](const std::vector<Cell>& from) { return from[random() % from.size()]; };
  for (std::set<Cell>& part : grown) {
    const Cell cell = drawn({free.begin(), free.end()});
    part.insert(cell);
    free.erase(cell);
  }
  while (!free.empty())
    for (std::set<Cell>& part : grown) {
      std::vector<Cell> next;
      for (const Cell& cell : part)
        for (const Cell& step : unitSteps())
          if (free.contains(cell + step)) next.push_back(cell + step);
      if (next.empty()) continue;
      const Cell cell = drawn(next);
      part.insert(cell);
      free.erase(cell);
    }
  return VoxelPuzzle(std::move(grown));
}

/// A chain in which each link slides in the jaw of the next link, in a direction across that of the joint
/// before, and is blocked by arms of the link after the next. All links but the last can therefore leave the
/// last one only together, then all but the last two, and so on.
///
///      from the side, along the slot        from above
///              jaw of the next                arms of the link after it
///              +---+---+                     ==============
///              |   head|                      jaw | head
///      --------neck    |                     ==============
///              |   head|
///              +---+---+
inline VoxelPuzzle lockedChain(int links) {
  constexpr int kPitch = 4;
  std::vector<std::set<Cell>> parts;
  for (int i = 0; i < links; ++i) {
    std::set<Cell> cells;
    // At joint j the wings of the head are along one axis and the slot along the other.
    const auto put = [&cells](int joint, int x, int along_wings) {
      cells.insert(joint % 2 == 0 ? Cell{x, 0, along_wings} : Cell{x, along_wings, 0});
    };
    const int x = kPitch * i;
    if (i > 0) {
      for (const int side : {-1, 1}) {
        put(i, x, side);
        put(i, x, 2 * side);
        put(i, x + 1, 2 * side);
        for (int arm = 1; i > 1 && arm < kPitch; ++arm) put(i, x - arm, side);
      }
      for (int t = -2; t <= 2; ++t) put(i, x + 2, t);
    }
    put(i, x + 3, 0);
    if (i + 1 < links) {
      put(i, x + 4, 0);
      for (int t = -1; t <= 1; ++t) put(i + 1, x + 5, t);
    }
    parts.push_back(std::move(cells));
  }
  return VoxelPuzzle(std::move(parts));
}

/// A six-piece burr: two bars of 2 x 2 x 6 along each axis cross in the middle. Each cell that several bars
/// share is given to one of them at random, or is left empty with a probability; the first bar is whole. In
/// many burrs a bar is in several pieces: see isConnected().
inline VoxelPuzzle randomBurr(std::uint64_t seed, double empty) {
  std::mt19937_64 random(seed);
  std::vector<std::set<Cell>> bars;
  for (int axis = 0; axis < 3; ++axis)
    for (const int from : {1, 3}) {
      std::set<Cell> bar;
      for (int along = 0; along < 6; ++along)
        for (int a = 0; a < 2; ++a)
          for (int b = 0; b < 2; ++b) {
            Cell cell;
            cell[static_cast<std::size_t>(axis)] = along;
            cell[static_cast<std::size_t>(axis + 1) % 3] = 2 + a;
            cell[static_cast<std::size_t>(axis + 2) % 3] = from + b;
            bar.insert(cell);
          }
      bars.push_back(bar);
    }
  std::set<Cell> all;
  for (const std::set<Cell>& bar : bars) all.insert(bar.begin(), bar.end());
  for (const Cell& cell : all) {
    std::vector<std::size_t> owners;
    for (std::size_t i = 0; i < bars.size(); ++i)
      if (bars[i].contains(cell)) owners.push_back(i);
    const std::size_t keeps = owners.front() == 0 ? 0 : owners[random() % owners.size()];
    const bool is_empty =
        owners.size() > 1 && owners.front() != 0 && 1e-3 * static_cast<double>(random() % 1000) < empty;
    for (const std::size_t owner : owners)
      if (is_empty || owner != keeps) bars[owner].erase(cell);
  }
  return VoxelPuzzle(std::move(bars));
}

/// Square pieces in a tray. Tabs with wide heads, each on a random side, lock the pieces in their plane. The
/// tray is the last part. Pieces can leave only upwards, along z.
inline VoxelPuzzle jigsaw(int columns, int rows, std::uint64_t seed) {
  constexpr int kPiece = 8;
  std::mt19937_64 random(seed);
  std::map<Cell, int> owner;
  for (int x = 0; x < kPiece * columns; ++x)
    for (int y = 0; y < kPiece * rows; ++y) owner[{x, y, 0}] = x / kPiece + columns * (y / kPiece);
  // A tab across the border at x or y = edge, with a neck of one cell and a head of three.
  const auto addTab = [&](std::size_t axis, int edge, int middle) {
    const int side = random() % 2 == 0 ? 1 : -1, first = side > 0 ? edge : edge - 1;
    Cell from{};
    from[axis] = first - side;
    from[1 - axis] = middle;
    const int piece = owner.at(from);
    for (const auto& [depth, across] : {std::array{0, 0}, {1, -1}, {1, 0}, {1, 1}}) {
      Cell cell{};
      cell[axis] = first + side * depth;
      cell[1 - axis] = middle + across;
      owner[cell] = piece;
    }
  };
  for (int column = 0; column < columns; ++column)
    for (int row = 0; row < rows; ++row) {
      const int x = kPiece * column, y = kPiece * row;
      if (column > 0) addTab(0, x, y + kPiece / 2);
      if (row > 0) addTab(1, y, x + kPiece / 2);
    }
  std::vector<std::set<Cell>> parts(static_cast<std::size_t>(columns * rows) + 1);
  for (const auto& [cell, piece] : owner) parts[static_cast<std::size_t>(piece)].insert(cell);
  for (int x = -1; x <= kPiece * columns; ++x)
    for (int y = -1; y <= kPiece * rows; ++y) {
      parts.back().insert({x, y, -1});
      if (!owner.contains({x, y, 0})) parts.back().insert({x, y, 0});
    }
  return VoxelPuzzle(std::move(parts));
}

/// Whether every part is connected.
inline bool isConnected(const VoxelPuzzle& puzzle) {
  return std::ranges::all_of(puzzle.parts(), [](const std::set<Cell>& part) {
    std::set<Cell> seen{*part.begin()};
    std::vector<Cell> waiting{*part.begin()};
    while (!waiting.empty()) {
      const Cell cell = waiting.back();
      waiting.pop_back();
      for (const Cell& step : unitSteps())
        if (part.contains(cell + step) && seen.insert(cell + step).second) waiting.push_back(cell + step);
    }
    return seen.size() == part.size();
  });
}

}  // namespace vps::test
