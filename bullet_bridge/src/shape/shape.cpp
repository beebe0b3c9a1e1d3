// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/shape.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include "log/report.h"
#include "shape/sheet_border.h"
#include "shape/triangle_tree.h"
#include "vps/errors.h"
#include "vps/feature_motion.h"
#include "vps/mesh_repair.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {

namespace {

// Reports, once, a harmless call without effect.
void warnOnce(std::atomic_flag& was_reported, const char* message) {
  if (!was_reported.test_and_set()) report(LogLevel::Warning, message);
}

std::uint64_t nextRevision() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

Mat3 inertiaAboutCom(const MassProperties& unit_density, double density) {
  return unit_density.inertia_m5 * density;
}

// Parallel axes theorem: inertia about O of a mass whose centre is at p from O.
Mat3 shiftedInertia(const Mat3& about_com, double mass_kg, const Vec3& p) {
  return about_com + mass_kg * (p.squaredNorm() * Mat3::Identity() - p * p.transpose());
}

void requireUsable(const SurfaceMaterial& m) {
  if (m.friction && (!(*m.friction >= 0) || !std::isfinite(*m.friction)))
    throw std::invalid_argument("Shape: a surface's friction must not be negative, and must be finite");
  if (m.restitution && !(*m.restitution >= 0 && *m.restitution <= 1))
    throw std::invalid_argument("Shape: a surface's restitution must be from 0 to 1");
  if (m.stiffness_N_per_m3 && (!(*m.stiffness_N_per_m3 > 0) || !std::isfinite(*m.stiffness_N_per_m3)))
    throw std::invalid_argument("Shape: a surface's stiffness_N_per_m3 must be positive and finite");
}

void requireModels(const ShapeModels& models) {
  if (!models.map && !models.shell && !models.mesh)
    throw std::invalid_argument("Shape: there are no models; give a map, a shell or a mesh (makeModels)");
  for (const Surface& surface : models.surfaces) requireUsable(surface.material);
}

/// Mass properties, at unit density, of the solid that the mesh describes.
MassProperties solidMass(const ShapeModels& models) {
  const bool has_own_solid = models.surfaces.size() == 1 && models.surfaces[0].X_MP.R.isIdentity(0) &&
                             models.surfaces[0].X_MP.p.isZero(0) && !models.surfaces[0].distance->isSheet();
  return has_own_solid ? models.surfaces[0].distance->mass() : vps::solidMass(*models.mesh);
}

Box boxOf(const PointShell& shell) {
  Box box;
  for (const Vec3& p : shell.points) box.add(p);
  return box;
}

struct PointNormals {
  std::vector<std::uint8_t> is_edge;  // by point
  std::vector<Vec3> smooth_inward;
  std::vector<Shape::PointFace> faces;
  std::vector<std::uint16_t> surfaces;  // by point, also for edge points; empty if there is only one surface
};

constexpr double kOnSurface_m = 1e-6;

// Surface nearest to a point. Mesh repair may move a part's surface, so that the point lies on no surface
// exactly.
std::uint16_t nearestSurface(const ShapeModels& models, const Vec3& p_M) {
  std::uint16_t nearest = 0;
  double least_m = models.shell->spacing_m;
  for (std::size_t s = 0; s < models.surfaces.size(); ++s) {
    const Surface& surface = models.surfaces[s];
    const MeshDistance::Closest closest = surface.distance->closest(surface.X_MP.inverse() * p_M, least_m);
    if (!closest.found) continue;
    least_m = closest.distance_m;
    nearest = static_cast<std::uint16_t>(s);
  }
  return nearest;
}

// A point on a face has the normal of that face; a point on an edge has the mean of several.
PointNormals findNormals(const ShapeModels& models) {
  constexpr double kCosFace =
      0.99;  // 8 degrees; at an edge of 20 degrees or more the mean normal is 10 degrees or more away
  if (!models.shell || models.surfaces.empty()) return {};
  const std::size_t count = models.shell->size();
  PointNormals normals{
      std::vector<std::uint8_t>(count, 1), models.shell->inward, std::vector<Shape::PointFace>(count), {}};
  if (models.surfaces.size() > 1) normals.surfaces.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    bool is_found = false;
    for (std::uint32_t s = 0; s < models.surfaces.size(); ++s) {
      const Surface& surface = models.surfaces[s];
      const Pose X_PM = surface.X_MP.inverse();
      const MeshDistance::Closest closest =
          surface.distance->closest(X_PM * models.shell->points[i], kOnSurface_m);
      if (!closest.found) continue;
      is_found = true;
      if (!normals.surfaces.empty() && normals.is_edge[i] != 0)
        normals.surfaces[i] = static_cast<std::uint16_t>(s);
      const Vec3 outward = -(X_PM.R * models.shell->inward[i]);
      const Vec3 face = surface.distance->featureNormal(closest.triangle, 0);
      const double side = surface.sheet && outward.dot(face) < 0 ? -1 : 1;  // a sheet has points on both
      if (side * outward.dot(face) <= kCosFace) continue;
      // A point on the border of a sheet counts as an edge point, since the sheet ends there.
      if (surface.sheet && surface.sheet->isOnBorder(closest.triangle, closest.q)) continue;
      normals.is_edge[i] = 0;
      normals.smooth_inward[i] =
          -side * (surface.X_MP.R * surface.distance->smoothNormal(closest.triangle, closest.q));
      normals.faces[i] = {s, closest.triangle};
      if (!normals.surfaces.empty()) normals.surfaces[i] = static_cast<std::uint16_t>(s);
    }
    if (!is_found && !normals.surfaces.empty())
      normals.surfaces[i] = nearestSurface(models, models.shell->points[i]);
  }
  return normals;
}

// Sheets contribute no edges: whether an edge of a sheet is a ridge or a groove depends on the side from
// which it is met. At sheets, points and features act instead of edges.
EdgeSet edgesOf(const std::vector<Surface>& surfaces) {
  std::vector<EdgeSegment> segments;
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    if (!surfaces[i].sheet)
      appendEdges(surfaces[i].distance->mesh(), surfaces[i].X_MP, static_cast<std::uint16_t>(i), segments);
  return EdgeSet(std::move(segments));
}

FeatureSet featuresOf(const std::vector<Surface>& surfaces) {
  FeatureSet features;
  for (const Surface& surface : surfaces)
    features.append(surface.distance->mesh(), surface.X_MP, surface.sheet != nullptr);
  features.build();
  return features;
}

}  // namespace

BodyFrame makeBodyFrame(const MassProperties& unit_density, double density_kg_m3) {
  if (!(unit_density.volume_m3 > 0))
    throw LoadError("", "", "the part's volume is not positive: its mesh is open or inside out");
  if (!(density_kg_m3 > 0) || !std::isfinite(density_kg_m3))
    throw LoadError(
        "", "",
        "the part's density must be positive and finite, not " + std::to_string(density_kg_m3) + " kg/m^3");
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(inertiaAboutCom(unit_density, density_kg_m3));
  BodyFrame frame;
  frame.mass_kg = unit_density.volume_m3 * density_kg_m3;
  frame.inertia_kg_m2 = eigen.eigenvalues().cwiseMax(0);
  Mat3 axes = eigen.eigenvectors();
  if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
  frame.X_PB = Pose(axes, unit_density.com);
  return frame;
}

ShapeModels makeModels(const PartModel& part) {
  ShapeModels models;
  models.map = part.map;
  models.shell = part.shell;
  models.mesh = part.mesh;
  if (part.solid) models.surfaces = {{part.solid, Pose()}};
  if (part.solid && part.solid->isSheet())
    models.surfaces[0].sheet = std::make_shared<const SheetBorder>(part.solid->mesh());
  return models;
}

Shape::Shape(ShapeModels models, const Pose& X_SM) : X_SM_unscaled_(X_SM), scaling_(1, 1, 1) {
  m_shapeType = FAST_CONCAVE_MESH_PROXYTYPE;
  m_collisionMargin = 0;
  if (!X_SM.isFinite()) throw std::invalid_argument("Shape: the models' pose X_SM is not finite");
  setModels(std::move(models));
}

Shape::~Shape() = default;

void Shape::setModels(ShapeModels models) {
  requireModels(models);
  const double scale = scaling_.x();
  ShapeModels scaled = scale == 1 ? models : atScale(models, scale);
  unscaled_ = std::move(models);
  use(std::move(scaled), Pose(X_SM_unscaled_.R, scale * X_SM_unscaled_.p));
}

void Shape::use(ShapeModels models, const Pose& X_SM) {
  models_ = std::move(models);
  X_SM_ = X_SM;
  revision_ = nextRevision();
  PointNormals normals = findNormals(models_);
  is_edge_point_ = std::move(normals.is_edge);
  smooth_inward_ = std::move(normals.smooth_inward);
  face_at_ = std::move(normals.faces);
  surface_at_ = std::move(normals.surfaces);
  edges_ = edgesOf(models_.surfaces);
  features_ = featuresOf(models_.surfaces);
  edges_at_.clear();
  first_edge_.assign(is_edge_point_.empty() ? 0 : 1, 0);
  for (std::size_t i = 0; i < is_edge_point_.size(); ++i) {
    if (is_edge_point_[i] != 0)
      edges_.tree().forEachNear(models_.shell->points[i], kOnSurface_m,
                                [this](std::uint32_t segment) { edges_at_.push_back(segment); });
    first_edge_.push_back(static_cast<std::uint32_t>(edges_at_.size()));
  }
  Box box_M;
  const auto include = [&box_M](const Box& box) {
    if (box.isEmpty()) return;
    box_M.add(box.min);
    box_M.add(box.max);
  };
  if (models_.map) include(models_.map->bounds());
  if (models_.shell) include(boxOf(*models_.shell));
  if (models_.mesh) include(vps::bounds(*models_.mesh));
  bounds_S_ = Box();
  if (box_M.isEmpty()) {
    bounds_S_.add(X_SM_.p);
  } else {
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p_M(corner & 1 ? box_M.max.x() : box_M.min.x(), corner & 2 ? box_M.max.y() : box_M.min.y(),
                     corner & 4 ? box_M.max.z() : box_M.min.z());
      bounds_S_.add(X_SM_ * p_M);
    }
  }
  triangles_ = models_.mesh ? std::make_unique<const TriangleTree>(*models_.mesh, X_SM_) : nullptr;
}

std::uint16_t Shape::surfaceOfVertex(std::uint32_t vertex) const {
  std::uint16_t i = 0;
  for (std::size_t end = 0; i + std::size_t{1} < models_.surfaces.size(); ++i) {
    end += models_.surfaces[i].distance->mesh().vertices.size();
    if (vertex < end) break;
  }
  return i;
}

void Shape::getAabb(const btTransform& X_WS, btVector3& min, btVector3& max) const {
  if (!isContactInstalled()) warnOfForgottenInstall();
  const Pose X = fromBt(X_WS);
  const Vec3 center = X * bounds_S_.center();
  // btCompoundShape's algorithm visits only children whose boxes overlap, and parts at rest on each other
  // have a gap.
  const Vec3 half =
      X.R.cwiseAbs() * (0.5 * bounds_S_.size()) + Vec3(Vec3::Constant(2 * FeatureMotion::kRest_m));
  min = toBt(Vec3(center - half));
  max = toBt(Vec3(center + half));
}

void Shape::calculateLocalInertia(btScalar mass, btVector3& inertia) const {
  if (!(mass >= 0) || !std::isfinite(mass))
    throw std::invalid_argument("Shape: the mass must be positive, or 0 for a fixed body, not " +
                                std::to_string(mass) + " kg");
  if (models_.mesh) {
    const MassProperties unit = solidMass(models_);
    if (unit.volume_m3 > 0) {
      const Mat3 about_com = inertiaAboutCom(unit, mass / unit.volume_m3);
      const Mat3 about_So = shiftedInertia(X_SM_.R * about_com * X_SM_.R.transpose(), mass, X_SM_ * unit.com);
      inertia = toBt(Vec3(about_So.diagonal()));
      return;
    }
  }
  const Vec3 s = bounds_S_.size().cwiseAbs2() * (mass / 12);  // a solid box
  inertia = toBt(Vec3(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()));
}

void Shape::processAllTriangles(btTriangleCallback* callback, const btVector3& min,
                                const btVector3& max) const {
  if (!triangles_) return;
  Box box;
  box.min = fromBt(min);
  box.max = fromBt(max);
  if (!triangles_->visitCast(box, *callback)) triangles_->visit(box, *callback);
}

void Shape::setLocalScaling(const btVector3& scaling) {
  const double scale = scaling.x();
  if (scaling.y() != scaling.x() || scaling.z() != scaling.x() || !(scale > 0) || !std::isfinite(scale)) {
    std::ostringstream words;
    words << "Shape: cannot be scaled by (" << scaling.x() << ", " << scaling.y() << ", " << scaling.z()
          << "), only by one positive number on all axes; scale the mesh and build its models again";
    throw std::invalid_argument(words.str());
  }
  if (scaling == scaling_) return;
  ShapeModels scaled = scale == 1 ? unscaled_ : atScale(unscaled_, scale);
  scaling_ = scaling;
  use(std::move(scaled), Pose(X_SM_unscaled_.R, scale * X_SM_unscaled_.p));
}

void Shape::setMargin(btScalar margin) {
  if (!(margin >= 0))
    throw std::invalid_argument(
        "Shape: setMargin() must not get a negative margin; a margin has no effect in any case");
  static std::atomic_flag was_reported;
  if (margin != 0)
    warnOnce(was_reported,
             "setMargin() has no effect on a bullet::Shape: contact is always at the part's surface");
}

}  // namespace vps::bullet
