// SPDX-License-Identifier: BSD-3-Clause
// Two bodies that may touch, at one instant: shapes, poses, predicted motion and materials.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>

#include <algorithm>

#include "narrowphase/candidates/contact_candidate.h"
#include "native_shapes/native_shape.h"
#include "vps/pose.h"
#include "vps_bullet/convert.h"
#include "vps_bullet/shape.h"

class btCollisionObject;
struct btCollisionObjectWrapper;

namespace vps::bullet {

/// Velocity about the world's origin, in W, that the object would reach by the end of the step without
/// contact: its own, plus external forces, plus (with_couplings) the pull of its CouplingConstraints. A link
/// of a btMultiBody has the velocity that its joints give it. Zero for static objects.
Twist predictedVelocity(const btCollisionObject& object, double dt_s, bool with_couplings = true);

/// Where a twist about the world's origin, constant for t_s, takes the object, in W. It turns about its own
/// centre, wherever the world's origin is.
Pose displacement(const btCollisionObject& object, const Twist& V, double t_s);

/// Both bodies of a pair at one instant.
struct PairView {
  const btCollisionObjectWrapper* wrapper[2];
  const Shape* shape[2];  // null: a native shape without adapter
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
  /// Body 1 in body 0.
  [[nodiscard]] Pose X_01() const { return X_WS[0].inverse() * X_WS[1]; }
  /// Upper bound of how far a motion of body 1 in body 0 moves the bodies' points near the smaller one
  /// against each other.
  [[nodiscard]] double movedBy_m(const Pose& motion_0) const {
    const Vec3 center_0 = X_WS[0].inverse() * center_W();
    return (motion_0 * center_0 - center_0).norm() + (motion_0.R - Mat3::Identity()).norm() * radius_m();
  }
  /// Models' frame of side 1 in that of side 0.
  [[nodiscard]] Pose X_01_models() const { return side(0).X_WM.inverse() * side(1).X_WM; }
  /// No points of the two bodies are nearer than this. 0 where their boxes overlap, or a side's is not known.
  [[nodiscard]] double leastDistance_m() const {
    // Without a mesh the box is that of the models, which may leave out much of the part.
    for (const Shape* each : shape)
      if (!each || !each->models().mesh) return 0;
    const Box &box0 = shape[0]->bounds(), &box1 = shape[1]->bounds();
    const Pose X_01 = this->X_01();
    return std::max(distance_m(box0, moved(box1, X_01)), distance_m(moved(box0, X_01.inverse()), box1));
  }
  /// Of a side that is no Shape; changes with its size.
  [[nodiscard]] ShapeKey key(int i) const {
    return shape[i] ? ShapeKey{} : keyOf(*wrapper[i]->getCollisionShape());
  }
  [[nodiscard]] bool hasShell(int i) const { return shape[i] && shape[i]->models().shell; }
  [[nodiscard]] bool hasMap(int i) const { return shape[i] && shape[i]->models().map; }
  /// Of the side's map; 0 without one.
  [[nodiscard]] double voxel_m(int i) const { return hasMap(i) ? shape[i]->models().map->voxel_m() : 0; }
  [[nodiscard]] bool isTwoSided() const { return hasMap(0) && hasMap(1) && hasShell(0) && hasShell(1); }
  /// Half the diagonal of the smaller body.
  [[nodiscard]] double radius_m() const {
    double radius_m = 1e30;
    for (const Shape* each : shape)
      if (each) radius_m = std::min(radius_m, 0.5 * each->bounds().size().norm());
    return std::max(radius_m, 1e-6);
  }
  /// Centre of the smaller Shape, in W.
  [[nodiscard]] Vec3 center_W() const {
    const bool second =
        !shape[0] || (shape[1] && shape[1]->bounds().size().norm() < shape[0]->bounds().size().norm());
    const int i = second ? 1 : 0;
    return X_WS[i] * shape[i]->bounds().center();
  }
};

/// @param is_held  by contacts in the last step: then the pull of couplings counts only as far as the query
/// range
RelativeMotion relativeMotion(const PairView& pair, double dt_s, double contact_margin_m, bool is_held);

/// Greatest distance that the fields can measure [m]; their band bounds it.
double queryRange_m(const PairView& pair);

/// How much nearer than the field says a point may be [m]. The field interpolates between nodes: along the
/// edges of a part it reads too much, and those are met by the other part's edges. Zero where the distance is
/// exact: of crossings, and from native shapes.
double fieldError_m(const PairView& pair, const Candidate& c);
/// The greatest of any point of the pair.
double fieldError_m(const PairView& pair);

/// True if the points of side i are queried. One-sided: only those of the smaller body, since points of a
/// larger one may be too far apart to touch it.
bool queriesPoints(const PairView& pair, int i, Sides sides);

/// How many sides' points are queried, so that their areas overlap.
int sideCount(const PairView& pair, Sides sides);

/// Moves both bodies to where they are t_s into a step of dt_s, in free motion at the velocity of the step's
/// end, as every prediction assumes. (The velocity at t_s differs: a stiff coupling pulls nearly as far in a
/// part of the step.)
void advance(PairView& pair, const PairView& start, double dt_s, double t_s);

/// Displacement of both bodies in the step at constant velocity, in W.
void coast(const PairView& pair, double dt_s, Pose (&way)[2]);

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
