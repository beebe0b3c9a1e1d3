// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/shape.h"

#include <stdexcept>

#include "shape/sheet_border.h"

namespace vps::bullet {

namespace {

std::shared_ptr<const Mesh> scaled(const Mesh& mesh, double factor) {
  auto larger = std::make_shared<Mesh>(mesh);
  for (Vec3& p : larger->vertices) p *= factor;
  return larger;
}

ShellBlock scaled(const ShellBlock& from, double factor) {
  ShellBlock block = from;
  for (double& c : block.center) c *= factor;
  block.radius_m *= factor * (1 + 1e-6);  // margin for the rounding of the scaled offsets
  const auto f = static_cast<float>(factor);
  for (int i = 0; i < kLanes; ++i) {
    block.x[i] *= f;
    block.y[i] *= f;
    block.z[i] *= f;
    block.weight[i] *= block.is_leaf != 0 ? f * f : f * (1 + 1e-6f);  // areas, or radii
  }
  return block;
}

std::shared_ptr<const PointShell> scaled(const PointShell& shell, double factor) {
  auto larger = std::make_shared<PointShell>(shell);
  for (Vec3& p : larger->points) p *= factor;
  for (double& area_m2 : larger->area_m2) area_m2 *= factor * factor;
  for (ShellNode& node : larger->nodes) {
    node.center *= factor;
    node.radius_m *= factor * (1 + 1e-12);
  }
  for (ShellBlock& block : larger->blocks) block = scaled(block, factor);
  larger->spacing_m *= factor;
  return larger;
}

std::vector<Surface> scaled(const std::vector<Surface>& surfaces, double factor) {
  std::vector<Surface> larger;
  for (const Surface& surface : surfaces) {
    const auto solid = std::make_shared<const Solid>(surface.distance->scaled(factor));
    const auto border = surface.sheet ? std::make_shared<const SheetBorder>(solid->mesh()) : nullptr;
    larger.push_back({solid, Pose(surface.X_MP.R, factor * surface.X_MP.p), border, surface.material});
  }
  return larger;
}

// Builds the map from the models in `larger`, which are scaled already.
std::shared_ptr<const VoxMap> scaled(const VoxMap& map, const ShapeModels& larger, double factor) {
  VoxMapSettings settings;
  settings.voxel_m = factor * map.voxel_m();
  settings.band_voxels = map.band_m() / map.voxel_m();
  const std::vector<Surface>& parts = larger.surfaces;
  if (parts.empty() && !larger.mesh)
    throw std::invalid_argument(
        "Shape: a map cannot be scaled without the mesh it was built from; set ShapeModels::mesh");
  if (parts.size() == 1 && parts[0].X_MP.R.isIdentity(0) && parts[0].X_MP.p.isZero(0))
    return std::make_shared<const VoxMap>(buildVoxMap(*parts[0].distance, settings));
  if (parts.empty()) return std::make_shared<const VoxMap>(buildVoxMap(*larger.mesh, settings));
  std::vector<PlacedSolid> placed;
  for (const Surface& part : parts) placed.push_back({part.distance.get(), part.X_MP});
  return std::make_shared<const VoxMap>(cookVoxMap(placed, settings));
}

}  // namespace

ShapeModels Shape::atScale(const ShapeModels& models, double factor) {
  ShapeModels larger;
  if (models.mesh) larger.mesh = scaled(*models.mesh, factor);
  if (models.shell) larger.shell = scaled(*models.shell, factor);
  larger.surfaces = scaled(models.surfaces, factor);
  if (models.map) larger.map = scaled(*models.map, larger, factor);
  return larger;
}

}  // namespace vps::bullet
