// SPDX-License-Identifier: BSD-3-Clause
#include "tiles.h"

#include <algorithm>
#include <cmath>

#include "vps/mesh.h"

namespace vps::bench {

namespace {

constexpr double kEdge = 0.5, kFace = 0.05;  // in voxels
constexpr double kEdge_rad = 0.35;           // 20 degrees
constexpr double kSafetyShare = 0.1,
                 kSafety = 0.002;  // margins for points between the measured places; kSafety is in voxels

EdgeSet edgesOf(const Mesh& mesh) {
  std::vector<EdgeSegment> segments;
  for (const auto& [from, to] : sharpEdges(mesh, kEdge_rad)) {
    EdgeSegment s;
    s.from = mesh.vertices[from];
    s.to = mesh.vertices[to];
    segments.push_back(s);
  }
  return EdgeSet(std::move(segments));
}

}  // namespace

FieldError::FieldError(const Model& part) : part_(part), edges_(edgesOf(*part->mesh)) {}

bool FieldError::isBesideEdge(const Vec3& p_M) const {
  bool is_any = false;
  edges_.tree().forEachNear(p_M, part_->map->voxel_m(), [&](std::uint32_t) { is_any = true; });
  return is_any;
}

double FieldError::bound_m(Bound bound, const Vec3& p_M) {
  const double voxel_m = part_->map->voxel_m();
  switch (bound) {
    case Bound::Everywhere:
      return kEdge * voxel_m;
    case Bound::BesideEdges:
      return (isBesideEdge(p_M) ? kEdge : kFace) * voxel_m;
    case Bound::Block:
      return stored_m(blocks_, p_M, 8 * voxel_m, 16);
    default:
      return stored_m(cells_, p_M, voxel_m, 4);
  }
}

std::uint64_t FieldError::keyOf(const Vec3& p_M, double size_m) const {
  std::uint64_t key = 0;
  for (int k = 0; k < 3; ++k)
    key = key << 21 |
          (static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(p_M[k] / size_m))) & 0x1FFFFF);
  return key;
}

double FieldError::stored_m(Stored& stored, const Vec3& p_M, double size_m, int places) {
  const auto [it, is_new] = stored.try_emplace(keyOf(p_M, size_m), 0.0);
  if (!is_new) return it->second;
  const double voxel_m = part_->map->voxel_m(), near_m = voxel_m;
  const Vec3 low = size_m * (p_M / size_m).array().floor().matrix();
  double most_m = 0;
  for (int i = 0; i < places * places * places; ++i) {
    const Vec3 share = Vec3(i % places, i / places % places, i / places / places) / (places - 1);
    const Vec3 p = low + size_m * share;
    const double reading_m = part_->map->distance(p);
    if (std::abs(reading_m) > near_m + voxel_m) continue;
    const double distance_m = part_->solid->signedDistance(p, 4 * voxel_m);
    if (std::abs(distance_m) < near_m) most_m = std::max(most_m, reading_m - distance_m);
  }
  return it->second = (1 + kSafetyShare) * most_m + kSafety * voxel_m;
}

}  // namespace vps::bench
