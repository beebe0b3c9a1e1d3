// SPDX-License-Identifier: BSD-3-Clause
#include "ways/contact_probes.h"

#include <algorithm>
#include <cmath>

namespace vps::scenes {

std::vector<Vec3> ContactProbes::touching(const PlacedSurface& of, const PlacedSurface& other,
                                          double within_m) {
  constexpr std::size_t kPoints = 32;
  const Box near_W = grown(other.box_W, within_m);
  const Pose X_OW = other.X_WP.inverse();
  std::vector<Vec3> points_W;
  const auto add = [&](const Vec3& p_W) {
    if (isWithin(p_W, near_W) && std::abs(other.surface->solid().signedDistance(X_OW * p_W)) <= within_m)
      points_W.push_back(p_W);
  };
  const auto count = static_cast<std::uint32_t>(of.surface->mesh().triangles.size());
  constexpr std::uint32_t kLooked = 4096;
  for (std::uint32_t i = 0; i < count; i += 1 + count / kLooked) {
    const Triangle t = of.surface->triangle(i);
    add(of.X_WP * Vec3((t[0] + t[1] + t[2]) / 3));
    add(of.X_WP * t[0]);
  }
  const std::size_t stride = 1 + points_W.size() / kPoints;
  std::vector<Vec3> some_W;
  for (std::size_t i = 0; i < points_W.size(); i += stride) some_W.push_back(points_W[i]);
  return some_W;
}

ContactProbes::ContactProbes(const PlacedSurface& a, const PlacedSurface& b, double allowed_m)
    : allowed_m_(allowed_m) {
  sides_.push_back({&b, touching(a, b, allowed_m), 1});
  sides_.push_back({&a, touching(b, a, allowed_m), -1});
}

bool ContactProbes::areStopped(const Vec3& d_W) const {
  constexpr double kWays[] = {
      8, 80};  // in allowed depths: far enough to exceed the allowed depth at a slope of an eighth
  return std::ranges::any_of(kWays, [&](double way) {
    return std::ranges::any_of(sides_, [&](const Side& side) {
      const Pose X_OW = side.other->X_WP.inverse();
      const Vec3 step_W = side.sign * way * allowed_m_ * d_W;
      return std::ranges::any_of(side.points_W, [&](const Vec3& p_W) {
        return side.other->surface->solid().signedDistance(X_OW * Vec3(p_W + step_W)) < -2 * allowed_m_;
      });
    });
  });
}

}  // namespace vps::scenes
