// SPDX-License-Identifier: BSD-3-Clause
// Points in a hash grid, for searches within a radius: used for sampling, area weights and the progressive
// order.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "vps/pose.h"

namespace vps {

/// Points by index, in cubic cells of a hash table with open addressing. Insertion never moves a point;
/// visits follow a fixed order, so results depend on the input alone.
class PointGrid {
 public:
  /// @param cell_m    edge of a cell; fastest near twice the search radius (measured)
  /// @param expected  number of points for which memory is reserved; the grid takes more
  explicit PointGrid(double cell_m, std::size_t expected = 64) : inverse_cell_(1 / cell_m) {
    std::size_t slots = 64;
    while (slots < 2 * expected) slots *= 2;
    slots_.resize(slots);
    entries_.reserve(expected);
  }

  void insert(const Vec3& p, std::uint32_t id) {
    const Cell cell = cellOf(p);
    std::size_t& used = used_[static_cast<std::size_t>(cell.x & 3)];
    if (8 * (used + 1) > slots_.size()) grow();  // each of the four lanes at most half full
    Slot& slot = slots_[find(cell)];
    if (slot.head == kNone) ++used;
    entries_.push_back({p, id, slot.head});
    slot.head = static_cast<std::uint32_t>(entries_.size() - 1);
    slot.cell = cell;
  }

  /// Calls visit(id, squared distance) for each point within radius of p until visit returns false.
  template <class Visit>
  void visitNear(const Vec3& p, double radius, Visit&& visit) const {
    const Cell low = cellOf(p - Vec3::Constant(radius)), high = cellOf(p + Vec3::Constant(radius));
    for (std::int32_t z = low.z; z <= high.z; ++z)
      for (std::int32_t y = low.y; y <= high.y; ++y)
        for (std::int32_t x = low.x; x <= high.x; ++x)
          for (std::uint32_t e = slots_[find({x, y, z})].head; e != kNone; e = entries_[e].next) {
            const double squared = (entries_[e].p - p).squaredNorm();
            if (squared <= radius * radius && !visit(entries_[e].id, squared)) return;
          }
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;
  struct Cell {
    std::int32_t x = 0, y = 0, z = 0;
    bool operator==(const Cell&) const = default;
  };
  struct Slot {
    Cell cell;
    std::uint32_t head = kNone;
  };
  struct Entry {
    Vec3 p;
    std::uint32_t id, next;
  };

  [[nodiscard]] Cell cellOf(const Vec3& p) const {
    // Saturated, so that the result is defined for a coordinate far beyond the grid's resolution.
    const auto index = [this](double x) {
      return static_cast<std::int32_t>(std::clamp(std::floor(x * inverse_cell_), -1e9, 1e9));
    };
    return {index(p.x()), index(p.y()), index(p.z())};
  }
  /// The slot that holds the cell, or the free slot where it would go. Four neighbours along x share a cache
  /// line; probing steps from line to line.
  [[nodiscard]] std::size_t find(const Cell& cell) const {
    const std::size_t mask = slots_.size() - 1;
    // Odd 64-bit multipliers (from the golden ratio and the fractional parts of sqrt 2 and 3) spread the
    // lines.
    std::uint64_t hash = static_cast<std::uint32_t>(cell.x >> 2) * 0x9e3779b97f4a7c15ull;
    hash ^= static_cast<std::uint32_t>(cell.y) * 0x6a09e667f3bcc909ull;
    hash ^= static_cast<std::uint32_t>(cell.z) * 0xbb67ae8584caa73bull;
    std::size_t slot = ((hash >> 24 << 2) | (cell.x & 3)) & mask;
    while (slots_[slot].head != kNone && !(slots_[slot].cell == cell)) slot = (slot + 4) & mask;
    return slot;
  }
  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.head != kNone) slots_[find(slot.cell)] = slot;
  }

  double inverse_cell_;
  std::array<std::size_t, 4> used_{};  ///< cells in use, by the low bits of x
  std::vector<Slot> slots_;
  std::vector<Entry> entries_;
};

}  // namespace vps
