// SPDX-License-Identifier: BSD-3-Clause
#include "part.h"

#include <algorithm>

namespace vps::dynamics {

namespace {

// Least signed distance of b's vertices from a. A vertex outside a's box is outside a.
double leastDistance_m(const PartMesh& a, const PartMesh& b, const Pose& X_AB) {
  constexpr double kNear_m = 1e-3;
  Box box = bounds(a.exact->mesh());
  box.min.array() -= kNear_m;
  box.max.array() += kNear_m;
  double least_m = 1e300;
  for (const Vec3& p_B : b.mesh.vertices) {
    const Vec3 p = X_AB * p_B;
    if ((p.array() < box.min.array()).any() || (p.array() > box.max.array()).any()) continue;
    least_m = std::min(least_m, a.exact->signedDistance(p));
  }
  return least_m;
}

}  // namespace

PartMesh makePart(Mesh mesh, double density_kg_m3) {
  PartMesh part;
  part.mesh = welded(mesh);
  part.exact = std::make_shared<const Solid>(part.mesh);
  part.frame = bullet::makeBodyFrame(part.exact->mass(), density_kg_m3);
  return part;
}

PartMesh withMass(PartMesh part, double mass_kg) {
  part.frame.inertia_kg_m2 *= mass_kg / part.frame.mass_kg;
  part.frame.mass_kg = mass_kg;
  return part;
}

Mesh bodyMesh(const PartMesh& part) {
  return transformed(part.mesh, part.frame.X_PB.inverse());
}

double penetration_m(const PartMesh& a, const Pose& X_WA, const PartMesh& b, const Pose& X_WB) {
  const Pose X_AB = X_WA.inverse() * X_WB;
  return -std::min(leastDistance_m(a, b, X_AB), leastDistance_m(b, a, X_AB.inverse()));
}

}  // namespace vps::dynamics
