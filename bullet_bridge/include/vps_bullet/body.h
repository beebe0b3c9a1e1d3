// SPDX-License-Identifier: BSD-3-Clause
// From triangles to a body in one call: models, shape, mass, inertia, material and a motion state that speaks
// in the part's own frame.
#pragma once

#include <BulletDynamics/Dynamics/btRigidBody.h>
#include <LinearMath/btMotionState.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "vps/fidelity.h"
#include "vps/part_model.h"
#include "vps_bullet/export.h"
#include "vps_bullet/precision.h"
#include "vps_bullet/shape.h"

namespace vps::bullet {

/// Voxel and spacing of a part's models.
struct Resolution {
  double voxel_m = 0;
  double spacing_m = 0;
};

/// The finest that keeps to about so many points; the field's memory then follows. Contact distances are
/// those of the exact surfaces, so that a coarse field of a large part costs no accuracy on its faces;
/// features smaller than the spacing may be missed. O(triangles). Throws std::invalid_argument for a mesh
/// without area or a budget below 100.
VPS_BULLET_API Resolution resolutionFor(const Mesh& mesh, std::size_t point_budget);

/// A body's friction and restitution, by Bullet's rule: it multiplies those of both bodies, so that two
/// bodies of one material have that material's friction. Throws std::invalid_argument for a friction that is
/// negative or not finite, and a restitution outside 0 to 1.
VPS_BULLET_API void setMaterial(btCollisionObject& body, const Material& material);

struct BodySettings {
  Material material;  ///< density of the body, friction, restitution
  /// Its voxel and spacing are used. Without it, they follow from the part's size and the budget, and a
  /// message (LogLevel::Info) says what was chosen.
  std::optional<Fidelity> fidelity;
  std::size_t point_budget = 20'000;
  Pose X_WP;              ///< where the part's frame is at the start
  bool is_fixed = false;  ///< without mass: it may be a sheet, and its density is not used
  std::string name = "part";
  /// What a mesh with wide holes stands for; a message (LogLevel::Info) says that it is a sheet.
  OpenMesh open_mesh = OpenMesh::Sheet;
};

/// Where a part is, in the frame of its mesh. Bullet's bodies have their frame at the centre of mass.
class VPS_BULLET_API PartMotionState : public btMotionState {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();
  PartMotionState(const Pose& X_WP, const Pose& X_PB) : X_WP_(X_WP), X_PB_(X_PB) {}
  /// Of the mesh's frame; between steps of a fixed length interpolated by Bullet.
  [[nodiscard]] const Pose& X_WP() const { return X_WP_; }
  void getWorldTransform(btTransform& X_WB) const override;
  void setWorldTransform(const btTransform& X_WB) override;

 private:
  Pose X_WP_, X_PB_;
};

/// A body with all that it needs, in the order in which it must be destroyed. Remove it from its world first.
struct Body {
  std::shared_ptr<const PartModel> model;
  BodyFrame frame;  ///< frame.X_PB: the body's frame in the mesh's
  std::shared_ptr<Shape> shape;
  std::unique_ptr<PartMotionState> motion;
  std::unique_ptr<btRigidBody> rigid;  ///< with tuneBody()'s sleeping thresholds

  /// Where the mesh's frame is now.
  [[nodiscard]] Pose X_WP() const;
};

/// From a file: this library reads none. importCad() of vps::scenes does, and its parts have a mesh
/// (examples/body_from_file.cpp). The mass of an open mesh is that of the part with flat lids on its holes,
/// which a message says. Throws LoadError as buildPartModel() and makeBodyFrame(), std::invalid_argument as
/// meshOf(), resolutionFor() and setMaterial(), and for X_WP that is not finite or no rotation.
VPS_BULLET_API Body makeBody(const Mesh& mesh, const BodySettings& settings = {});
VPS_BULLET_API Body makeBody(const btStridingMeshInterface& triangles, const BodySettings& settings = {});

}  // namespace vps::bullet
