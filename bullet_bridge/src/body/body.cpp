// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/body.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>
#include <vector>

#include "log/report.h"
#include "vps/friction.h"
#include "vps/mesh_repair.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/tune.h"

namespace vps::bullet {

namespace {

void say(const Mesh& mesh, const PartModel& part, const Resolution& chosen, const BodySettings& settings,
         double build_s) {
  const Vec3 size = bounds(mesh).size();
  char words[300];
  std::snprintf(
      words, sizeof words,
      "%s of %.3g x %.3g x %.3g mm: voxel %.3g mm, spacing %.3g mm, %zu points (budget %zu), %.1f MB, "
      "built in %.2g s; set BodySettings::fidelity for other values",
      settings.name.c_str(), 1e3 * size.x(), 1e3 * size.y(), 1e3 * size.z(), 1e3 * chosen.voxel_m,
      1e3 * chosen.spacing_m, part.shell->size(), settings.point_budget,
      1e-6 * static_cast<double>((part.map ? part.map->memoryBytes() : 0) + part.shell->memoryBytes()),
      build_s);
  report(LogLevel::Info, words);
}

void sayIfSheet(const PartModel& part) {
  if (part.solid->isSheet())
    report(LogLevel::Info,
           part.name +
               " has holes wider than the spacing of its points, so it is a sheet: it collides from both "
               "sides and has no inside. If facets are missing, BodySettings::open_mesh = "
               "OpenMesh::Solid closes the holes");
}

void requireUsable(const Material& material) {
  if (!(material.friction >= 0) || !std::isfinite(material.friction))
    throw std::invalid_argument("a material's friction must be 0 or more and finite, not " +
                                std::to_string(material.friction));
  if (!(material.restitution >= 0 && material.restitution <= 1))
    throw std::invalid_argument("a material's restitution must lie between 0 and 1, not " +
                                std::to_string(material.restitution));
}

void requireUsable(const BodySettings& settings) {
  requireUsable(settings.material);
  const Mat3& R = settings.X_WP.R;
  constexpr double kRounding = 1e-5;  // error of a product of a few rotations in single precision
  if (!settings.X_WP.isFinite() || !((R.transpose() * R - Mat3::Identity()).norm() < kRounding) ||
      R.determinant() < 0)
    throw std::invalid_argument("makeBody: X_WP of '" + settings.name +
                                "' must be finite and have a rotation matrix");
}

/// Mass properties of the part with flat lids over the holes of an open mesh. Without its lid a box would
/// lack up to a third of its volume.
MassProperties massWithLids(const PartModel& part, const std::string& name) {
  const bool has_inside = part.solid && !part.solid->isSheet();
  const MassProperties whole = has_inside ? part.solid->mass() : solidMass(*part.mesh, name);
  if (lidsOf(welded(*part.mesh)).triangles.empty()) return whole;
  if (std::abs(whole.volume_m3 - massProperties(*part.mesh).volume_m3) > 1e-3 * std::abs(whole.volume_m3))
    report(LogLevel::Warning,
           name + " has an open mesh: its mass is that of the part with flat lids on the holes");
  return whole;
}

/// Mass and frame of the body. A fixed body needs no mass: if its part has no volume, as a sheet, the body
/// has the mesh's frame.
BodyFrame frameOf(const PartModel& part, const BodySettings& settings) {
  const MassProperties mass = massWithLids(part, settings.name);
  const double density_kg_m3 = settings.material.density_kg_m3;
  const bool has_mass = mass.volume_m3 > 0 && density_kg_m3 > 0 && std::isfinite(density_kg_m3);
  return settings.is_fixed && !has_mass ? BodyFrame{} : makeBodyFrame(mass, density_kg_m3);
}

}  // namespace

Resolution resolutionFor(const Mesh& mesh, std::size_t point_budget) {
  if (point_budget < 100)
    throw std::invalid_argument("resolutionFor: point_budget must be at least 100, not " +
                                std::to_string(point_budget));
  double area_m2 = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    area_m2 += 0.5 * (b - a).cross(c - a).norm();
  }
  if (!(area_m2 > 0) || !std::isfinite(area_m2))
    throw std::invalid_argument("resolutionFor: the mesh has no area");
  Resolution resolution;
  resolution.spacing_m = std::sqrt(area_m2 / static_cast<double>(point_budget));
  resolution.voxel_m = 0.5 * resolution.spacing_m;  // half of the spacing, as in all presets
  return resolution;
}

void setMaterial(btCollisionObject& body, const Material& material) {
  requireUsable(material);
  body.setFriction(toBt(frictionFactor(material.friction)));
  // The square root makes two bodies of one material bounce as that material does, as with friction.
  body.setRestitution(toBt(std::sqrt(material.restitution)));
}

void PartMotionState::getWorldTransform(btTransform& X_WB) const {
  X_WB = toBt(X_WP_ * X_PB_);
}

void PartMotionState::setWorldTransform(const btTransform& X_WB) {
  X_WP_ = fromBt(X_WB) * X_PB_.inverse();
}

Pose Body::X_WP() const {
  return fromBt(rigid->getWorldTransform()) * frame.X_PB.inverse();
}

Body makeBody(const Mesh& mesh, const BodySettings& settings) {
  requireUsable(settings);
  const auto start = std::chrono::steady_clock::now();
  const Resolution chosen = settings.fidelity
                                ? Resolution{settings.fidelity->voxel_m, settings.fidelity->spacing_m}
                                : resolutionFor(mesh, settings.point_budget);
  VoxMapSettings voxels;
  voxels.voxel_m = chosen.voxel_m;
  PointShellSettings points;
  points.spacing_m = chosen.spacing_m;
  Body body;
  body.model = buildPartModel(settings.name, mesh, voxels, points, settings.material, settings.open_mesh);
  sayIfSheet(*body.model);
  body.frame = frameOf(*body.model, settings);
  body.shape = std::make_shared<Shape>(makeModels(*body.model), body.frame.X_PB.inverse());
  body.motion = std::make_unique<PartMotionState>(settings.X_WP, body.frame.X_PB);
  const btRigidBody::btRigidBodyConstructionInfo info(
      toBt(settings.is_fixed ? 0 : body.frame.mass_kg), body.motion.get(), body.shape.get(),
      settings.is_fixed ? btVector3(0, 0, 0) : toBt(body.frame.inertia_kg_m2));
  body.rigid = std::make_unique<btRigidBody>(info);
  setMaterial(*body.rigid, settings.material);
  if (!settings.is_fixed) tuneBody(*body.rigid);
  if (!settings.fidelity)
    say(mesh, *body.model, chosen, settings,
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return body;
}

Body makeBody(const btStridingMeshInterface& triangles, const BodySettings& settings) {
  return makeBody(meshOf(triangles), settings);
}

}  // namespace vps::bullet
