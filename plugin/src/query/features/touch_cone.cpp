// SPDX-License-Identifier: BSD-3-Clause
#include "query/features/direction_cone.h"

#include <algorithm>
#include <vector>

#include "vps/contact_tolerances.h"

namespace vps {

namespace {

/// The directions whose products with all rays are at least `least`: a part of the unit sphere, bounded by
/// circles around the rays.
class Allowed {
 public:
  Allowed(std::span<const Vec3> rays, double least) : rays_(rays), least_(least) {}

  [[nodiscard]] bool has(const Vec3& n) const { return risesFrom(rays_, n, kSinFlat - least_); }

  // The points at which two of the circles cross.
  [[nodiscard]] std::vector<Vec3> vertices() const {
    std::vector<Vec3> found;
    for (std::size_t i = 0; i < rays_.size(); ++i)
      for (std::size_t j = i + 1; j < rays_.size(); ++j) {
        const double dot = rays_[i].dot(rays_[j]);
        // The circles around parallel rays do not cross.
        if (!(1 + dot > kRoundingShare) || !(1 - dot > kRoundingShare)) continue;
        const Vec3 middle = least_ / (1 + dot) * (rays_[i] + rays_[j]);
        const double rest = 1 - middle.squaredNorm();
        if (rest < 0) continue;
        const Vec3 way = std::sqrt(rest) * rays_[i].cross(rays_[j]).normalized();
        for (const Vec3& n : {Vec3(middle + way), Vec3(middle - way)})
          if (has(n)) found.push_back(n);
      }
    return found;
  }

  // The point of the circle around a ray that is farthest from an axis.
  [[nodiscard]] Vec3 farthest(const Vec3& ray, const Vec3& axis) const {
    Vec3 away = ray * ray.dot(axis) - axis;
    if (!(away.norm() > kRoundingShare)) away = ray.unitOrthogonal();
    return least_ * ray + std::sqrt(1 - least_ * least_) * away.normalized();
  }

 private:
  std::span<const Vec3> rays_;
  double least_;
};

}  // namespace

std::optional<DirectionCone> touchCone(std::span<const Vec3> rays, double slope) {
  constexpr std::size_t kMost = 12;
  if (rays.empty()) return DirectionCone::everywhere();
  rays = rays.first(std::min(rays.size(), kMost));
  const Allowed allowed(rays, -slope);
  std::vector<Vec3> border = allowed.vertices();
  Vec3 sum = Vec3::Zero();
  for (const Vec3& n : border) sum += n;
  if (!(sum.norm() > kNoDirection))
    for (const Vec3& ray : rays) sum += ray;
  const Vec3 axis = sum.norm() > kNoDirection ? sum.normalized() : rays[0];
  for (const Vec3& ray : rays)
    if (const Vec3 n = allowed.farthest(ray, axis); allowed.has(n)) border.push_back(n);
  if (border.empty()) return std::nullopt;
  if (allowed.has(-axis)) return DirectionCone::everywhere();
  double least = 1;
  for (const Vec3& n : border) least = std::min(least, n.dot(axis));
  return DirectionCone::around(axis, std::acos(std::clamp(least, -1.0, 1.0)) + kSinParallel);
}

}  // namespace vps
