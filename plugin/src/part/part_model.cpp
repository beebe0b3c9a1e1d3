// SPDX-License-Identifier: BSD-3-Clause
#include "vps/part_model.h"

#include <utility>

namespace vps::inline v0 {

std::shared_ptr<const MeshDistance> buildSurface(const Mesh& mesh) {
  return mesh.triangles.empty() ? nullptr : std::make_shared<const MeshDistance>(welded(mesh));
}

std::shared_ptr<const PartModel> buildPartModel(const std::string& name, Mesh mesh,
                                                const VoxMapSettings& voxels,
                                                const PointShellSettings& points, const Material& material) {
  auto model = std::make_shared<PartModel>();
  model->name = name;
  model->material = material;
  model->map = std::make_shared<const VoxMap>(buildVoxMap(mesh, voxels, name));
  model->shell = std::make_shared<const PointShell>(buildPointShell(mesh, points, name));
  model->surface = buildSurface(mesh);
  model->mesh = std::make_shared<const Mesh>(std::move(mesh));
  return model;
}

std::shared_ptr<const PartModel> withShell(const PartModel& model, std::shared_ptr<const PointShell> shell) {
  auto other = std::make_shared<PartModel>(model);
  other->shell = std::move(shell);
  return other;
}

}  // namespace vps::inline v0
