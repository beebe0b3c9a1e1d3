// SPDX-License-Identifier: BSD-3-Clause
// A part as a Bullet collision shape: voxmap and pointshell for contact, triangles for rays and pictures.
#pragma once

#include <BulletCollision/CollisionShapes/btConcaveShape.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "vps/edge_crossing.h"
#include "vps/part_model.h"

namespace vps::bullet {

/// A body's mass and the frame Bullet wants it in: origin at the centre of mass, axes principal.
struct BodyFrame {
  double mass_kg = 0;
  Vec3 inertia_kg_m2 = Vec3::Zero();  ///< principal moments, about the axes of B
  Pose X_PB;                          ///< body frame in the part's frame
};

/// Throws LoadError for a volume or density that is not positive (an open or inside-out mesh gives such).
BodyFrame makeBodyFrame(const MassProperties& unit_density, double density_kg_m3);

class SheetBorder;

/// The exact surface of one part in the models' frame M.
struct Surface {
  std::shared_ptr<const MeshDistance> distance;
  Pose X_MP;
  /// Of an open surface without an inside, met on the side that a point faces; null for a solid.
  std::shared_ptr<const SheetBorder> sheet = nullptr;
};

/// What a shape is made of, all in one frame M. It is not a PartModel because a fixed field merges several
/// parts: it then has one map and one shell, but one exact surface for each part. Any model may be missing.
/// Without a map, others are tested against the surfaces (exact, and slower), or, if there are none, cannot
/// be tested. Without a shell, the shape cannot be tested against others. Without triangles, rays miss it.
struct ShapeModels {
  std::shared_ptr<const VoxMap> map;
  std::shared_ptr<const PointShell> shell;
  std::shared_ptr<const Mesh> mesh;
  /// The exact surfaces that the map was built from, in the map's owner order. The map finds the contacts;
  /// the surfaces correct the distance and normal of the few that reach the solver, which removes the map's
  /// interpolation error (up to 0.3 voxel at a sharp inner edge). Empty: the map's values are used as they
  /// are.
  std::vector<Surface> surfaces;
};

/// The models of one part, whose frame is M. They are shared, not copied: O(1).
ShapeModels makeModels(const PartModel& part);

/// Concave shape of type FAST_CONCAVE_MESH_PROXYTYPE. That type is unused by Bullet itself, is concave for
/// the ray and sweep tests, and where nothing else is registered falls back to convex-against-triangles;
/// CUSTOM_CONCAVE_SHAPE_TYPE would be cast to btSdfCollisionShape. May be dynamic, unlike Bullet's mesh
/// shapes. Shared by any number of bodies, and bound to no dispatcher: may outlive them all. Its margin is 0.
class Shape : public btConcaveShape {
 public:
  BT_DECLARE_ALIGNED_ALLOCATOR();

  /// @param X_SM  the models' frame in the shape's; for a dynamic body of a part it is
  /// BodyFrame::X_PB.inverse().
  /// Throws std::invalid_argument for models without map, shell and mesh, and for a pose that is not finite.
  explicit Shape(ShapeModels models, const Pose& X_SM = {});
  ~Shape() override;

  /// Replaces the models (a cooked body that got one more part). Only between steps; if the box grew, follow
  /// it with btCollisionWorld::updateSingleAabb for each static body of this shape. They are scaled as the
  /// shape is. Throws as the constructor; the shape then is as it was.
  void setModels(ShapeModels models);
  /// The models in use, scaled.
  [[nodiscard]] const ShapeModels& models() const { return models_; }
  [[nodiscard]] const Pose& X_SM() const { return X_SM_; }
  /// Grows with every change of the models, so that nobody keeps an impulse of a point that is gone.
  [[nodiscard]] unsigned revision() const { return revision_; }
  /// True for a shell point that stands on a sharp edge or corner of the surfaces, where the part has no one
  /// normal. False for all when there are no surfaces to tell by.
  [[nodiscard]] bool isEdgePoint(std::uint32_t id) const {
    return !is_edge_point_.empty() && is_edge_point_[id];
  }
  /// Inward unit normal of a shell point on a face, of the curved surface that the facets stand for, in the
  /// models' frame. The shell's own where there are no surfaces to tell by, and on edges.
  [[nodiscard]] const Vec3& smoothInward(std::uint32_t id) const {
    return smooth_inward_.empty() ? models_.shell->inward[id] : smooth_inward_[id];
  }
  /// The triangle that a shell point on a face lies on.
  struct PointFace {
    std::uint32_t surface = 0;  ///< index of ShapeModels::surfaces
    std::uint32_t triangle = 0;
  };
  /// Of a point that isEdgePoint() denies, where there are surfaces.
  [[nodiscard]] PointFace faceAt(std::uint32_t id) const { return face_at_[id]; }
  /// Sharp edges of the surfaces, in the models' frame.
  [[nodiscard]] const EdgeSet& edges() const { return edges_; }
  /// The sharp edges that a shell point stands on, as indices of edges().segments(): one, more at corners and
  /// joints, none on faces.
  [[nodiscard]] std::span<const std::uint32_t> edgesAt(std::uint32_t id) const {
    if (first_edge_.empty()) return {};
    return std::span(edges_at_).subspan(first_edge_[id], first_edge_[id + 1] - first_edge_[id]);
  }
  /// Box of all models in the shape's frame.
  [[nodiscard]] const Box& bounds() const { return bounds_S_; }

  void getAabb(const btTransform& X_WS, btVector3& min, btVector3& max) const override;
  /// Of the solid mesh about the shape's origin, its diagonal (exact when X_SM comes from makeBodyFrame); of
  /// the box where there is no closed mesh. Zero for a mass of zero, which is Bullet's way to say fixed.
  /// Throws std::invalid_argument for a mass that is negative or not finite.
  void calculateLocalInertia(btScalar mass, btVector3& inertia) const override;
  void processAllTriangles(btTriangleCallback* callback, const btVector3& min,
                           const btVector3& max) const override;
  /// Makes the part larger or smaller about the shape's origin, for all bodies of this shape, with the price
  /// of building its models again. Only between steps; follow it with btCollisionWorld::updateSingleAabb, and
  /// with setMassProps: Bullet keeps a body's mass. Throws std::invalid_argument for a scale that is not
  /// positive, finite and even in x, y and z (a field of distances stays one only so), and for models with a
  /// map but without surfaces or a mesh; the shape then is as it was.
  void setLocalScaling(const btVector3& scaling) override;
  const btVector3& getLocalScaling() const override { return scaling_; }
  /// Has no effect, and says so once if it should have one: contact is that of the part's surface.
  /// Throws std::invalid_argument for a margin that is negative or not a number.
  void setMargin(btScalar margin) override;
  btScalar getMargin() const override { return 0; }
  const char* getName() const override { return "Shape"; }
  /// Throws std::invalid_argument: Bullet's importer has no reader for a voxmap, and would fail later.
  [[nodiscard]] int calculateSerializeBufferSize() const override;

 private:
  class TriangleTree;
  void use(ShapeModels models, const Pose& X_SM);

  ShapeModels unscaled_, models_;
  Pose X_SM_unscaled_, X_SM_;
  btVector3 scaling_;
  Box bounds_S_;
  unsigned revision_ = 0;
  std::vector<std::uint8_t> is_edge_point_;
  std::vector<Vec3> smooth_inward_;
  std::vector<PointFace> face_at_;  // by point
  EdgeSet edges_;
  std::vector<std::uint32_t> edges_at_, first_edge_;  // edges_at_[first_edge_[id]] ... are those of a point
  std::unique_ptr<const TriangleTree> triangles_;
};

}  // namespace vps::bullet
