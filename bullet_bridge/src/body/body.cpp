// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/body.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "log/report.h"
#include "vps/friction.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/tune.h"

namespace vps::bullet::inline v0 {

namespace {

void say(const Mesh& mesh, const PartModel& part, const Resolution& chosen, const BodySettings& settings,
         double build_s) {
  const Vec3 size = bounds(mesh).size();
  char words[300];
  std::snprintf(
      words, sizeof words,
      "%s of %.3g x %.3g x %.3g mm: voxel %.3g mm, spacing %.3g mm, %zu points (budget %zu), %.1f MB, "
      "built in %.2g s; BodySettings::fidelity chooses otherwise",
      settings.name.c_str(), 1e3 * size.x(), 1e3 * size.y(), 1e3 * size.z(), 1e3 * chosen.voxel_m,
      1e3 * chosen.spacing_m, part.shell->size(), settings.point_budget,
      1e-6 * static_cast<double>(part.map->memoryBytes() + part.shell->memoryBytes()), build_s);
  report(LogLevel::Info, words);
}

}  // namespace

Resolution resolutionFor(const Mesh& mesh, std::size_t point_budget) {
  if (point_budget < 100) throw std::invalid_argument("resolutionFor: a budget below 100 points");
  double area_m2 = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    area_m2 += 0.5 * (b - a).cross(c - a).norm();
  }
  if (!(area_m2 > 0) || !std::isfinite(area_m2))
    throw std::invalid_argument("resolutionFor: the mesh has no area");
  Resolution resolution;
  resolution.spacing_m = std::sqrt(area_m2 / static_cast<double>(point_budget));
  resolution.voxel_m = 0.5 * resolution.spacing_m;  // as in all presets
  return resolution;
}

void setMaterial(btCollisionObject& body, const Material& material) {
  body.setFriction(toBt(frictionFactor(material.friction)));
  // As for friction: two bodies of one material bounce as that material does.
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
  const auto start = std::chrono::steady_clock::now();
  const Resolution chosen = settings.fidelity
                                ? Resolution{settings.fidelity->voxel_m, settings.fidelity->spacing_m}
                                : resolutionFor(mesh, settings.point_budget);
  VoxMapSettings voxels;
  voxels.voxel_m = chosen.voxel_m;
  PointShellSettings points;
  points.spacing_m = chosen.spacing_m;
  Body body;
  body.model = buildPartModel(settings.name, mesh, voxels, points, settings.material);
  body.frame = makeBodyFrame(massProperties(*body.model->mesh), settings.material.density_kg_m3);
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

}  // namespace vps::bullet::inline v0
