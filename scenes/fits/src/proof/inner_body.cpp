// SPDX-License-Identifier: BSD-3-Clause
#include "proof/inner_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace vps::scenes {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace

PointAtSolid::PointAtSolid(const PartSurface& solid, const Vec3& p) : solid_(solid), p_(p), q_(p) {
  constexpr double kSure_m = 1e-9;  // below, the two points have no direction
  const Solid::Closest nearest = solid.solid().closest(p);
  q_ = nearest.q;
  n_ = nearest.normal;
  const Vec3 out = p - nearest.q;
  const bool is_inside = nearest.normal.dot(out) < 0;
  distance_m_ = is_inside ? -nearest.distance_m : nearest.distance_m;
  if (nearest.distance_m > kSure_m) n_ = out / distance_m_;
}

GapBound PointAtSolid::bound(double moved_m, double beyond_m, std::size_t& work) const {
  if (!(n_.squaredNorm() > 0.5)) return {kInfinite, Vec3::UnitZ()};  // a facet without area has no normal
  return {std::min(byBalls(moved_m, work), byCylinder(moved_m, beyond_m, work)), n_};
}

double PointAtSolid::byBalls(double moved_m, std::size_t& work) const {
  constexpr int kBalls = 10;
  constexpr double kSmaller = 0.5;
  double best_m = kInfinite;
  double radius_m = 0.5 * solid_.box().size().norm();
  for (int i = 0; i < kBalls; ++i, radius_m *= kSmaller) {
    const double length_m = distance_m_ + radius_m;  // from the ball's centre to the point
    if (!(length_m > 2 * moved_m)) break;
    ++work;
    const double inside_m = -solid_.solid().signedDistance(q_ - radius_m * n_);
    if (inside_m > 0)
      best_m = std::min(best_m, length_m - inside_m + moved_m * moved_m / (2 * (length_m - moved_m)));
  }
  return best_m;
}

double PointAtSolid::byCylinder(double moved_m, double beyond_m, std::size_t& work) const {
  // The point stays within `wide_m` of the axis with room for the depth that is to be proven.
  const double wide_m = 1.01 * (moved_m + beyond_m);
  const double deep_m = wide_m + std::max(0.0, -distance_m_);
  const Vec3 x = n_.unitOrthogonal(), y = n_.cross(x);
  Box reach;
  for (const double along_m : {0.0, -2 * deep_m})
    for (const double i : {-wide_m, wide_m})
      for (const double k : {-wide_m, wide_m}) reach.add(q_ + along_m * n_ + i * x + k * y);
  // Heights over the plane through q of the facets that reach over the cylinder's base, from the highest.
  std::vector<std::pair<double, double>> heights;
  constexpr std::size_t kMostFacets = 2000, kFacetsPerWork = 16;
  bool is_whole = true;
  solid_.tree().forEach([&](const Box& box) { return is_whole && overlap(box, reach); },
                        [&](std::uint32_t i) {
                          std::array<Eigen::Vector2d, 3> across;
                          double low = kInfinite, high = -kInfinite;
                          for (std::size_t k = 0; k < 3; ++k) {
                            const Vec3 r = solid_.triangle(i)[k] - q_;
                            across[k] = {r.dot(x), r.dot(y)};
                            low = std::min(low, r.dot(n_)), high = std::max(high, r.dot(n_));
                          }
                          if (distanceOfOrigin(across) > wide_m) return;
                          heights.emplace_back(high, low);
                          is_whole = heights.size() < kMostFacets;
                        });
  work += 1 + heights.size() / kFacetsPerWork;
  if (!is_whole) return kInfinite;
  std::ranges::sort(heights, std::greater());
  double top_m = 0;  // depth of the cylinder's top below q
  for (const auto& [high, low] : heights)
    if (high > -(top_m + deep_m)) top_m = std::max(top_m, -low);
  if (top_m > deep_m) return kInfinite;
  ++work;
  if (!solid_.solid().isInside(q_ - (top_m + 0.5 * deep_m) * n_)) return kInfinite;
  return distance_m_ + top_m;
}

}  // namespace vps::scenes
