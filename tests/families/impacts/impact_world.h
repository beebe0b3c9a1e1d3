// SPDX-License-Identifier: BSD-3-Clause
// A world of bodies that hit each other, with the energy and momentum that the families of restitution and
// rotation measure.
#pragma once

#include <initializer_list>
#include <utility>
#include <vector>

#include "dynamics/world.h"

namespace vps::families {

/// Linear momentum [kg m/s] and angular momentum about W's origin [kg m^2/s].
struct Momentum {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};

/// A world with a list of its free bodies.
class ImpactWorld {
 public:
  explicit ImpactWorld(dynamics::Mode mode = dynamics::Mode::Constraint);

  dynamics::Placed add(const dynamics::PartMesh& part, const Pose& X_WP, double restitution, double friction);
  /// The restitution of a pair is the product of the restitutions of its bodies.
  dynamics::Placed addFixed(const dynamics::PartMesh& part, const Pose& X_WP, double restitution,
                            double friction);
  /// Kinetic energy and height energy of the free bodies [J].
  [[nodiscard]] double energy_J(bool with_height = true) const;
  [[nodiscard]] Momentum momentum() const;
  [[nodiscard]] double mass_kg() const;
  /// Sum of the magnitudes of the bodies' momenta, and of their angular momenta, whose lever arm is taken as
  /// at least the body's size.
  [[nodiscard]] std::pair<double, double> momentumScale() const;
  [[nodiscard]] double topSpeed_m_s() const;

  dynamics::World world;
  std::vector<dynamics::Placed> bodies;
};

/// A box of this size, built once.
const dynamics::PartMesh& boxPart(const Vec3& size_m);

/// Sets the velocity of the body's centre and its angular velocity.
void setVelocity(const dynamics::Placed& body, const Vec3& v_W, const Vec3& w_W = Vec3::Zero());
Vec3 velocityOf(const dynamics::Placed& body);

}  // namespace vps::families
