// SPDX-License-Identifier: BSD-3-Clause
#include "vps/mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/mesh_edges.h"
#include "vps/errors.h"

namespace vps {
namespace {

Vec3 areaVector(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const Vec3& a = mesh.vertices[t[0]];
  return 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}

}  // namespace

Box bounds(const Mesh& mesh) {
  Box box;
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t i : t) box.add(mesh.vertices[i]);
  return box;
}

std::vector<Box> triangleBoxes(const Mesh& mesh) {
  std::vector<Box> boxes(mesh.triangles.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (const std::uint32_t v : mesh.triangles[i]) boxes[i].add(mesh.vertices[v]);
  return boxes;
}

double area(const Mesh& mesh) {
  double sum_m2 = 0;
  for (const auto& t : mesh.triangles) sum_m2 += areaVector(mesh, t).norm();
  return sum_m2;
}

MassProperties massProperties(const Mesh& mesh) {
  // Sums over tetrahedra from a point in the middle of the body to each triangle. From a point far from the
  // body the terms would cancel.
  const Vec3 o = bounds(mesh).center();
  double det_sum = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - o, b = mesh.vertices[t[1]] - o, c = mesh.vertices[t[2]] - o;
    const double det = a.dot(b.cross(c));  // six times the signed volume
    const Vec3 s = a + b + c;
    det_sum += det;
    first += det * s;
    second += det * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
  MassProperties mass;
  mass.volume_m3 = det_sum / 6;
  if (mass.volume_m3 == 0) return mass;
  const Vec3 com = first / 24 / mass.volume_m3;
  const Mat3 moments = second / 120 - mass.volume_m3 * com * com.transpose();
  mass.com = o + com;
  mass.inertia_m5 = moments.trace() * Mat3::Identity() - moments;
  return mass;
}

Mesh transformed(const Mesh& mesh, const Pose& X_AB) {
  Mesh moved = mesh;
  for (Vec3& p : moved.vertices) p = X_AB * p;
  return moved;
}

void append(Mesh& a, const Mesh& b) {
  const auto offset = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  a.triangles.reserve(a.triangles.size() + b.triangles.size());
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
}

bool isDegenerate(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
  if (hasRepeatedCorner(t)) return true;
  double longest_m2 = 0;
  for (int i = 0; i < 3; ++i)
    longest_m2 = std::max(longest_m2, (mesh.vertices[t[i]] - mesh.vertices[t[(i + 1) % 3]]).squaredNorm());
  // Height below 1e-12 of the longest edge: the normal is rounding noise.
  return 2 * areaVector(mesh, t).norm() <= 1e-12 * longest_m2;
}

MeshReport checkMesh(const Mesh& mesh) {
  return checkMesh(mesh, sortedHalfEdges(mesh));
}

MeshReport checkMesh(const Mesh& mesh, const std::vector<HalfEdge>& edges,
                     std::vector<std::uint32_t>* shell_of) {
  MeshReport report;
  report.triangles = mesh.triangles.size();
  for (const auto& t : mesh.triangles) report.degenerate_triangles += isDegenerate(mesh, t);

  const auto opposite = [&](const HalfEdge& e) { return mesh.triangles[e.triangle][(e.side + 2) % 3]; };
  bool has_duplicates = false;
  Groups groups(mesh.triangles.size());
  forEachEdge(edges, [&](std::span<const HalfEdge> same) {
    for (const HalfEdge& e : same.subspan(1)) groups.join(e.triangle, same.front().triangle);
    if (same.size() == 1) ++report.open_edges;
    if (same.size() == 2 && same[0].is_forward == same[1].is_forward) ++report.flipped_edges;
    if (same.size() > 2) ++report.non_manifold_edges;
    // Duplicates share their edges, so most meshes need no second sort.
    for (std::size_t i = 1; i < same.size(); ++i)
      has_duplicates |= opposite(same[i]) == opposite(same[i - 1]) || same.size() > 2;
  });
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    report.shells += groups.find(i) == i && !hasRepeatedCorner(mesh.triangles[i]);
  if (shell_of != nullptr && report.shells > 1) *shell_of = groups.numbered();
  if (shell_of != nullptr && report.shells <= 1) shell_of->assign(mesh.triangles.size(), 0);
  if (has_duplicates)
    forEachTwin(mesh.triangles,
                [&](std::span<const Twin> same) { report.duplicate_triangles += same.size() - 1; });
  return report;
}

void requireUsable(const Mesh& mesh, const std::string& file, const std::string& part) {
  if (mesh.triangles.empty())
    throw LoadError(file, part, "the mesh has no triangles; export it as a triangle mesh");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (!mesh.vertices[i].allFinite())
      throw LoadError(file, part,
                      "vertex " + std::to_string(i) +
                          (mesh.vertices[i].hasNaN() ? " is not a number" : " is infinite") +
                          "; export it again");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t v : mesh.triangles[i])
      if (v >= mesh.vertices.size())
        throw LoadError(file, part,
                        "triangle " + std::to_string(i) + " names vertex " + std::to_string(v) + " of " +
                            std::to_string(mesh.vertices.size()) + "; export it again");
  const double area_m2 = area(mesh);
  if (!std::isfinite(area_m2))
    throw LoadError(file, part, "the mesh is too large for its area to be computed; check its unit");
  if (!(area_m2 > 0))
    throw LoadError(file, part, "the mesh has zero area: all triangles are points or lines; export it again");
}

namespace {

Vec3 faceNormal(const Mesh& mesh, std::uint32_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const Vec3& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).normalized();
}

}  // namespace

std::vector<std::array<std::uint32_t, 2>> sharpEdges(const Mesh& mesh, double angle_rad) {
  std::vector<std::array<std::uint32_t, 2>> sharp;
  const double greatest_cos = std::cos(angle_rad);
  forEachEdge(sortedHalfEdges(mesh), [&](std::span<const HalfEdge> sides) {
    const bool is_smooth =
        sides.size() == 2 &&
        faceNormal(mesh, sides[0].triangle).dot(faceNormal(mesh, sides[1].triangle)) >= greatest_cos;
    if (!is_smooth) sharp.push_back({sides[0].low, sides[0].high});
  });
  return sharp;
}

}  // namespace vps
