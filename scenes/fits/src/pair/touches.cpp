// SPDX-License-Identifier: BSD-3-Clause
#include "pair/touches.h"

#include <algorithm>
#include <functional>

#include "vps/mesh_overlap.h"
#include "vps/stoppable.h"

namespace vps::scenes {

namespace {

struct DeepCorner {
  double depth_m;
  std::uint32_t vertex;
};

/// The touch of a point of part `of` that is inside part `above`.
Touch touchAt(const std::vector<PlacedSurface>& parts, const std::vector<Pose>& X_WP, std::size_t of,
              std::size_t above, const Vec3& p_O, std::uint32_t vertex) {
  Touch touch{of, above, vertex, p_O};
  touch.renew(*parts[above].surface, X_WP[above].inverse() * X_WP[of]);
  return touch;
}

void appendCorners(const std::vector<PlacedSurface>& parts, const std::vector<Pose>& X_WP, std::size_t of,
                   std::size_t above, double more_than_m, PairTouches& out) {
  constexpr std::size_t kMost = 64;  // touches of one part in the other; far more than the degrees of freedom
  const Pose X_AO = X_WP[above].inverse() * X_WP[of];
  const PartSurface& other = *parts[above].surface;
  const std::vector<Vec3>& vertices = parts[of].surface->mesh().vertices;
  constexpr std::size_t kOutsidePerWork = 64;
  out.work += vertices.size() / kOutsidePerWork;
  std::vector<DeepCorner> deep;
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    const Vec3 p_A = X_AO * vertices[i];
    if (!isWithin(p_A, other.box())) continue;
    ++out.work;
    pollStop();
    const double depth_m = -other.solid().signedDistance(p_A);
    if (depth_m > more_than_m) deep.push_back({depth_m, i});
  }
  std::ranges::stable_sort(deep, std::greater(), &DeepCorner::depth_m);
  if (deep.size() > kMost) deep.resize(kMost);
  for (const DeepCorner& corner : deep)
    out.touches.push_back(touchAt(parts, X_WP, of, above, vertices[corner.vertex], corner.vertex));
}

}  // namespace

void Touch::renew(const PartSurface& above_surface, const Pose& X_AO) {
  const Vec3 p_A = X_AO * p_O;
  const Solid::Closest nearest = above_surface.solid().closest(p_A);
  const Vec3 out = nearest.q - p_A;
  if (!nearest.found || nearest.normal.dot(out) < 0) return;  // the point is outside
  // At an edge or a corner, the direction to the surface differs from the normal of the nearest facet.
  constexpr double kSure_m = 1e-9;
  q_A = nearest.q;
  n_A = nearest.distance_m > kSure_m ? Vec3(out / nearest.distance_m) : nearest.normal;
}

PairTouches touchesOf(const std::vector<PlacedSurface>& parts, const std::vector<Pose>& X_WP, std::size_t a,
                      std::size_t b, double more_than_m) {
  const Overlap deepest =
      deepestOverlap(parts[a].surface->overlap(), X_WP[a], parts[b].surface->overlap(), X_WP[b]);
  PairTouches out{deepest.depth_m, {}, deepest.work};
  if (!(deepest.depth_m > more_than_m)) return out;
  for (const auto& [of, above] : {std::pair{a, b}, std::pair{b, a}}) {
    const double depth_m = -parts[above].surface->solid().signedDistance(X_WP[above].inverse() * deepest.p_W);
    if (depth_m > more_than_m)
      out.touches.push_back(
          touchAt(parts, X_WP, of, above, X_WP[of].inverse() * deepest.p_W, Touch::kNoVertex));
    appendCorners(parts, X_WP, of, above, more_than_m, out);
  }
  return out;
}

}  // namespace vps::scenes
