// SPDX-License-Identifier: BSD-3-Clause
#include "vps/part_model.h"

#include <utility>

#include "mesh/interior.h"
#include "mesh/open_mesh.h"

namespace vps {

namespace {

void buildSheet(PartModel& model, Mesh mesh, const PointShellSettings& points) {
  auto solid = std::make_shared<const Solid>(Solid::sheet(sheetSurface(mesh)));
  model.shell = std::make_shared<const PointShell>(buildPointShell(*solid, points, model.name));
  model.mesh = std::make_shared<const Mesh>(std::move(mesh));
  model.solid = std::move(solid);
}

}  // namespace

std::shared_ptr<const PartModel> buildPartModel(const std::string& name, Mesh mesh,
                                                const VoxMapSettings& voxels,
                                                const PointShellSettings& points, const Material& material,
                                                OpenMesh open) {
  auto model = std::make_shared<PartModel>();
  model->name = name;
  model->material = material;
  requireUsable(mesh, "", name);
  if (open == OpenMesh::Sheet && isOpenSurface(mesh, points.spacing_m)) {
    buildSheet(*model, std::move(mesh), points);
    return model;
  }
  auto solid = std::make_shared<const Solid>(mesh, name);
  model->map = std::make_shared<const VoxMap>(buildVoxMap(*solid, voxels, name));
  model->shell = std::make_shared<const PointShell>(buildPointShell(*solid, points, name));
  const bool was_turned = solid->report().flipped_facets + solid->report().turned_shells > 0;
  if (was_turned) mesh = solid->interior() != nullptr ? solid->interior()->mesh() : solid->mesh();
  model->mesh = std::make_shared<const Mesh>(std::move(mesh));
  model->solid = std::move(solid);
  return model;
}

std::shared_ptr<const PartModel> withShell(const PartModel& model, std::shared_ptr<const PointShell> shell) {
  auto other = std::make_shared<PartModel>(model);
  other->shell = std::move(shell);
  return other;
}

}  // namespace vps
