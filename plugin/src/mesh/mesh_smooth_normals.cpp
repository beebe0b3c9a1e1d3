// SPDX-License-Identifier: BSD-3-Clause
// Normals and curvatures of the curved surface that a mesh's facets approximate.
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

#include "mesh/normals.h"
#include "vps/mesh_distance.h"
#include "vps/stoppable.h"

namespace vps {
namespace {

/// Faces whose normals differ by less than 20 degrees (as PointShellSettings::edge_angle_rad) are facets of
/// one curved surface.
constexpr double kCosSmooth = 0.94;
/// Corners with more faces than this are the hubs of nearly flat fans; comparing all pairs of faces would
/// take quadratic time.
constexpr std::size_t kMaxFaces = 64;

/// A triangle's corner at a vertex.
struct Corner {
  std::uint32_t triangle = 0, k = 0;
  std::uint32_t next = 0, previous = 0;  ///< the triangle's other vertices
  Vec3 weighted = Vec3::Zero();          ///< the face's normal times its angle at the vertex
};

/// The unit direction of a smooth rim, at which a curved surface ends, at a vertex: that of the parabola
/// through the vertex and its neighbours on the rim. Returns nothing if the surface continues around the
/// vertex, or if the rim has a corner there.
std::optional<Vec3> rimDirection(std::span<const Corner* const> fan, const std::vector<Vec3>& vertices,
                                 const Vec3& at) {
  std::uint32_t ends[2] = {0, 0};
  int count[2] = {0, 0};
  for (const Corner* c : fan) {
    bool is_first = true, is_last = true;
    for (const Corner* other : fan) {
      is_first = is_first && other->previous != c->next;
      is_last = is_last && other->next != c->previous;
    }
    if (is_first && ++count[0] == 1) ends[0] = c->next;
    if (is_last && ++count[1] == 1) ends[1] = c->previous;
  }
  if (count[0] != 1 || count[1] != 1) return {};
  const Vec3 before = at - vertices[ends[0]], after = vertices[ends[1]] - at;
  if (!(before.dot(after) > kCosSmooth * before.norm() * after.norm())) return {};
  return unitOrZero(before / before.squaredNorm() + after / after.squaredNorm());
}

}  // namespace

void MeshDistance::computeSmoothCorners() {
  // Corners by vertex: first[v] to first[v + 1].
  std::vector<std::size_t> first(mesh_.vertices.size() + 1, 0);
  for (const auto& t : mesh_.triangles)
    for (const std::uint32_t v : t) ++first[v + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<Corner> corners(3 * mesh_.triangles.size());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto& t = mesh_.triangles[i];
      const std::uint32_t a = t[(k + 1) % 3], b = t[(k + 2) % 3];
      const Vec3& at = mesh_.vertices[t[k]];
      const double angle_rad = angleBetween(mesh_.vertices[a] - at, mesh_.vertices[b] - at);
      corners[next[t[k]]++] = {i, k, a, b, angle_rad * face_normals_[i]};
    }
  smooth_corners_.resize(mesh_.triangles.size());
  std::vector<const Corner*> fan;
  StridedPoll poll;
  for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
    poll();
    const std::span around(corners.data() + first[v], first[v + 1] - first[v]);
    for (const Corner& own : around) {
      const Vec3& face = face_normals_[own.triangle];
      fan.assign(1, &own);
      Vec3 sum = around.size() > kMaxFaces ? face : own.weighted;
      for (const Corner& other : around)
        if (around.size() <= kMaxFaces && &other != &own &&
            face.dot(face_normals_[other.triangle]) > kCosSmooth) {
          sum += other.weighted;
          fan.push_back(&other);
        }
      // At a rim the facets' angles are a poor weight: on a thread's flank the angles before a vertex are
      // wider than those after it. The mean normal leant by 0.003 rad along the thread, which drove a
      // frictionless screw with 5 % more than its torque. But the rim lies in the surface, so the surface's
      // normal is normal to the rim.
      Vec3 n = unitOrZero(sum);
      if (const auto rim = rimDirection(fan, mesh_.vertices, mesh_.vertices[v]); rim && fan.size() > 1)
        n = unitOrZero(n - n.dot(*rim) * *rim);
      smooth_corners_[own.triangle][own.k] = n.cast<float>();
    }
  }
}

Vec3 MeshDistance::smoothNormal(std::uint32_t triangle, const Vec3& q) const noexcept {
  const auto& t = mesh_.triangles[triangle];
  const Vec3& face = face_normals_[triangle];
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 to_a = mesh_.vertices[t[(k + 1) % 3]] - q, to_b = mesh_.vertices[t[(k + 2) % 3]] - q;
    // The corner's barycentric coordinate times twice the area; rounding may move q slightly outside.
    sum += std::max(0.0, face.dot(to_a.cross(to_b))) * smooth_corners_[triangle][k].cast<double>();
  }
  const double length = sum.norm();
  return length > 0 ? Vec3(sum / length) : face;
}

Mat3 MeshDistance::smoothCurvature(std::uint32_t triangle) const noexcept {
  if (is_thin_[triangle] != 0) return Mat3::Zero();
  const auto& t = mesh_.triangles[triangle];
  const Vec3& face = face_normals_[triangle];
  const Vec3 e1 = mesh_.vertices[t[1]] - mesh_.vertices[t[0]],
             e2 = mesh_.vertices[t[2]] - mesh_.vertices[t[0]];
  const double twice_area_m2 = face.dot(e1.cross(e2));
  if (!(twice_area_m2 > 0)) return Mat3::Zero();
  const auto turn = [&](int corner) -> Vec3 {
    const auto& corners = smooth_corners_[triangle];
    return (corners[static_cast<std::size_t>(corner)] - corners[0]).cast<double>();
  };
  // The dual vectors of the edges give a displacement in the triangle as fractions of the edges.
  const Mat3 S =
      (turn(1) * e2.cross(face).transpose() + turn(2) * face.cross(e1).transpose()) / twice_area_m2;
  const Mat3 along = Mat3::Identity() - face * face.transpose();
  return along * (0.5 * (S + S.transpose())) * along;
}

}  // namespace vps
