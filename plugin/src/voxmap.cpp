// SPDX-License-Identifier: BSD-3-Clause
#include "vps/voxmap.h"

#include "voxmap_layout.h"
#include "voxmap_sampling.h"

namespace vps {

VoxMap::VoxMap() {
  // An empty map: no cells, so everywhere outside; shared by all.
  static const std::shared_ptr<const VoxLayout> empty = [] {
    auto layout = std::make_shared<VoxLayout>();
    auto constants = std::make_shared<VoxPool>();
    constants->bricks.resize(2);
    layout->constants = constants;
    return layout;
  }();
  layout_ = empty;
}

std::size_t VoxMap::brickCount() const noexcept {
  std::size_t count = 0;
  for (const VoxCell& cell : layout_->cells) count += !layout_->isConstant(cell.brick);
  return count;
}

std::size_t VoxMap::memoryBytes() const noexcept {
  std::size_t bytes = sizeof(VoxLayout) + layout_->cells.size() * sizeof(VoxCell) + 2 * sizeof(VoxBrick);
  for (const auto& pool : layout_->pools)
    bytes += pool->bricks.size() * sizeof(VoxBrick) +
             pool->owners.size() * sizeof(std::array<std::uint16_t, kBrickNodes>);
  return bytes;
}

double VoxMap::distance(const Vec3& p_M) const noexcept {
  const VoxSampler sampler(*this);
  return sampler.distance(sampler.place(p_M));
}

Vec3 VoxMap::normal(const Vec3& p_M, Gradient gradient) const noexcept {
  const VoxSampler sampler(*this);
  return sampler.normal(sampler.place(p_M), gradient);
}

VoxMap::Sample VoxMap::sample(const Vec3& p_M, Gradient gradient) const noexcept {
  const VoxSampler sampler(*this);
  const VoxSampler::Place at = sampler.place(p_M);
  return {sampler.distance(at), sampler.normal(at, gradient)};
}

double VoxMap::lowerBound(const Vec3& p_M) const noexcept {
  const VoxSampler sampler(*this);
  const VoxSampler::Place at = sampler.place(p_M);
  return std::max({0.0, sampler.leastDistance(p_M, at), -sampler.mostDistance(at)});
}

double VoxMap::leastDistance(const Vec3& p_M) const noexcept {
  const VoxSampler sampler(*this);
  return sampler.leastDistance(p_M, sampler.place(p_M));
}

bool VoxMap::isInsideCoarse(const Vec3& p_M) const noexcept {
  const VoxSampler sampler(*this);
  return sampler.isInside(sampler.place(p_M));
}

std::uint16_t VoxMap::owner(const Vec3& p_M) const noexcept {
  const VoxSampler sampler(*this);
  return sampler.owner(sampler.place(p_M));
}

}  // namespace vps
