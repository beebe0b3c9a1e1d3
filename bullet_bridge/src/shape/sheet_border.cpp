// SPDX-License-Identifier: BSD-3-Clause
#include "shape/sheet_border.h"

#include <algorithm>
#include <array>
#include <map>

namespace vps::bullet {

SheetBorder::SheetBorder(const Mesh& mesh) {
  std::map<std::array<std::uint32_t, 2>, int> uses;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({t[k], t[(k + 1) % 3]});
      ++uses[{low, high}];
    }
  std::map<std::uint32_t, std::vector<std::array<std::uint32_t, 2>>> at_vertex;
  for (const auto& [edge, count] : uses)
    if (count == 1)
      for (const std::uint32_t v : edge) at_vertex[v].push_back(edge);
  for (const auto& t : mesh.triangles) {
    first_.push_back(static_cast<std::uint32_t>(edges_.size()));
    for (const std::uint32_t v : t)
      if (const auto it = at_vertex.find(v); it != at_vertex.end())
        for (const auto& edge : it->second)
          edges_.push_back({mesh.vertices[edge[0]], mesh.vertices[edge[1]]});
  }
  first_.push_back(static_cast<std::uint32_t>(edges_.size()));
  touch_m_ = 1e-9 * (1 + bounds(mesh).size().norm());
}

bool SheetBorder::isOnBorder(std::uint32_t triangle, const Vec3& q) const {
  for (std::uint32_t i = first_[triangle]; i < first_[triangle + 1]; ++i) {
    const Vec3 along = edges_[i].b - edges_[i].a;
    const double share = std::clamp((q - edges_[i].a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    if ((edges_[i].a + share * along - q).norm() <= touch_m_) return true;
  }
  return false;
}

SheetFoot SheetBorder::seenFrom(const Vec3& p, const Vec3& inward, const MeshDistance::Closest& foot) const {
  const Vec3 n = inward.dot(foot.normal) < 0 ? Vec3(-foot.normal) : foot.normal;
  const Vec3 from_q = p - foot.q;
  const double beside_m = (from_q - from_q.dot(n) * n).norm();
  if (!(beside_m > touch_m_) || !isOnBorder(foot.triangle, foot.q)) return {n, false};
  return {(n + from_q / from_q.norm()).normalized(), true};
}

}  // namespace vps::bullet
