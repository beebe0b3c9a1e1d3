// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact_key.h"

#include <BulletCollision/NarrowPhaseCollision/btManifoldPoint.h>

namespace vps::bullet::inline v0 {

std::uint64_t keyOf(const btManifoldPoint& point) {
  const std::uint8_t side = point.m_index0 >= 0 ? 0 : 1;
  const bool is_crossing = point.m_index0 >= 0 && point.m_index1 >= 0;
  const std::uint32_t crossed = is_crossing ? static_cast<std::uint32_t>(point.m_index1) + 1 : 0;
  return contactKey(side, crossed, static_cast<std::uint32_t>(side == 0 ? point.m_index0 : point.m_index1));
}

}  // namespace vps::bullet::inline v0
