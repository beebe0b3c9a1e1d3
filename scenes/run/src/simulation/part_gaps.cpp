// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/run/part_gaps.h"

#include <algorithm>
#include <array>

#include "surface/triangle_gap.h"
#include "vps/bounding_volume_hierarchy.h"
#include "vps/mesh_distance.h"

namespace vps::scenes {

struct PartGaps::Surface {
  Mesh mesh;
  BoxTree tree;
  MeshDistance distance;

  explicit Surface(const Mesh& of_part) : mesh(of_part), tree(triangleBoxes(mesh), 2), distance(mesh) {}
  [[nodiscard]] Triangle triangle(std::uint32_t i) const {
    const auto& corners = mesh.triangles[i];
    return {mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]]};
  }
};

PartGaps::PartGaps(const Scene& scene) {
  for (const ScenePart& part : scene.parts) surfaces_.push_back(std::make_unique<Surface>(part.part.mesh));
}
PartGaps::~PartGaps() = default;

std::vector<PartGap> PartGaps::of(std::size_t part, const Snapshot& shot, double most_m) const {
  std::vector<PartGap> gaps;
  const auto self = std::ranges::find(shot.bodies, part, &BodySnapshot::part);
  if (self == shot.bodies.end() || part >= surfaces_.size() || !self->X_WP.isFinite()) return gaps;
  const Surface& a = *surfaces_[part];
  for (const BodySnapshot& body : shot.bodies) {
    const bool is_there = body.role != BodyRole::Waiting && body.X_WP.isFinite();
    if (body.part == part || body.part >= surfaces_.size() || !is_there) continue;
    const Surface& b = *surfaces_[body.part];
    const Pose X_AB = self->X_WP.inverse() * body.X_WP;
    PartGap best{body.part, most_m, Vec3::Zero()};
    visitPairs(
        a.tree, b.tree, [&](const Box& box) { return moved(box, X_AB); },
        [](const Box& of_a, const Box& of_b) { return distance2(of_a, of_b); },
        [&] { return best.distance_m * best.distance_m; },
        [&](std::uint32_t i, std::uint32_t k) {
          const Triangle of_b = b.triangle(k);
          const TriangleGap gap =
              triangleGap(a.triangle(i), {X_AB * of_b[0], X_AB * of_b[1], X_AB * of_b[2]});
          if (gap.distance_m < best.distance_m)
            best = {body.part, gap.distance_m, self->X_WP * (0.5 * (gap.p_a + gap.p_b))};
        });
    if (best.distance_m < most_m) gaps.push_back(best);
  }
  std::ranges::stable_sort(gaps, {}, &PartGap::distance_m);
  return gaps;
}

std::vector<PartTouch> PartGaps::touches(const Snapshot& shot) const {
  std::vector<PartTouch> touches;
  for (const ContactMark& mark : shot.contacts) {
    struct Near {
      std::size_t part = 0;
      double distance_m = 0;
    };
    const double most_m = kContactNear_m + mark.depth_m;
    std::array<Near, 2> nearest = {Near{0, most_m}, Near{0, most_m}};  // sorted by distance
    for (const BodySnapshot& body : shot.bodies) {
      if (body.part >= surfaces_.size() || body.role == BodyRole::Waiting || !body.X_WP.isFinite()) continue;
      const MeshDistance::Closest found =
          surfaces_[body.part]->distance.closest(body.X_WP.inverse() * mark.p_W, nearest[1].distance_m);
      if (!found.found || !(found.distance_m < nearest[1].distance_m)) continue;
      nearest[1] = {body.part, found.distance_m};
      if (nearest[1].distance_m < nearest[0].distance_m) std::swap(nearest[0], nearest[1]);
    }
    if (nearest[1].distance_m == most_m) continue;
    const auto [a, b] = std::minmax(nearest[0].part, nearest[1].part);
    const auto known =
        std::ranges::find_if(touches, [&](const PartTouch& t) { return t.a == a && t.b == b; });
    if (known == touches.end())
      touches.push_back({a, b, mark.force_N});
    else
      known->force_N += mark.force_N;
  }
  std::ranges::sort(touches, [](const PartTouch& x, const PartTouch& y) {
    return std::pair(x.a, x.b) < std::pair(y.a, y.b);
  });
  return touches;
}

}  // namespace vps::scenes
