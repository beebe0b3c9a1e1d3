// SPDX-License-Identifier: BSD-3-Clause
// Room for more bricks: in the pool that is there, or in a larger one.
#include "voxmap/voxmap_layout.h"
#include "vps/assert.h"
#include "vps/load_error.h"

namespace vps {
namespace {

/// Visits each brick of its own that a layout names, by that name, which may be changed.
template <typename Visit>
void forNames(VoxLayout& layout, Visit visit) {
  for (std::uint32_t& brick : layout.bricks)
    if (!isConstant(brick)) visit(brick);
}

/// What a move to another pool needs to know: bricks that several cells name are moved once.
struct Named {
  std::vector<std::uint8_t> is_named;  ///< by place in the pool
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
  if (named.count + room > VoxPool::kMost)
    throw LoadError("", "",
                    "needs " + std::to_string(named.count + room) + " bricks of 8 voxels, and a voxmap has " +
                        std::to_string(VoxPool::kMost) + " at most; larger voxels would do");
  const std::shared_ptr<const VoxPool> from = layout.pool;
  auto to = std::make_shared<VoxPool>(named.count + room);
  auto owners = std::make_shared<std::vector<NodeOwners>>();
  owners->reserve(named.mixed);  // bricks point into it
  std::uint32_t next = to->take(named.count);
  std::vector<std::uint32_t> name(from->size(), 0);  // in the new pool, by place in the old
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

}  // namespace vps
