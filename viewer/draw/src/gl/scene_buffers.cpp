// SPDX-License-Identifier: BSD-3-Clause
#include "gl/scene_buffers.h"

#include <algorithm>
#include <cstddef>

#include "mesh/coarse_mesh.h"

namespace vps::viewer {

GpuLines::GpuLines(std::span<const ShadingEdge> segments)
    : buffer(gl::makeBuffer(segments)),
      array(gl::makeVertexArray()),
      count(static_cast<GLsizei>(segments.size())) {
  gl::addAttribute(array, buffer, 0, 3, offsetof(ShadingEdge, a), sizeof(ShadingEdge), 1);
  gl::addAttribute(array, buffer, 1, 3, offsetof(ShadingEdge, b), sizeof(ShadingEdge), 1);
}

namespace {

std::vector<std::array<float, 3>> colorsOf(const ShadingMesh& shading,
                                           const std::vector<std::array<float, 3>>* by_vertex) {
  if (!shading.colors.empty()) return shading.colors;
  std::vector<std::array<float, 3>> out(shading.sources.size(), {1, 1, 1});
  if (by_vertex == nullptr) return out;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = by_vertex->at(shading.sources[i]);
  return out;
}

}  // namespace

GpuMesh::GpuMesh(const DrawnMesh& part, std::size_t scene_triangles)
    : bounds_P(bounds(*part.mesh)),
      shading(buildShadingMesh(*part.mesh, kCreaseAngle_rad, part.face_colors)),
      has_face_colors(!shading.colors.empty()),
      vertices(gl::makeBuffer(std::span<const ShadingVertex>(shading.vertices))),
      colors(gl::makeBuffer(std::span<const std::array<float, 3>>(colorsOf(shading, part.vertex_colors)))),
      sharp_edges(shading.sharp_edges) {
  const std::size_t triangles = shading.indices.size() / 3;
  CoarseMesh coarse(shading);
  const auto coarser = [&](std::size_t most) {
    const double share = double(most) / static_cast<double>(std::max(most, scene_triangles));
    return indicesOf(coarse.indices(static_cast<std::size_t>(share * static_cast<double>(triangles))));
  };
  details_ = {indicesOf(shading.indices), coarser(kShadowTriangles), coarser(kDraftTriangles)};
  addLevels(coarse);
}

void GpuMesh::addLevels(CoarseMesh& coarse) {
  // A mesh with fewer triangles is cheap to draw and gets no coarser levels (assumed).
  constexpr std::size_t kFewest = 5000;
  // Grid cells along the diagonal of the part's box, for each level.
  constexpr std::array<double, 5> kCells = {24, 34, 48, 68, 96};
  // A level is kept if it has at most this share of the previous level's triangles.
  constexpr double kWorthwhile = 0.7;
  std::size_t before = shading.indices.size();
  if (before / 3 < kFewest) return;
  for (auto cells = kCells.rbegin(); cells != kCells.rend(); ++cells) {
    const double cell_m = bounds_P.size().norm() / *cells;
    const std::vector<std::uint32_t> fewer = coarse.smoothedIndices(cell_m);
    if (static_cast<double>(fewer.size()) > kWorthwhile * static_cast<double>(before)) continue;
    before = fewer.size();
    levels_.insert(levels_.begin(), {cell_m, indicesOf(fewer)});
  }
}

void GpuMesh::drawAt(double px_per_m) const {
  constexpr double kCell_px = 8;  // the surface then moves by about a tenth of a pixel, see CoarseMesh
  const auto level =
      std::ranges::find_if(levels_, [&](const Level& each) { return each.cell_m * px_per_m < kCell_px; });
  const Indices& drawn = level == levels_.end() ? of(Detail::Full) : level->indices;
  glBindVertexArray(drawn.array.id());
  glDrawElements(GL_TRIANGLES, drawn.count, GL_UNSIGNED_INT, nullptr);
}

GpuMesh::Indices GpuMesh::indicesOf(const std::vector<std::uint32_t>& indices) const {
  Indices made = {gl::makeBuffer(std::span<const std::uint32_t>(indices)), gl::makeVertexArray(),
                  static_cast<GLsizei>(indices.size())};
  gl::addAttribute(made.array, vertices, 0, 3, offsetof(ShadingVertex, p), sizeof(ShadingVertex));
  gl::addAttribute(made.array, vertices, 1, 3, offsetof(ShadingVertex, n), sizeof(ShadingVertex));
  gl::addAttribute(made.array, colors, 2, 3, 0, sizeof(std::array<float, 3>));
  glVertexArrayElementBuffer(made.array.id(), made.buffer.id());
  return made;
}

void GpuMesh::draw(Detail detail) const {
  glBindVertexArray(of(detail).array.id());
  glDrawElements(GL_TRIANGLES, of(detail).count, GL_UNSIGNED_INT, nullptr);
}

Eigen::Matrix4f toMatrix(const Pose& X) {
  Eigen::Matrix4f m = Eigen::Matrix4f::Identity();
  m.topLeftCorner<3, 3>() = X.R.cast<float>();
  m.topRightCorner<3, 1>() = X.p.cast<float>();
  return m;
}

std::vector<ShadingEdge> outline(const ShadingMesh& mesh, const Vec3& p_eye) {
  std::vector<ShadingEdge> edges;
  const Eigen::Vector3f eye = p_eye.cast<float>();
  using Map = Eigen::Map<const Eigen::Vector3f>;
  for (const SmoothEdge& e : mesh.smooth_edges) {
    const Eigen::Vector3f to_eye = eye - Map(e.edge.a.data());
    if ((Map(e.n_left.data()).dot(to_eye) > 0) != (Map(e.n_right.data()).dot(to_eye) > 0))
      edges.push_back(e.edge);
  }
  return edges;
}

}  // namespace vps::viewer
