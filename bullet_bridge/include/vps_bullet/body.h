// SPDX-License-Identifier: BSD-3-Clause
// Makes a body from triangles in one call: models, shape, mass, inertia, material, and a motion state in the
// part's own frame.
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

/// Finest resolution with about `point_budget` points; the field's memory follows from it. Contact distances
/// are those of the exact surfaces, so that a coarse field of a large part costs no accuracy on its faces;
/// features smaller than the spacing may be missed. O(triangles). Throws std::invalid_argument for a mesh
/// without area or a budget below 100.
VPS_BULLET_API Resolution resolutionFor(const Mesh& mesh, std::size_t point_budget);

/// Sets a body's friction and restitution. Bullet multiplies the values of both bodies; setMaterial() sets
/// them so that two bodies of one material have that material's friction. Throws std::invalid_argument for a
/// friction that is negative or not finite, and a restitution outside 0 to 1.
VPS_BULLET_API void setMaterial(btCollisionObject& body, const Material& material);

struct BodySettings {
  Material material;  ///< density of the body, friction, restitution
  /// Voxel size and spacing of the models. If not set, both values follow from the part's size and
  /// point_budget, and a message (LogLevel::Info) reports the choice.
  std::optional<Fidelity> fidelity;
  std::size_t point_budget = 20'000;
  Pose X_WP;              ///< initial pose of the part's frame
  bool is_fixed = false;  ///< a body without mass; it may be a sheet, and its density is ignored
  std::string name = "part";
  /// Whether a mesh with wide holes is a sheet or a solid. A message (LogLevel::Info) reports a sheet.
  OpenMesh open_mesh = OpenMesh::Sheet;
};

/// A motion state that gives the pose of the part's mesh. Bullet's bodies have their frame at the centre of
/// mass.
class VPS_BULLET_API PartMotionState : public btMotionState {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();
  PartMotionState(const Pose& X_WP, const Pose& X_PB) : X_WP_(X_WP), X_PB_(X_PB) {}
  /// Pose of the mesh's frame. With fixed substeps Bullet interpolates the pose between steps.
  [[nodiscard]] const Pose& X_WP() const { return X_WP_; }
  void getWorldTransform(btTransform& X_WB) const override;
  void setWorldTransform(const btTransform& X_WB) override;

 private:
  Pose X_WP_, X_PB_;
};

/// A rigid body with everything that it needs; members are declared so that they are destroyed in the right
/// order. Remove the rigid body from its world before this object is destroyed.
struct Body {
  std::shared_ptr<const PartModel> model;
  BodyFrame frame;  ///< frame.X_PB: pose of the body's frame in the mesh's frame
  std::shared_ptr<Shape> shape;
  std::unique_ptr<PartMotionState> motion;
  std::unique_ptr<btRigidBody> rigid;  ///< with tuneBody()'s sleeping thresholds

  /// Present pose of the mesh's frame.
  [[nodiscard]] VPS_BULLET_API Pose X_WP() const;
};

/// Makes a body from a mesh. This library reads no files; importCad() of vps::scenes does
/// (examples/body_from_file.cpp). The mass of an open mesh is that of the part with flat lids on its holes,
/// which a message reports. Throws LoadError as buildPartModel() and makeBodyFrame(), std::invalid_argument
/// as meshOf(), resolutionFor() and setMaterial(), and for X_WP that is not finite or no rotation.
VPS_BULLET_API Body makeBody(const Mesh& mesh, const BodySettings& settings = {});
VPS_BULLET_API Body makeBody(const btStridingMeshInterface& triangles, const BodySettings& settings = {});

}  // namespace vps::bullet
