// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "vps/contact_tolerances.h"
#include "vps/pose.h"

namespace vps::bullet {

/// Records with a place each, found again by place: a hash of cubes with an edge of twice kSamePlace_m, so
/// that places nearer than kSamePlace_m to a point lie in the eight cubes around it. Memory grows with the
/// greatest number of records so far, and is kept. Lengths in metres.
class SamePlaces {
 public:
  static constexpr std::uint32_t kNone = UINT32_MAX;

  /// Forgets all records. `count`: expected number of calls of add().
  void clear(std::size_t count) {
    std::size_t size = 16;
    while (size < 2 * count) size *= 2;
    first_.assign(size, kNone);
    entries_.clear();
  }

  /// A record may have several places: where it is moved, the old one remains, and the caller's test of the
  /// distance in find() decides.
  void add(const Vec3& p, std::uint32_t record) {
    std::uint32_t& first = first_[slot(cell(p.x()), cell(p.y()), cell(p.z()))];
    entries_.push_back({record, first});
    first = static_cast<std::uint32_t>(entries_.size() - 1);
  }

  /// The lowest record near `p` for which isSame(record) is true, or kNone. Cost: eight cubes with, as a
  /// rule, no or one record each.
  template <typename IsSame>
  [[nodiscard]] std::uint32_t find(const Vec3& p, const IsSame& isSame) const {
    const auto lowest = [](double x) { return static_cast<std::int64_t>(std::floor(x / kCell_m - 0.5)); };
    const std::int64_t x0 = lowest(p.x()), y0 = lowest(p.y()), z0 = lowest(p.z());
    std::uint32_t found = kNone;
    for (int k = 0; k < 8; ++k) {
      std::uint32_t entry = first_[slot(x0 + (k & 1), y0 + (k >> 1 & 1), z0 + (k >> 2))];
      for (; entry != kNone; entry = entries_[entry].next) {
        const std::uint32_t record = entries_[entry].record;
        if (record < found && isSame(record)) found = record;
      }
    }
    return found;
  }

 private:
  static constexpr double kCell_m = 2 * kSamePlace_m;
  struct Entry {
    std::uint32_t record, next;
  };

  static std::int64_t cell(double x) { return static_cast<std::int64_t>(std::floor(x / kCell_m)); }
  // Odd multipliers of the usual size spread neighbouring cubes over the table.
  [[nodiscard]] std::size_t slot(std::int64_t x, std::int64_t y, std::int64_t z) const {
    const std::uint64_t mixed = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15u ^
                                static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4Fu ^
                                static_cast<std::uint64_t>(z) * 0x165667B19E3779F9u;
    return (mixed >> 32 ^ mixed) & (first_.size() - 1);
  }

  std::vector<std::uint32_t> first_;  // entry of each slot of the table, or kNone
  std::vector<Entry> entries_;
};

}  // namespace vps::bullet
