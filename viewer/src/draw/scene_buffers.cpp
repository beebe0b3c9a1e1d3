// SPDX-License-Identifier: BSD-3-Clause
#include "draw/scene_buffers.h"

#include <cstddef>

#include "draw/coarse_mesh.h"

namespace vps::viewer::inline v0 {

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
  std::vector<std::array<float, 3>> out(shading.sources.size(), {1, 1, 1});
  if (by_vertex == nullptr) return out;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = by_vertex->at(shading.sources[i]);
  return out;
}

}  // namespace

GpuMesh::GpuMesh(const Mesh& mesh, const std::vector<std::array<float, 3>>* vertex_colors,
                 double coarse_share)
    : bounds_P(bounds(mesh)),
      shading(buildShadingMesh(mesh)),
      vertices(gl::makeBuffer(std::span<const ShadingVertex>(shading.vertices))),
      colors(gl::makeBuffer(std::span<const std::array<float, 3>>(colorsOf(shading, vertex_colors)))),
      indices(gl::makeBuffer(std::span<const std::uint32_t>(shading.indices))),
      array(gl::makeVertexArray()),
      coarse_array(gl::makeVertexArray()),
      sharp_edges(shading.sharp_edges),
      index_count(static_cast<GLsizei>(shading.indices.size())) {
  const std::vector<std::uint32_t> coarse =
      coarseIndices(shading, static_cast<std::size_t>(coarse_share * index_count / 3));
  coarse_indices = gl::makeBuffer(std::span<const std::uint32_t>(coarse));
  coarse_count = static_cast<GLsizei>(coarse.size());
  for (const gl::VertexArray* each : {&array, &coarse_array}) {
    gl::addAttribute(*each, vertices, 0, 3, offsetof(ShadingVertex, p), sizeof(ShadingVertex));
    gl::addAttribute(*each, vertices, 1, 3, offsetof(ShadingVertex, n), sizeof(ShadingVertex));
    gl::addAttribute(*each, colors, 2, 3, 0, sizeof(std::array<float, 3>));
  }
  glVertexArrayElementBuffer(array.id(), indices.id());
  glVertexArrayElementBuffer(coarse_array.id(), coarse_indices.id());
}

void GpuMesh::draw(bool is_coarse) const {
  glBindVertexArray(is_coarse ? coarse_array.id() : array.id());
  glDrawElements(GL_TRIANGLES, is_coarse ? coarse_count : index_count, GL_UNSIGNED_INT, nullptr);
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

}  // namespace vps::viewer::inline v0
