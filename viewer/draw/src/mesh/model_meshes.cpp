// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/draw/model_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vps/solid.h"

namespace vps::viewer {
namespace {

void addQuad(Mesh& mesh, const std::array<Vec3, 4>& corners) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

using Place = Eigen::Vector3i;

/// The cells of a grid over the map's box whose middle is inside the map.
struct Cells {
  double edge_m;
  Vec3 low_M;
  Place count;
  std::vector<bool> is_inside;

  Cells(const VoxMap& map, double edge_m) : edge_m(edge_m), low_M(map.bounds().min) {
    count = (map.bounds().size() / edge_m).array().ceil().max(1).cast<int>();
    is_inside.resize(static_cast<std::size_t>(count.x()) * count.y() * count.z());
    for (int z = 0; z < count.z(); ++z)
      for (int y = 0; y < count.y(); ++y)
        for (int x = 0; x < count.x(); ++x)
          is_inside[index({x, y, z})] =
              map.isInsideCoarse(low_M + edge_m * (Vec3(x, y, z) + Vec3::Constant(0.5)));
  }
  [[nodiscard]] std::size_t index(const Place& at) const {
    return static_cast<std::size_t>(at.x()) +
           static_cast<std::size_t>(count.x()) *
               (static_cast<std::size_t>(at.y()) + static_cast<std::size_t>(count.y()) * at.z());
  }
  [[nodiscard]] bool isInside(const Place& at) const {
    return (at.array() >= 0).all() && (at.array() < count.array()).all() && is_inside[index(at)];
  }

  template <typename Visit>
  void forEachFace(const Visit& visit) const {
    for (int z = 0; z < count.z(); ++z)
      for (int y = 0; y < count.y(); ++y)
        for (int x = 0; x < count.x(); ++x) {
          const Place at(x, y, z);
          if (!isInside(at)) continue;
          for (int axis = 0; axis < 3; ++axis)
            for (const int side : {-1, 1})
              if (!isInside(at + side * Place::Unit(axis))) visit(at, axis, side);
        }
  }
};

// Factor on the colour of every second cube, so that single cubes are visible.
constexpr float kDarker = 0.72f;
// Faces are smaller than their cube by this share, because the renderer gives all vertices at one place one
// tint.
constexpr double kInset = 1e-3;

void addFace(TintedMesh& voxels, const Cells& cells, const Place& at, int axis, int side) {
  const double half_m = 0.5 * cells.edge_m;
  const Vec3 middle_M = cells.low_M + cells.edge_m * (at.cast<double>() + Vec3::Constant(0.5));
  const Vec3 n = side * Vec3::Unit(axis), u = (1 - kInset) * half_m * Vec3::Unit((axis + 1) % 3),
             v = n.cross(u);
  const Vec3 face_M = middle_M + half_m * n;
  addQuad(voxels.mesh, {face_M - u - v, face_M + u - v, face_M + u + v, face_M - u + v});
  const float tint = at.sum() % 2 == 0 ? 1 : kDarker;
  voxels.tints.insert(voxels.tints.end(), 4, {tint, tint, tint});
}

}  // namespace

Mesh pointMesh(const PointShell& shell, double size_m) {
  Mesh mesh;
  const std::size_t count = std::min(shell.size(), kModelTriangles / 2);
  if (count == 0) return mesh;
  // If an even sampling is thinned, its spacing grows with the square root of the reduction.
  const double spacing_m = shell.spacing_m * std::sqrt(double(shell.size()) / static_cast<double>(count));
  const double reach_m = 0.5 * (size_m > 0 ? size_m : 0.6 * spacing_m);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t point = shell.order[i];
    const Vec3 n = -shell.inward[point].normalized();
    if (!n.allFinite()) continue;
    const Vec3 u = n.unitOrthogonal(), v = n.cross(u), p = shell.points[point];
    addQuad(mesh, {p + reach_m * u, p + reach_m * v, p - reach_m * u, p - reach_m * v});
  }
  return mesh;
}

TintedMesh voxelMesh(const VoxMap& map, double* cube_m) {
  TintedMesh voxels;
  if (map.bounds().isEmpty() || !(map.voxel_m() > 0)) return voxels;
  // Lower bound of the cube's size: the faces on the surface of the box alone must fit the budget.
  const Vec3 size_m = map.bounds().size();
  const double surface_m2 = 2 * (size_m.x() * size_m.y() + size_m.y() * size_m.z() + size_m.z() * size_m.x());
  const double least_m = std::sqrt(surface_m2 / (0.5 * kModelTriangles));
  int times = std::max(1, static_cast<int>(std::ceil(least_m / map.voxel_m())));
  for (;; ++times) {
    const Cells cells(map, times * map.voxel_m());
    std::size_t faces = 0;
    cells.forEachFace([&](const Place&, int, int) { ++faces; });
    if (2 * faces > kModelTriangles) continue;
    if (cube_m != nullptr) *cube_m = cells.edge_m;
    cells.forEachFace([&](const Place& at, int axis, int side) { addFace(voxels, cells, at, axis, side); });
    return voxels;
  }
}

ShownModels shownModels(const std::vector<std::string>& words) {
  const auto has = [&](const char* word) { return std::ranges::find(words, word) != words.end(); };
  return {has("points"), has("voxels")};
}

ModelView::ModelView(const scenes::Scene& scene, const ShownModels& shown, RenderScene& drawn) {
  if (shown.isNone()) return;
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const scenes::ScenePart& part = scene.parts[i];
    const bool is_moved =
        std::ranges::any_of(scene.steps, [i](const scenes::SceneStep& step) { return step.part == i; });
    const bool has_points = shown.has_points && (!shown.has_voxels || is_moved);
    const Solid solid(part.part.mesh, part.part.name);
    meshes_.push_back(std::make_unique<TintedMesh>());
    TintedMesh& model = *meshes_.back();
    const double voxel_m = part.voxel_m > 0 ? part.voxel_m : scene.fidelity.voxel_m;
    const double spacing_m = part.spacing_m > 0 ? part.spacing_m : scene.fidelity.spacing_m;
    if (has_points)
      model.mesh = pointMesh(buildPointShell(solid, {.spacing_m = spacing_m}, part.part.name));
    else
      model = voxelMesh(buildVoxMap(solid, {.voxel_m = voxel_m}, part.part.name));
    drawn[i].mesh = &model.mesh;
    if (!model.tints.empty()) drawn[i].vertex_colors = &model.tints;
  }
}

}  // namespace vps::viewer
