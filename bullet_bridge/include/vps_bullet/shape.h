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

/// What a contact takes from the surface that it touches. A value that is not set is that of the body:
/// btCollisionObject::getFriction() and getRestitution(), and Settings::stiffness_N_per_m3.
struct SurfaceMaterial {
  /// As btCollisionObject::setFriction(): the values of both bodies are multiplied, so that two equal ones
  /// are frictionFactor() of their coefficient (vps/friction.h). A host's own rule
  /// (gCalculateCombinedFrictionCallback) is given the bodies, and takes precedence.
  std::optional<double> friction;
  std::optional<double> restitution;         ///< as btCollisionObject::setRestitution(), and likewise
  std::optional<double> stiffness_N_per_m3;  ///< of penalty contact, per area; of both sides the lesser acts

  [[nodiscard]] bool isNone() const { return !friction && !restitution && !stiffness_N_per_m3; }
};

/// The exact surface of one part in the models' frame M.
struct Surface {
  std::shared_ptr<const Solid> distance;
  Pose X_MP;
  /// For an open surface without an inside, where a point meets the side that it faces; null for a solid.
  /// `distance` is then a Solid::sheet().
  std::shared_ptr<const SheetBorder> sheet = nullptr;
  /// Of contacts with this part. A contact belongs to the surface that its distance is measured from, or,
  /// where no exact surface is asked, to the map's owner (btManifoldPoint::m_partId0 and m_partId1 say
  /// which).
  SurfaceMaterial material = {};
};

/// The models of a shape, all in one frame M. This is not a PartModel because a fixed field merges several
/// parts: it then has one map and one shell, but one exact surface for each part. Any model may be missing.
/// Without a map, points of other shapes are tested against the surfaces (exact, but slower), or, without
/// surfaces, not at all. Without a shell, the shape's own points are not tested against others. Without
/// triangles, rays miss it.
struct ShapeModels {
  std::shared_ptr<const VoxMap> map;
  std::shared_ptr<const PointShell> shell;
  std::shared_ptr<const Mesh> mesh;
  /// The exact surfaces that the map was built from, in the map's owner order. The field finds the contacts;
  /// the surfaces refine the distance and normal of the few that reach the solver, which removes the field's
  /// interpolation error (up to 0.3 voxel at a sharp inner edge). Empty: contacts have the field's values.
  std::vector<Surface> surfaces;
};

/// The models of one part, whose frame is M. They are shared, not copied: O(1).
VPS_BULLET_API ShapeModels makeModels(const PartModel& part);

/// Concave shape of type FAST_CONCAVE_MESH_PROXYTYPE. Bullet itself does not use that type; it is concave for
/// ray and sweep tests, and without a registered algorithm falls back to convex against triangles.
/// CUSTOM_CONCAVE_SHAPE_TYPE would be cast to btSdfCollisionShape. Unlike Bullet's mesh shapes it may be
/// dynamic. Any number of bodies may share it, and it may outlive every dispatcher. Its margin is 0.
class VPS_BULLET_API Shape : public btConcaveShape {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  /// @param X_SM  the models' frame in the shape's; for a dynamic body of a part it is
  /// BodyFrame::X_PB.inverse().
  /// Throws std::invalid_argument for models without map, shell and mesh, and for a pose that is not finite.
  explicit Shape(ShapeModels models, const Pose& X_SM = {});
  ~Shape() override;

  /// Replaces the models, for example of a merged body that received one more part; the shape's scale applies
  /// to them. Only between steps. If the bounding box grew, call btCollisionWorld::updateSingleAabb for each
  /// static body of this shape. Throws as the constructor; the shape is then unchanged.
  void setModels(ShapeModels models);
  /// The models in use, scaled.
  [[nodiscard]] const ShapeModels& models() const { return models_; }
  [[nodiscard]] const Pose& X_SM() const { return X_SM_; }
  /// Changes with the models, and no two Shapes of a process ever have the same; point ids are valid for one
  /// revision.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  /// True for a shell point on a sharp edge or corner of the surfaces, where the part has no unique normal.
  /// False for all points if there are no surfaces.
  [[nodiscard]] bool isEdgePoint(std::uint32_t id) const {
    return !is_edge_point_.empty() && is_edge_point_[id];
  }
  /// The same by point; empty if there are no surfaces.
  [[nodiscard]] std::span<const std::uint8_t> edgePoints() const { return is_edge_point_; }
  /// Inward unit normal at a shell point on a face, of the curved surface that the facets approximate, in the
  /// models' frame. On edges, and without surfaces, the shell's own normal.
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

  /// Larger than bounds() by 0.2 um on each side: parts rest on each other with a gap of 0.1 um.
  void getAabb(const btTransform& X_WS, btVector3& min, btVector3& max) const override;
  /// Diagonal of the inertia of the solid mesh about the shape's origin (exact if X_SM comes from
  /// makeBodyFrame); of the bounding box if there is no closed mesh. Zero for a mass of zero, Bullet's
  /// convention for fixed bodies. Throws std::invalid_argument for a mass that is negative or not finite.
  void calculateLocalInertia(btScalar mass, btVector3& inertia) const override;
  void processAllTriangles(btTriangleCallback* callback, const btVector3& min,
                           const btVector3& max) const override;
  /// Scales the part about the shape's origin, for all bodies of this shape. Costs as much as building its
  /// models. Only between steps; afterwards call btCollisionWorld::updateSingleAabb, and setMassProps, since
  /// Bullet keeps a body's mass. Throws std::invalid_argument for a scale that is not positive, finite and
  /// equal in x, y and z (otherwise the field would no longer hold distances), and for models with a map but
  /// without surfaces or a mesh; the shape is then unchanged.
  void setLocalScaling(const btVector3& scaling) override;
  const btVector3& getLocalScaling() const override { return scaling_; }
  /// Has no effect, since contact is at the part's surface; a margin other than 0 is reported once.
  /// Throws std::invalid_argument for a margin that is negative or not a number.
  void setMargin(btScalar margin) override;
  btScalar getMargin() const override { return 0; }
  const char* getName() const override { return "Shape"; }
  /// Bullet's file format has no voxmap, so a Shape is written as a compound of one mesh, that of its
  /// triangles, with the resolution of its models in its name. Bullet's importer reads the mesh; that of
  /// world_importer.h makes a Shape of it again.
  [[nodiscard]] int calculateSerializeBufferSize() const override;
  const char* serialize(void* data, btSerializer* serializer) const override;

 private:
  class TriangleTree;
  struct Saved;
  /// Models of the part scaled by `factor` about the origin of their frame M. Shell and mesh are scaled
  /// copies. The map and the exact surfaces are built again, the map on a grid scaled by the same factor,
  /// with as many voxels and the same quality; that costs as much as building them the first time. Throws
  /// std::invalid_argument for models with a map but neither surfaces nor a mesh to build it from.
  static ShapeModels scaled(const ShapeModels& models, double factor);
  void use(ShapeModels models, const Pose& X_SM);

  ShapeModels unscaled_, models_;
  Pose X_SM_unscaled_, X_SM_;
  btVector3 scaling_;
  Box bounds_S_;
  std::uint64_t revision_ = 0;
  std::vector<std::uint8_t> is_edge_point_;
  std::vector<Vec3> smooth_inward_;
  std::vector<PointFace> face_at_;         // by point
  std::vector<std::uint16_t> surface_at_;  // by point; empty: there is one surface or none
  EdgeSet edges_;
  FeatureSet features_;
  std::vector<std::uint32_t> edges_at_, first_edge_;  // those of a point start at edges_at_[first_edge_[id]]
  std::unique_ptr<const TriangleTree> triangles_;
  mutable std::shared_ptr<Saved> saved_;  // a serializer refers to it
};

/// All triangles, with equal vertices joined and the interface's scaling applied. Throws
/// std::invalid_argument for a mesh without triangles, with a vertex that is not finite, or with an index
/// beyond its vertices.
VPS_BULLET_API Mesh meshOf(const btStridingMeshInterface& triangles);

/// Null if `saved_as` is not what Shape::serialize() writes. Throws LoadError for numbers out of range and as
/// buildPartModel().
/// @param saved_as  the name that the file gives the shape
VPS_BULLET_API std::unique_ptr<Shape> restoreShape(const char* saved_as,
                                                   const btStridingMeshInterface& triangles);

}  // namespace vps::bullet
