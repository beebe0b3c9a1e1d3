// SPDX-License-Identifier: BSD-3-Clause
#include "models/fixed_field.h"

#include <algorithm>

#include "core/machine.h"
#include "models/scene_models.h"
#include "vps/box.h"
#include "vps/friction.h"
#include "vps/pointshell.h"
#include "vps/voxmap.h"

namespace vps::scenes {

namespace {

bool isInPlace(const Pose& X_WP) {
  return X_WP.R.isIdentity(0) && X_WP.p.isZero(0);
}

PlacedSolid placedSolid(const FieldPart& part) {
  return {part.model->solid.get(), part.placed.X_WP};
}

/// The first part's map in W: the part's own map if the part's frame is W, else a new one.
std::shared_ptr<const VoxMap> firstMap(const FieldPart& part, const FieldOrder& order) {
  if (part.model->map && !order.rebuilds_maps && isInPlace(part.placed.X_WP)) return part.model->map;
  VoxMap map = cookVoxMap({placedSolid(part)}, voxMapSettings(order.fidelity));
  if (part.kept_P.empty()) return std::make_shared<VoxMap>(std::move(map));
  std::vector<Box> kept_W;
  for (const Box& box : part.kept_P) kept_W.push_back(moved(box, part.placed.X_WP));
  return std::make_shared<VoxMap>(croppedVoxMap(map, kept_W));
}

bool isStopped(const FieldOrder& order) {
  return order.stop != nullptr && order.stop->load();
}

std::shared_ptr<const VoxMap> mapOf(const FieldOrder& order) {
  std::shared_ptr<const VoxMap> map = order.below;
  for (std::size_t i = map ? order.below_count : 0; i < order.parts.size() && !isStopped(order); ++i) {
    const FieldPart& part = order.parts[i];
    map = map ? std::make_shared<VoxMap>(mountVoxMap(*map, placedSolid(part))) : firstMap(part, order);
  }
  return map;
}

std::shared_ptr<const PointShell> shellOf(const FieldOrder& order) {
  std::vector<PointShell> cropped;
  std::vector<const PointShell*> shells;
  std::vector<Pose> poses;
  cropped.reserve(order.parts.size());  // no reallocation: `shells` points into `cropped`
  for (const FieldPart& part : order.parts) {
    poses.push_back(part.placed.X_WP);
    shells.push_back(part.model->shell.get());
    if (!order.region_W) continue;
    const Box region_P = moved(*order.region_W, part.placed.X_WP.inverse());
    shells.back() = &cropped.emplace_back(croppedShell(*part.model->shell, {region_P}));
  }
  return std::make_shared<PointShell>(mergedShells(shells, poses));
}

std::shared_ptr<const Mesh> meshOf(const FieldOrder& order) {
  Mesh mesh;
  for (const FieldPart& part : order.parts) append(mesh, transformed(*part.model->mesh, part.placed.X_WP));
  return std::make_shared<Mesh>(std::move(mesh));
}

}  // namespace

bullet::SurfaceMaterial surfaceMaterial(const Material& material) {
  return {frictionFactor(material.friction), material.restitution, material.stiffness_N_per_m3};
}

bullet::ShapeModels shapeModels(const PartModel& model) {
  bullet::ShapeModels models = bullet::makeModels(model);
  for (bullet::Surface& surface : models.surfaces) surface.material = surfaceMaterial(model.material);
  return models;
}

std::size_t CookedField::memoryBytes(const std::vector<std::shared_ptr<const VoxMap>>& own) const {
  if (!shape) return 0;
  const bullet::ShapeModels& models = shape->models();
  std::size_t bytes = models.map->memoryBytes();
  for (const auto& map : own)
    if (map) bytes = std::min(bytes, models.map->additionalMemoryBytes(*map));
  return bytes + (models.shell ? models.shell->memoryBytes() : 0);
}

CookedField cookField(const FieldOrder& order) {
  const double begun_s = wallSeconds();
  CookedField field;
  field.region_W = order.region_W;
  if (order.parts.empty()) return field;
  bullet::ShapeModels models;
  models.map = mapOf(order);
  if (isStopped(order)) return field;
  if (order.has_shell) models.shell = shellOf(order);
  if (order.has_mesh) models.mesh = meshOf(order);
  for (const FieldPart& part : order.parts) {
    field.parts.push_back(part.placed);
    models.surfaces.push_back(
        {part.model->solid, part.placed.X_WP, nullptr, surfaceMaterial(part.model->material)});
  }
  field.shape = std::make_unique<bullet::Shape>(std::move(models));
  field.wall_s = wallSeconds() - begun_s;
  return field;
}

}  // namespace vps::scenes
