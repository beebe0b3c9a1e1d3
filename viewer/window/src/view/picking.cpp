// SPDX-License-Identifier: BSD-3-Clause
#include "view/picking.h"

#include <limits>
#include <utility>

#include "mesh/scene_meshes.h"

namespace vps::viewer {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

/// The interval of the ray inside the half space that the section keeps, as distances along the ray.
std::pair<double, double> keptRange(const Ray& ray, const CutPlane& cut) {
  const double along = cut.n_W.dot(ray.d_W), offset = cut.n_W.dot(cut.p_W - ray.p_W);
  if (along == 0) return offset >= 0 ? std::pair(0.0, kNone) : std::pair(kNone, kNone);
  return along < 0 ? std::pair(std::max(0.0, offset / along), kNone) : std::pair(0.0, offset / along);
}

bool meetsBox(const Ray& ray_P, const Box& box) {
  double near = 0, far = kNone;
  for (int k = 0; k < 3; ++k) {
    const double a = (box.min[k] - ray_P.p_W[k]) / ray_P.d_W[k],
                 b = (box.max[k] - ray_P.p_W[k]) / ray_P.d_W[k];
    if (ray_P.d_W[k] == 0) {
      if (ray_P.p_W[k] < box.min[k] || ray_P.p_W[k] > box.max[k]) return false;
      continue;
    }
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near <= far;
}

/// Distance along the ray to the triangle; infinite if the ray misses it. Source: Moeller and Trumbore 1997.
double hit(const Ray& ray, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, p = ray.d_W.cross(ac);
  const double det = ab.dot(p);
  if (det == 0) return kNone;
  const Vec3 from = ray.p_W - a, q = from.cross(ab);
  const double u = from.dot(p) / det, v = ray.d_W.dot(q) / det;
  if (u < 0 || v < 0 || u + v > 1) return kNone;
  const double t = ac.dot(q) / det;
  return t > 0 ? t : kNone;
}

/// The nearest hit within the range. If the range begins inside the part, the hit is on the cut face.
double nearest(const Mesh& mesh, const Ray& ray_P, std::pair<double, double> range) {
  double best = kNone;
  std::size_t before = 0;
  for (const auto& t : mesh.triangles) {
    const double d = hit(ray_P, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    if (d == kNone) continue;
    if (d < range.first) ++before;
    if (d >= range.first && d <= range.second) best = std::min(best, d);
  }
  return before % 2 == 1 ? range.first : best;
}

}  // namespace

Ray rayThrough(const Camera& camera, const PixelPlace& at, PictureSize size) {
  const int width = std::max(1, size.width), height = std::max(1, size.height);
  const auto [half_x, half_y] = camera.halfView(width, height);
  const Vec3 d_C(camera.shift_x + half_x * (2 * at[0] / width - 1),
                 camera.shift_y - half_y * (2 * at[1] / height - 1), -1);
  const Pose X_WC = camera.pose();
  return {camera.eye_W, (X_WC.R * d_C).normalized()};
}

std::optional<PickedPlace> pick(const RenderScene& scene, const scenes::Snapshot& snapshot,
                                const DrawOptions& options, const Ray& ray) {
  std::optional<PickedPlace> found;
  const std::vector<PartExtent> parts = partExtents(scene);
  forEachVisiblePart(
      parts, snapshot, options.show_waiting, [&](std::size_t part, const Pose& X_WP, scenes::BodyRole role) {
        const Pose X_PW = X_WP.inverse();
        const Ray ray_P = {X_PW * ray.p_W, X_PW.R * ray.d_W};
        if (!meetsBox(ray_P, parts[part].bounds_P)) return;
        const bool is_cut = options.cut && (options.cut->cuts_hand || role != scenes::BodyRole::InHand);
        const double distance_m =
            nearest(*scene[part].mesh, ray_P, is_cut ? keptRange(ray, *options.cut) : std::pair(0.0, kNone));
        if (distance_m == kNone || (found && distance_m >= found->distance_m)) return;
        found = PickedPlace{part, ray.p_W + distance_m * ray.d_W, distance_m};
      });
  return found;
}

}  // namespace vps::viewer
