// SPDX-License-Identifier: BSD-3-Clause
#include "narrowphase/pair_material.h"

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include <algorithm>

namespace vps::bullet {

namespace {

const Shape* shapeWithMaterials(const btCollisionObjectWrapper& wrapper) {
  const auto* shape = dynamic_cast<const Shape*>(wrapper.getCollisionShape());
  if (!shape) return nullptr;
  const bool is_any = std::ranges::any_of(shape->models().surfaces,
                                          [](const Surface& surface) { return !surface.material.isNone(); });
  return is_any ? shape : nullptr;
}

// As btManifoldResult::calculateCombinedFriction(), which is given the bodies only.
double limitedFriction(double product) {
  constexpr double kMost = 10;
  return std::clamp(product, -kMost, kMost);
}

}  // namespace

PairMaterial::PairMaterial(const btCollisionObjectWrapper* const (&bodies)[2])
    : object_{bodies[0]->getCollisionObject(), bodies[1]->getCollisionObject()},
      shape_{shapeWithMaterials(*bodies[0]), shapeWithMaterials(*bodies[1])},
      friction_(gCalculateCombinedFrictionCallback(object_[0], object_[1])),
      restitution_(gCalculateCombinedRestitutionCallback(object_[0], object_[1])) {}

const SurfaceMaterial& PairMaterial::at(const Candidate& c, int i) const {
  static constexpr SurfaceMaterial kNone{};
  if (!shape_[i]) return kNone;
  const std::vector<Surface>& surfaces = shape_[i]->models().surfaces;
  return c.surface[i] < surfaces.size() ? surfaces[c.surface[i]].material : kNone;
}

double PairMaterial::friction(const Candidate& c) const {
  const SurfaceMaterial &a = at(c, 0), &b = at(c, 1);
  const bool is_hosts = gCalculateCombinedFrictionCallback != &btManifoldResult::calculateCombinedFriction;
  if (is_hosts || (!a.friction && !b.friction)) return friction_;
  return limitedFriction(a.friction.value_or(object_[0]->getFriction()) *
                         b.friction.value_or(object_[1]->getFriction()));
}

double PairMaterial::restitution(const Candidate& c) const {
  const SurfaceMaterial &a = at(c, 0), &b = at(c, 1);
  const bool is_hosts =
      gCalculateCombinedRestitutionCallback != &btManifoldResult::calculateCombinedRestitution;
  if (is_hosts || (!a.restitution && !b.restitution)) return restitution_;
  return a.restitution.value_or(object_[0]->getRestitution()) *
         b.restitution.value_or(object_[1]->getRestitution());
}

double PairMaterial::stiffness_N_per_m3(const Candidate& c, double usual_N_per_m3) const {
  return std::min(at(c, 0).stiffness_N_per_m3.value_or(usual_N_per_m3),
                  at(c, 1).stiffness_N_per_m3.value_or(usual_N_per_m3));
}

}  // namespace vps::bullet
