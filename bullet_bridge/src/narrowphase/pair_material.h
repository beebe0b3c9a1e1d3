// SPDX-License-Identifier: BSD-3-Clause
// What the contacts of a pair take from the two bodies and from the surfaces that they touch.
#pragma once

#include "narrowphase/contact_candidate.h"

class btCollisionObject;
struct btCollisionObjectWrapper;

namespace vps::bullet {

/// Combines both sides' materials as Bullet does: friction and restitution are multiplied. Bodies and shapes
/// must outlive it.
class PairMaterial {
 public:
  explicit PairMaterial(const btCollisionObjectWrapper* const (&bodies)[2]);

  [[nodiscard]] double friction(const Candidate& c) const;
  [[nodiscard]] double restitution(const Candidate& c) const;
  /// Of penalty contact, per area: of both sides the lesser.
  /// @param usual_N_per_m3  of a side whose surface has none
  [[nodiscard]] double stiffness_N_per_m3(const Candidate& c, double usual_N_per_m3) const;

 private:
  [[nodiscard]] const SurfaceMaterial& at(const Candidate& c, int i) const;

  const btCollisionObject* object_[2];
  const Shape* shape_[2];          // null: none of its surfaces has a material of its own
  double friction_, restitution_;  // of the bodies
};

}  // namespace vps::bullet
