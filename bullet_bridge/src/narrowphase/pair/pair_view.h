// SPDX-License-Identifier: BSD-3-Clause
// Two bodies that may touch, at one instant: shapes, poses, predicted motion and materials.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

#include <algorithm>
#include <cmath>

#include "narrowphase/candidates/contact_candidate.h"
#include "native_shapes/native_shape.h"
#include "vps/pose.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/settings.h"
#include "vps_bullet/shape.h"

class btCollisionObject;
struct btCollisionObjectWrapper;

namespace vps::bullet {

/// Velocity about the world's origin, in W, that the object would reach by the end of the step without
/// contact: its own, plus external forces, plus (with_couplings) the pull of its CouplingConstraints. A link
/// of a btMultiBody has the velocity that its joints give it. Zero for static objects.
Twist predictedVelocity(const btCollisionObject& object, double dt_s, bool with_couplings = true);

/// Displacement of the object, in W, by a twist about the world's origin that is constant for t_s. The object
/// turns about its own centre.
Pose displacement(const btCollisionObject& object, const Twist& V, double t_s);

/// Both bodies of a pair at one instant.
struct PairView {
  const btCollisionObjectWrapper* wrapper[2];
  const Shape* shape[2];  // null for a native shape without adapter
  Pose X_WS[2];

  PairView(const btCollisionObjectWrapper* body0, const btCollisionObjectWrapper* body1)
      : wrapper{body0, body1} {
    for (int i = 0; i < 2; ++i) {
      shape[i] = dynamic_cast<const Shape*>(wrapper[i]->getCollisionShape());
      X_WS[i] = fromBt(wrapper[i]->getWorldTransform());
    }
  }
  [[nodiscard]] SideView side(int i) const {
    return {shape[i], shape[i] ? X_WS[i] * shape[i]->X_SM() : X_WS[i], static_cast<std::uint8_t>(i)};
  }
  /// Pose of body 1 in body 0.
  [[nodiscard]] Pose X_01() const { return X_WS[0].inverse() * X_WS[1]; }
  /// Upper bound of the relative displacement of the two bodies' points near the smaller body, for a motion
  /// of body 1 given in body 0.
  [[nodiscard]] double movedBy_m(const Pose& motion_0) const {
    const Vec3 center_0 = X_WS[0].inverse() * center_W();
    return (motion_0 * center_0 - center_0).norm() + (motion_0.R - Mat3::Identity()).norm() * radius_m();
  }
  /// Models' frame of side 1 in the models' frame of side 0.
  [[nodiscard]] Pose X_01_models() const { return side(0).X_WM.inverse() * side(1).X_WM; }
  /// Lower bound of the distance of the two bodies, from their boxes. 0 if the boxes overlap or a box is not
  /// known.
  [[nodiscard]] double leastDistance_m() const {
    // Without a mesh the box covers the models only, which may lack much of the part.
    for (const Shape* each : shape)
      if (!each || !each->models().mesh) return 0;
    const Box &box0 = shape[0]->bounds(), &box1 = shape[1]->bounds();
    const Pose X_01 = this->X_01();
    return std::sqrt(
        std::max(distance2(box0, moved(box1, X_01)), distance2(moved(box0, X_01.inverse()), box1)));
  }
  /// Key of a side that is not a Shape; it changes with the shape's size.
  [[nodiscard]] ShapeKey key(int i) const {
    return shape[i] ? ShapeKey{} : keyOf(*wrapper[i]->getCollisionShape());
  }
  [[nodiscard]] bool hasShell(int i) const { return shape[i] && shape[i]->models().shell; }
  [[nodiscard]] bool hasMap(int i) const { return shape[i] && shape[i]->models().map; }
  /// Voxel size of the side's map; 0 without a map.
  [[nodiscard]] double voxel_m(int i) const { return hasMap(i) ? shape[i]->models().map->voxel_m() : 0; }
  [[nodiscard]] bool isTwoSided() const { return hasMap(0) && hasMap(1) && hasShell(0) && hasShell(1); }
  /// Half the diagonal of the smaller body.
  [[nodiscard]] double radius_m() const {
    double radius_m = 1e30;
    for (const Shape* each : shape)
      if (each) radius_m = std::min(radius_m, 0.5 * each->bounds().size().norm());
    return std::max(radius_m, 1e-6);
  }
  /// Centre of the smaller Shape's bounding box, in W.
  [[nodiscard]] Vec3 center_W() const {
    const bool second =
        !shape[0] || (shape[1] && shape[1]->bounds().size().norm() < shape[0]->bounds().size().norm());
    const int i = second ? 1 : 0;
    return X_WS[i] * shape[i]->bounds().center();
  }
};

/// Present velocity of body 0 minus that of body 1, about the world's origin, in W.
Twist presentVelocity(const PairView& pair);

/// @param is_held  contacts held the bodies in the last step. The pull of couplings is then limited to the
///   query range
RelativeMotion relativeMotion(const PairView& pair, double dt_s, double contact_margin_m, bool is_held);

/// Greatest distance that the fields of both shapes can measure [m], limited by their bands.
double queryRange_m(const PairView& pair);

/// Greatest error by which the field overestimates the distance of a point [m]. The field interpolates
/// between nodes, so it reads too much along the edges of a part. Zero for exact distances: of crossings, and
/// from native shapes.
double fieldError_m(const PairView& pair, const Candidate& c);
/// Greatest fieldError_m() of any point of the pair [m].
double fieldError_m(const PairView& pair);

/// True if the points of side i are queried. With Sides::One only the smaller body's points are queried,
/// since points of a larger body may be too far apart to touch it.
bool queriesPoints(const PairView& pair, int i, Sides sides);

/// Number of sides whose points are queried. With two sides, the areas of their points overlap.
int sideCount(const PairView& pair, Sides sides);

/// Moves both bodies to their predicted poses at t_s within a step of dt_s. The prediction assumes free
/// motion at the velocity that each body has at the end of the step, as all predictions of the narrow phase
/// do. (A step of length t_s would end at another pose: a stiff coupling pulls a body nearly as far in a
/// short step as in a long one.)
void advance(PairView& pair, const PairView& start, double dt_s, double t_s);

/// Displacements of both bodies in the step at their present velocities, in W.
void coast(const PairView& pair, double dt_s, Pose (&way)[2]);

/// Materials of a pair's contacts. Combines both sides as Bullet does: friction and restitution are
/// multiplied. Bodies and shapes must outlive it.
class PairMaterial {
 public:
  PairMaterial(const btCollisionObjectWrapper* const (&bodies)[2], const FrictionModel& friction_model);

  /// Coefficient of friction in the step: the friction model's value for the product of both sides and the
  /// speed of slip at the start of the step.
  [[nodiscard]] double friction(const Candidate& c, const RelativeMotion& motion) const;
  [[nodiscard]] double restitution(const Candidate& c) const;
  /// Stiffness per area of penalty contact: the lesser value of both sides.
  /// @param usual_N_per_m3  value of a side whose surface has none of its own
  [[nodiscard]] double stiffness_N_per_m3(const Candidate& c, double usual_N_per_m3) const;

 private:
  [[nodiscard]] const SurfaceMaterial& at(const Candidate& c, int i) const;
  [[nodiscard]] double frictionAtRest(const Candidate& c) const;

  const btCollisionObject* object_[2];
  const Shape* shape_[2];          // null if no surface of the shape has a material of its own
  double friction_, restitution_;  // combined values of the bodies
  double (*coefficient_)(double mu, double slip_m_s);  // FrictionModel::coefficient
};

}  // namespace vps::bullet
