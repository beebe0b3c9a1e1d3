// SPDX-License-Identifier: BSD-3-Clause
#include "mesh/shading_mesh.h"

#include <algorithm>
#include <cmath>

#include "vps/mesh.h"

namespace vps::viewer {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Unit normals; zero for a triangle without area.
std::vector<Vec3> faceNormals(const Mesh& mesh) {
  std::vector<Vec3> normals;
  normals.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3 n =
        (mesh.vertices[t[1]] - mesh.vertices[t[0]]).cross(mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    const double length = n.norm();
    normals.push_back(length > 0 ? Vec3(n / length) : Vec3::Zero());
  }
  return normals;
}

/// The corners (3 * triangle + k) that meet at each vertex: corners[first[v]] to corners[first[v + 1]].
struct Fans {
  std::vector<std::uint32_t> first, corners;
};

Fans buildFans(const Mesh& mesh) {
  Fans fans;
  fans.first.assign(mesh.vertices.size() + 1, 0);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) ++fans.first[v + 1];
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) fans.first[v + 1] += fans.first[v];
  fans.corners.resize(fans.first.back());
  std::vector<std::uint32_t> next(fans.first.begin(), fans.first.end() - 1);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) fans.corners[next[mesh.triangles[t][k]]++] = 3 * t + k;
  return fans;
}

double cornerAngle(const Mesh& mesh, std::uint32_t corner) {
  const Triangle& t = mesh.triangles[corner / 3];
  const Vec3& p = mesh.vertices[t[corner % 3]];
  const Vec3 a = mesh.vertices[t[(corner + 1) % 3]] - p, b = mesh.vertices[t[(corner + 2) % 3]] - p;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Adds one shading vertex per vertex, smooth group around it, and colour. A corner's normal is the mean over
/// the faces whose angle to its own face is below the crease angle. Faces are weighted by their angle at the
/// vertex, so that the mean does not depend on the triangulation of flat faces.
/// @param colors  by triangle; empty: no colours
void addVertices(const Mesh& mesh, const std::vector<Vec3>& normals, const scenes::FaceColors& colors,
                 double crease_cos, ShadingMesh& out) {
  const Fans fans = buildFans(mesh);
  out.indices.resize(3 * mesh.triangles.size());
  std::vector<double> angles;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto begin = fans.corners.begin() + fans.first[v], end = fans.corners.begin() + fans.first[v + 1];
    angles.clear();
    for (auto c = begin; c != end; ++c) angles.push_back(cornerAngle(mesh, *c));
    const std::size_t group_start = out.vertices.size();
    for (auto c = begin; c != end; ++c) {
      const Vec3& own = normals[*c / 3];
      Vec3 sum = Vec3::Zero();
      for (auto other = begin; other != end; ++other)
        if (normals[*other / 3].dot(own) >= crease_cos) sum += angles[other - begin] * normals[*other / 3];
      if (sum.norm() > 0) sum.normalize();
      const std::array<float, 3> n = toFloat(sum);
      std::size_t i = group_start;
      const auto isSame = [&](std::size_t at) {
        return out.vertices[at].n == n && (colors.isNone() || out.colors[at] == colors.at(*c / 3));
      };
      while (i < out.vertices.size() && !isSame(i)) ++i;
      if (i == out.vertices.size()) {
        if (!colors.isNone()) out.colors.push_back(colors.at(*c / 3));
        out.vertices.push_back({toFloat(mesh.vertices[v] - out.center), n});
        out.sources.push_back(v);
      }
      out.indices[*c] = static_cast<std::uint32_t>(i);
    }
  }
}

void addEdges(const Mesh& mesh, const std::vector<Vec3>& normals, double crease_cos, ShadingMesh& out) {
  struct HalfEdge {
    std::uint32_t low, high, face;
    bool is_upwards;  // whether the face runs along the edge from low to high
    bool operator<(const HalfEdge& o) const {
      return low != o.low ? low < o.low : high != o.high ? high < o.high : face < o.face;
    }
  };
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh.triangles[f][k], to = mesh.triangles[f][(k + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), f, from < to});
    }
  std::sort(edges.begin(), edges.end());
  out.is_closed = massProperties(mesh).volume_m3 > 0;
  for (std::size_t i = 0, next = 0; i < edges.size(); i = next) {
    while (next < edges.size() && edges[next].low == edges[i].low && edges[next].high == edges[i].high)
      ++next;
    const ShadingEdge edge = {toFloat(mesh.vertices[edges[i].low] - out.center),
                              toFloat(mesh.vertices[edges[i].high] - out.center)};
    const Vec3& n0 = normals[edges[i].face];
    const bool is_between_two = next - i == 2;
    out.is_closed = out.is_closed && is_between_two && edges[i].is_upwards != edges[i + 1].is_upwards;
    const Vec3 n1 = is_between_two ? normals[edges[i + 1].face] : Vec3::Zero();
    if (is_between_two && (n0.isZero() || n1.isZero())) continue;  // a triangle without area has no normal
    const double cos_angle = n0.dot(n1);
    if (!is_between_two || cos_angle < crease_cos)
      out.sharp_edges.push_back(edge);
    else if (cos_angle < 1 - 1e-9)  // flat faces have no outline inside them
      out.smooth_edges.push_back({edge, toFloat(n0), toFloat(n1)});
  }
}

}  // namespace

ShadingMesh buildShadingMesh(const Mesh& mesh, double crease_rad, const scenes::FaceColors* colors) {
  const Box box = bounds(mesh);
  // Exporters repeat vertices for each face and round them differently; a ten-millionth of the size is
  // smaller than any feature.
  const WeldedMesh welded = weldedWithSources(mesh, 1e-7 * box.size().norm());
  const Mesh& shared = welded.mesh;
  const std::vector<Vec3> normals = faceNormals(shared);
  const bool has_colors = colors != nullptr && colors->of_triangle.size() == mesh.triangles.size();
  const scenes::FaceColors kept = has_colors ? ofTriangles(*colors, welded.sources) : scenes::FaceColors();
  ShadingMesh out;
  out.center = box.center();
  addVertices(shared, normals, kept, std::cos(crease_rad), out);
  addEdges(shared, normals, std::cos(crease_rad), out);
  return out;
}

std::vector<ShadingEdge> sectionSegments(const ShadingMesh& mesh, const Vec3& n, double offset) {
  std::vector<ShadingEdge> segments;
  const double local_offset = offset - n.dot(mesh.center);
  const auto height = [&](const ShadingVertex& v) { return n.dot(toVec3(v.p)) - local_offset; };
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    std::array<Vec3, 2> ends;
    int count = 0;
    for (int k = 0; k < 3 && count < 2; ++k) {
      const ShadingVertex& a = mesh.vertices[mesh.indices[i + k]];
      const ShadingVertex& b = mesh.vertices[mesh.indices[i + (k + 1) % 3]];
      const double ha = height(a), hb = height(b);
      if ((ha < 0) != (hb < 0)) ends[count++] = toVec3(a.p) + ha / (ha - hb) * (toVec3(b.p) - toVec3(a.p));
    }
    if (count == 2) segments.push_back({toFloat(ends[0]), toFloat(ends[1])});
  }
  return segments;
}

}  // namespace vps::viewer
