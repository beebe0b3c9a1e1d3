// SPDX-License-Identifier: BSD-3-Clause
// A part as a Bullet collision shape: voxmap and pointshell for contact, triangles for rays and debug
// drawing.
#pragma once

#include <BulletCollision/CollisionShapes/btConcaveShape.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "vps/edge_crossing.h"
#include "vps/feature_set.h"
#include "vps/part_model.h"
#include "vps_bullet/export.h"
#include "vps_bullet/precision.h"

class btStridingMeshInterface;

namespace vps::bullet {

/// A body's mass, and the frame that Bullet requires: origin at the centre of mass, principal axes.
struct BodyFrame {
  double mass_kg = 0;
  Vec3 inertia_kg_m2 = Vec3::Zero();  ///< principal moments, about the axes of B
  Pose X_PB;                          ///< body frame in the part's frame
};

/// Throws LoadError for a volume or density that is not positive and finite, as an open or inside-out mesh
/// has.
VPS_BULLET_API BodyFrame makeBodyFrame(const MassProperties& unit_density, double density_kg_m3);

class SheetBorder;

/// Contact properties of a surface. For a value that is not set, the contact uses the body's value
/// (btCollisionObject::getFriction() and getRestitution()) or Settings::stiffness_N_per_m3.
struct SurfaceMaterial {
  /// As btCollisionObject::setFriction(): the values of both sides are multiplied, so a surface gets the
  /// frictionFactor() (vps/friction.h) of its material's coefficient. A host's own rule
  /// (gCalculateCombinedFrictionCallback) takes precedence; it receives the bodies.
  std::optional<double> friction;
  std::optional<double>
      restitution;  ///< as btCollisionObject::setRestitution(); a host's own rule takes precedence
  std::optional<double>
      stiffness_N_per_m3;  ///< stiffness per area of penalty contact; the lesser value of both sides acts

  [[nodiscard]] bool isNone() const { return !friction && !restitution && !stiffness_N_per_m3; }
};

/// The exact surface of one part in the models' frame M.
struct Surface {
  std::shared_ptr<const Solid> distance;
  Pose X_MP;
  /// Border of an open surface without an inside (a sheet), where a point meets the side that it faces;
  /// `distance` is then a Solid::sheet(). Null for a solid.
  std::shared_ptr<const SheetBorder> sheet = nullptr;
  /// Material of contacts with this part. A contact belongs to the surface from which its distance is
  /// measured, or, without exact surfaces, to the map's owner (given in btManifoldPoint::m_partId0 and
  /// m_partId1).
  SurfaceMaterial material = {};
};

/// The models of a shape, all in one frame M. This is not a PartModel because a fixed field merges several
/// parts: it then has one map and one shell, but one exact surface for each part. Any model may be missing.
/// Without a map, points of other shapes are tested against the surfaces (exact, but slower), or, without
/// surfaces, not at all. Without a shell, the shape's own points are not tested against others. Without
/// triangles, rays miss the shape.
struct ShapeModels {
  std::shared_ptr<const VoxMap> map;
  std::shared_ptr<const PointShell> shell;
  std::shared_ptr<const Mesh> mesh;
  /// The exact surfaces that the map was built from, in the map's owner order. The field finds the contacts,
  /// and the surfaces refine distance and normal of those that reach the solver. The refinement removes the
  /// field's interpolation error (up to 0.3 voxel at a sharp inner edge). If empty, contacts have the field's
  /// values.
  std::vector<Surface> surfaces;
};

/// The models of one part, whose frame is M. O(1): models are shared, not copied.
VPS_BULLET_API ShapeModels makeModels(const PartModel& part);

/// A part as a concave collision shape, which, unlike Bullet's mesh shapes, may be dynamic. Any number of
/// bodies may share a Shape, and it may outlive every dispatcher. Its margin is 0. Its type is
/// FAST_CONCAVE_MESH_PROXYTYPE, which Bullet itself does not use: it is concave for ray and sweep tests, and
/// falls back to convex against triangles without a registered algorithm. (Bullet would cast
/// CUSTOM_CONCAVE_SHAPE_TYPE to btSdfCollisionShape.)
class VPS_BULLET_API Shape : public btConcaveShape {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  /// @param X_SM  pose of the models' frame in the shape's frame; for a dynamic body of one part,
  ///   BodyFrame::X_PB.inverse().
  /// Throws std::invalid_argument for models without map, shell and mesh, and for a pose that is not finite.
  explicit Shape(ShapeModels models, const Pose& X_SM = {});
  ~Shape() override;

  /// Replaces the models, for example of a merged body that received another part; the shape's scale applies
  /// to them. Allowed only between steps. If the bounding box grew, call btCollisionWorld::updateSingleAabb
  /// for each static body of this shape. Throws as the constructor; the shape is then unchanged.
  void setModels(ShapeModels models);
  /// The models in use, scaled.
  [[nodiscard]] const ShapeModels& models() const { return models_; }
  [[nodiscard]] const Pose& X_SM() const { return X_SM_; }
  /// A number that changes with the models and is unique among all Shapes of the process. Point ids are valid
  /// for one revision.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  /// True for a shell point on a sharp edge or corner of the surfaces, where the part has no unique normal.
  /// False for all points if there are no surfaces.
  [[nodiscard]] bool isEdgePoint(std::uint32_t id) const {
    return !is_edge_point_.empty() && is_edge_point_[id];
  }
  /// isEdgePoint() of all points; empty if there are no surfaces.
  [[nodiscard]] std::span<const std::uint8_t> edgePoints() const { return is_edge_point_; }
  /// Inward unit normal, in the models' frame, at a shell point on a face: that of the curved surface that
  /// the facets approximate. On edges, and without surfaces, the result is the shell's own normal.
  [[nodiscard]] const Vec3& smoothInward(std::uint32_t id) const {
    return smooth_inward_.empty() ? models_.shell->inward[id] : smooth_inward_[id];
  }
  /// The triangle that a shell point on a face lies on.
  struct PointFace {
    std::uint32_t surface = 0;  ///< index of ShapeModels::surfaces
    std::uint32_t triangle = 0;
  };
  /// Requires surfaces and a point on a face: !isEdgePoint(id).
  [[nodiscard]] PointFace faceAt(std::uint32_t id) const { return face_at_[id]; }
  /// Index of the surface that a shell point lies on; 0 without surfaces.
  [[nodiscard]] std::uint16_t surfaceAt(std::uint32_t id) const {
    return surface_at_.empty() ? std::uint16_t{0} : surface_at_[id];
  }
  /// Index of the surface that a vertex of features() belongs to.
  [[nodiscard]] std::uint16_t surfaceOfVertex(std::uint32_t vertex) const;
  /// Sharp edges of the surfaces, in the models' frame.
  [[nodiscard]] const EdgeSet& edges() const { return edges_; }
  /// Corners, sharp edges and facets of the surfaces, in the models' frame.
  [[nodiscard]] const FeatureSet& features() const { return features_; }
  /// The sharp edges on which a shell point lies, as indices of edges().segments(): one, several at corners
  /// and ends of segments, none on faces.
  [[nodiscard]] std::span<const std::uint32_t> edgesAt(std::uint32_t id) const {
    if (first_edge_.empty()) return {};
    return std::span(edges_at_).subspan(first_edge_[id], first_edge_[id + 1] - first_edge_[id]);
  }
  /// Bounding box of all models in the shape's frame.
  [[nodiscard]] const Box& bounds() const { return bounds_S_; }

  /// The box is larger than bounds() by 0.2 um on each side, since parts rest on each other with a gap of 0.1
  /// um.
  void getAabb(const btTransform& X_WS, btVector3& min, btVector3& max) const override;
  /// Diagonal of the inertia of the solid mesh about the shape's origin (exact if X_SM comes from
  /// makeBodyFrame); of the bounding box if there is no closed mesh. Zero for a mass of zero, Bullet's
  /// convention for fixed bodies. Throws std::invalid_argument for a mass that is negative or not finite.
  void calculateLocalInertia(btScalar mass, btVector3& inertia) const override;
  void processAllTriangles(btTriangleCallback* callback, const btVector3& min,
                           const btVector3& max) const override;
  /// Scales the part about the shape's origin, for all bodies of this shape. The cost is that of building the
  /// part's models. Allowed only between steps. Afterwards call btCollisionWorld::updateSingleAabb, and
  /// setMassProps, since Bullet keeps a body's mass. Throws std::invalid_argument for a scale that is not
  /// positive, finite and equal in x, y and z (otherwise the field would no longer hold distances), and for
  /// models with a map but without surfaces or a mesh; the shape is then unchanged.
  void setLocalScaling(const btVector3& scaling) override;
  const btVector3& getLocalScaling() const override { return scaling_; }
  /// Has no effect, since contact is at the part's surface. A margin other than 0 is reported once. Throws
  /// std::invalid_argument for a margin that is negative or not a number.
  void setMargin(btScalar margin) override;
  btScalar getMargin() const override { return 0; }
  const char* getName() const override { return "Shape"; }
  /// Bullet's file format has no voxmap, so a Shape is written as a compound of one mesh, that of its
  /// triangles, with the resolution of its models in its name. Bullet's importer reads the mesh;
  /// WorldImporter (world_importer.h) makes a Shape of it again.
  [[nodiscard]] int calculateSerializeBufferSize() const override;
  const char* serialize(void* data, btSerializer* serializer) const override;

 private:
  class TriangleTree;
  struct Saved;
  /// Models of the part scaled by `factor` about the origin of their frame M. Shell and mesh are scaled
  /// copies. The map and the exact surfaces are built again, the map on a grid scaled by the same factor,
  /// with as many voxels and the same quality; that costs as much as building them the first time. Throws
  /// std::invalid_argument for models with a map but neither surfaces nor a mesh to build it from.
  static ShapeModels atScale(const ShapeModels& models, double factor);
  void use(ShapeModels models, const Pose& X_SM);

  ShapeModels unscaled_, models_;
  Pose X_SM_unscaled_, X_SM_;
  btVector3 scaling_;
  Box bounds_S_;
  std::uint64_t revision_ = 0;
  std::vector<std::uint8_t> is_edge_point_;
  std::vector<Vec3> smooth_inward_;
  std::vector<PointFace> face_at_;         // by point
  std::vector<std::uint16_t> surface_at_;  // by point; empty if there is at most one surface
  EdgeSet edges_;
  FeatureSet features_;
  std::vector<std::uint32_t> edges_at_,
      first_edge_;  // entries of point id start at edges_at_[first_edge_[id]]
  std::unique_ptr<const TriangleTree> triangles_;
  mutable std::shared_ptr<Saved> saved_;  // data to which a serializer refers
};

/// All triangles of a Bullet mesh, with equal vertices joined and the interface's scaling applied. Throws
/// std::invalid_argument for a mesh without triangles, with a vertex that is not finite, or with an index
/// beyond its vertices.
VPS_BULLET_API Mesh meshOf(const btStridingMeshInterface& triangles);

/// Makes a Shape from the data of a file in Bullet's format. Returns null if `saved_as` was not written by
/// Shape::serialize(). Throws LoadError for numbers out of range and as buildPartModel().
/// @param saved_as  name of the shape in the file
VPS_BULLET_API std::unique_ptr<Shape> restoreShape(const char* saved_as,
                                                   const btStridingMeshInterface& triangles);

}  // namespace vps::bullet
