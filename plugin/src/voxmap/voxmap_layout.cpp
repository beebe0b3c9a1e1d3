// SPDX-License-Identifier: BSD-3-Clause
// The pool of memory for bricks, the move of a map's bricks to a larger pool, and the cells that have only
// empty cells around them.
#ifdef __linux__
#include <sys/mman.h>
#endif

#include <algorithm>
#include <new>

#include "voxmap/voxmap_layout.h"
#include "vps/errors.h"

namespace vps {

VoxPool::VoxPool(std::size_t capacity)
    : capacity_(std::min<std::size_t>(2 * capacity, kMaxBricks) + 2),
      nodes_(static_cast<NodeValue*>(
          ::operator new (capacity_* kBrickStride * sizeof(NodeValue), std::align_val_t{kPage}))),
      owner_(new std::uint16_t[capacity_]),
      mixed_(new const NodeOwners*[capacity_]) {
#ifdef __linux__
  // Reads are scattered over the nodes; small pages exceed the TLB (5 to 10 % of the time of a read of 20
  // MB). The call is a hint: if the system refuses it, nothing else changes.
  const std::size_t bytes = capacity_ * kBrickStride * sizeof(NodeValue);
  if (bytes >= kPage) (void)madvise(nodes_.get(), bytes / kPage * kPage, MADV_HUGEPAGE);
#endif
  used_ = 2;
  std::fill_n(nodes(kOutside), kBrickStride, static_cast<NodeValue>(kFullBand));
  std::fill_n(nodes(kInside), kBrickStride, static_cast<NodeValue>(-kFullBand));
  owner(kOutside) = owner(kInside) = 0;
  mixed(kOutside) = mixed(kInside) = nullptr;
}

std::uint32_t VoxPool::take(std::size_t count) noexcept {
  if (count == 0) return 0;
  const std::lock_guard lock(mutex_);
  std::size_t first = used_;
  const auto run = std::find_if(free_.begin(), free_.end(), [&](const auto& r) { return r.second >= count; });
  if (run != free_.end()) {
    // Bricks are taken from the end of the run: its entry in the list stays, and nothing is allocated.
    first = run->first + (run->second -= count);
    if (run->second == 0) free_.erase(run);
  } else {
    if (first + count > capacity_) return 0;
    used_ = first + count;
  }
  std::fill_n(&owner_[first], count, std::uint16_t{0});
  std::fill_n(&mixed_[first], count, nullptr);
  return static_cast<std::uint32_t>(first * kBrickStride);
}

void VoxPool::giveBack(std::uint32_t first, std::size_t count) noexcept {
  const std::lock_guard lock(mutex_);
  std::size_t begin = first / kBrickStride, end = begin + count;
  const auto after = free_.find(end);
  if (after != free_.end()) {
    end += after->second;
    free_.erase(after);
  }
  auto before = free_.lower_bound(begin);
  if (before != free_.begin() && (--before)->first + before->second == begin) {
    begin = before->first;
    free_.erase(before);
  }
  if (end == used_) {
    used_ = begin;
    return;
  }
  try {
    free_[begin] = end - begin;
  } catch (const std::bad_alloc&) {  // the bricks are lost until the pool is deleted
  }
}

namespace {

/// Visits the name of each non-constant brick of a layout; the visitor may change it.
template <typename Visit>
void forNames(VoxLayout& layout, Visit visit) {
  for (std::uint32_t& brick : layout.bricks)
    if (!isConstant(brick)) visit(brick);
}

/// The bricks that a layout uses. A brick that several cells share is listed once.
struct Named {
  std::vector<std::uint8_t> is_named;  ///< by index in the pool
  std::size_t count = 0, mixed = 0;
};

Named namedBy(VoxLayout& layout) {
  Named named;
  named.is_named.resize(layout.pool->size());
  forNames(layout, [&](std::uint32_t brick) {
    std::uint8_t& is_named = named.is_named[brick / kBrickStride];
    if (is_named != 0) return;
    is_named = 1;
    ++named.count;
    named.mixed += layout.pool->mixed(brick) != nullptr ? 1 : 0;
  });
  return named;
}

void copyBrick(const VoxPool& from, std::uint32_t old, VoxPool& to, std::uint32_t brick,
               std::vector<NodeOwners>& owners) {
  std::copy_n(from.nodes(old), kBrickStride, to.nodes(brick));
  to.owner(brick) = from.owner(old);
  to.mixed(brick) = from.mixed(old) != nullptr ? &owners.emplace_back(*from.mixed(old)) : nullptr;
}

}  // namespace

void moveToNewPool(VoxLayout& layout, std::size_t room) {
  const Named named = namedBy(layout);
  if (named.count + room > VoxPool::kMaxBricks)
    throw LoadError("", "",
                    "the voxmap needs " + std::to_string(named.count + room) +
                        " bricks of 8 x 8 x 8 voxels, and " + std::to_string(VoxPool::kMaxBricks) +
                        " is the most that one can have; use larger voxels");
  const std::shared_ptr<const VoxPool> from = layout.pool;
  auto to = std::make_shared<VoxPool>(named.count + room);
  auto owners = std::make_shared<std::vector<NodeOwners>>();
  owners->reserve(named.mixed);  // never reallocated, since bricks point into it
  std::uint32_t next = to->take(named.count);
  std::vector<std::uint32_t> name(from->size(), 0);  // name in the new pool, by index in the old one
  forNames(layout, [&](std::uint32_t& brick) {
    std::uint32_t& renamed = name[brick / kBrickStride];
    if (renamed == 0) {
      copyBrick(*from, brick, *to, renamed = next, *owners);
      next += kBrickStride;
    }
    brick = renamed;
  });
  layout.pool = to;
  layout.owners = {owners};
  layout.leases.clear();
}

std::uint32_t takeBricks(VoxLayout& layout, std::size_t count) {
  const std::uint32_t first = layout.pool->take(count);
  if (first != 0 || count == 0) return first;
  moveToNewPool(layout, count);
  const std::uint32_t moved = layout.pool->take(count);
  VPS_ASSERT(moved != 0);
  return moved;
}

namespace {

/// Spreads set entries to their neighbours along one axis.
/// @param stride  distance in memory from neighbour to neighbour
/// @param length  entries of a whole row of neighbours
void spread(const std::vector<std::uint8_t>& from, std::size_t stride, std::size_t length,
            std::vector<std::uint8_t>& to) {
  for (std::size_t row = 0; row < from.size(); row += length) {
    const std::uint8_t* a = &from[row];
    std::uint8_t* __restrict b = &to[row];
    for (std::size_t i = 0; i + stride < length; ++i) b[i] |= a[i + stride];
    for (std::size_t i = stride; i < length; ++i) b[i] |= a[i - stride];
  }
}

}  // namespace

void markFarCells(VoxLayout& layout) {
  std::vector<std::uint8_t> is_used(layout.bricks.size()), wider;
  for (std::size_t i = 0; i < is_used.size(); ++i) is_used[i] = layout.bricks[i] != kOutside;
  layout.far_cells.assign(is_used.size(), 0);
  for (int away = 1; away <= kMostFarCells; ++away) {
    std::size_t stride = 1;
    for (int axis = 2; axis >= 0; --axis) {
      const std::size_t length = stride * static_cast<std::size_t>(layout.size[axis]);
      wider = is_used;
      spread(is_used, stride, length, wider);
      is_used.swap(wider);
      stride = length;
    }
    for (std::size_t i = 0; i < is_used.size(); ++i)
      layout.far_cells[i] = static_cast<std::uint8_t>(layout.far_cells[i] + (is_used[i] == 0 ? 1 : 0));
  }
}

}  // namespace vps
