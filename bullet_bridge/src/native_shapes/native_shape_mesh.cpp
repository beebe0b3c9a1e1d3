// SPDX-License-Identifier: BSD-3-Clause
#include "native_shapes/native_shape.h"

#include <BulletCollision/CollisionShapes/btBox2dShape.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btConvexPointCloudShape.h>
#include <BulletCollision/CollisionShapes/btConvexTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btPolyhedralConvexShape.h>
#include <BulletCollision/CollisionShapes/btTriangleCallback.h>
#include <BulletCollision/CollisionShapes/btUniformScalingShape.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <LinearMath/btConvexHullComputer.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>

#include "vps_bullet/convert.h"

namespace vps::bullet {

namespace {

// A closed surface whose volume is smaller than this, relative to its size cubed, is a sheet, since float
// coordinates cannot resolve its thickness.
constexpr double kFlat = 1e-6;

[[noreturn]] void refuse(const btCollisionShape& shape, const std::string& why) {
  throw std::invalid_argument(std::string("Shape and ") + shape.getName() + " do not collide: " + why);
}

// Number of vertices on a circle for which its chords are within a micrometre of it.
int circleSegments(double radius_m) {
  constexpr double kSagitta_m = 1e-6;
  if (!(radius_m > kSagitta_m)) return 32;
  const double exact = std::numbers::pi / std::acos(1 - kSagitta_m / radius_m);
  return 4 * static_cast<int>(std::ceil(std::clamp(exact, 32.0, 1024.0) / 4));
}

// Rotates a mesh from z up to axis up, right-handed.
Mesh turnedTo(int axis, Mesh mesh) {
  for (Vec3& p : mesh.vertices) {
    const Vec3 z_up = p;
    p[axis] = z_up.z();
    p[(axis + 1) % 3] = z_up.x();
    p[(axis + 2) % 3] = z_up.y();
  }
  return mesh;
}

Mesh coneMesh(double radius_m, double height_m) {
  const int segments = circleSegments(radius_m);
  const auto count = static_cast<std::uint32_t>(segments);
  Mesh mesh;
  for (int i = 0; i < segments; ++i) {
    const double angle_rad = 2 * std::numbers::pi * i / segments;
    mesh.vertices.push_back({radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), -height_m / 2});
  }
  mesh.vertices.push_back({0, 0, height_m / 2});
  for (std::uint32_t i = 0; i < count; ++i) mesh.triangles.push_back({i, (i + 1) % count, count});
  for (std::uint32_t i = 1; i + 1 < count; ++i) mesh.triangles.push_back({0, i + 1, i});
  return mesh;
}

void flip(Mesh& mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

Vec3 areaNormal(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const Vec3& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}

// Removes one of the two coinciding sides of a flat hull.
void keepOneSide(Mesh& mesh) {
  Vec3 front = Vec3::Zero();
  for (const auto& t : mesh.triangles)
    if (areaNormal(mesh, t).norm() > front.norm()) front = areaNormal(mesh, t);
  std::erase_if(mesh.triangles, [&](const auto& t) { return !(areaNormal(mesh, t).dot(front) > 0); });
}

NativeShapeMesh hullOf(const btCollisionShape& shape, const std::vector<Vec3>& points) {
  std::vector<double> coordinates;
  for (const Vec3& p : points) {
    if (!p.allFinite()) refuse(shape, "a corner of the shape is not a number");
    coordinates.insert(coordinates.end(), {p.x(), p.y(), p.z()});
  }
  if (points.size() < 3) refuse(shape, "it has fewer than three corners");
  btConvexHullComputer computer;
  computer.compute(coordinates.data(), 3 * sizeof(double), static_cast<int>(points.size()), 0, 0);
  NativeShapeMesh hull;
  // Bullet rounds coordinates to 1/10216 of the size to find the corners. The mesh uses the corners'
  // unrounded coordinates.
  for (int i = 0; i < computer.vertices.size(); ++i)
    hull.mesh.vertices.push_back(points[static_cast<std::size_t>(computer.original_vertex_index[i])]);
  for (int f = 0; f < computer.faces.size(); ++f) {
    const btConvexHullComputer::Edge* first = &computer.edges[computer.faces[f]];
    const auto a = static_cast<std::uint32_t>(first->getSourceVertex());
    for (const auto* e = first->getNextEdgeOfFace(); e->getTargetVertex() != first->getSourceVertex();
         e = e->getNextEdgeOfFace())
      hull.mesh.triangles.push_back({a, static_cast<std::uint32_t>(e->getSourceVertex()),
                                     static_cast<std::uint32_t>(e->getTargetVertex())});
  }
  const double size_m = bounds(hull.mesh).size().norm();
  if (hull.mesh.triangles.empty() || !(area(hull.mesh) > 0)) refuse(shape, "its corners lie in a line");
  const double volume_m3 = massProperties(hull.mesh).volume_m3;
  if (volume_m3 < 0) flip(hull.mesh);
  if (std::abs(volume_m3) < kFlat * size_m * size_m * size_m) {
    hull.is_sheet = true;
    keepOneSide(hull.mesh);
  }
  return hull;
}

std::vector<Vec3> meshVertices(const btConvexTriangleMeshShape& shape) {
  struct Collect : btInternalTriangleIndexCallback {
    std::vector<Vec3> points;
    void internalProcessTriangleIndex(btVector3* corners, int, int) override {
      for (int k = 0; k < 3; ++k) points.push_back(fromBt(corners[k]));
    }
  } all;
  shape.getMeshInterface()->InternalProcessAllTriangles(&all, btVector3(-1e30f, -1e30f, -1e30f),
                                                        btVector3(1e30f, 1e30f, 1e30f));
  for (Vec3& p : all.points) p = p.cwiseProduct(fromBt(shape.getLocalScaling()));
  return std::move(all.points);
}

std::vector<Vec3> polyhedronVertices(const btPolyhedralConvexShape& shape) {
  std::vector<Vec3> points;
  for (int i = 0; i < shape.getNumVertices(); ++i) {
    btVector3 p;
    shape.getVertex(i, p);
    points.push_back(fromBt(p));
  }
  return points;
}

std::vector<Vec3> cloudPoints(const btConvexPointCloudShape& shape) {
  std::vector<Vec3> points;
  for (int i = 0; i < shape.getNumPoints(); ++i) points.push_back(fromBt(shape.getScaledPoint(i)));
  return points;
}

// Points of a shape of which only the support function is known: its values in 10,242 directions. Any
// direction that a rounding of radius r supports lies within 2.6 degrees of one of these directions, so the
// hull cuts the rounding by at most r (1 - cos 2.6 deg) = 1.03e-3 r.
std::vector<Vec3> supportPoints(const btConvexShape& shape) {
  std::vector<Vec3> points;
  for (const Vec3& direction : makeSphere(1, 5).vertices)
    points.push_back(fromBt(shape.localGetSupportingVertex(toBt(direction))));
  return points;
}

struct CountTriangles : btTriangleCallback {
  std::size_t count = 0;
  void processTriangle(btVector3*, int, int) override { ++count; }
};

struct CollectTriangles : btTriangleCallback {
  Mesh mesh;
  void processTriangle(btVector3* corners, int, int) override {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(fromBt(corners[k]));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
};

Mesh allTriangles(const btConcaveShape& shape) {
  btVector3 low, high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  const btVector3 beyond = btScalar(0.01) * (high - low) + btVector3(1, 1, 1) * btScalar(1e-3);
  CountTriangles counted;
  shape.processAllTriangles(&counted, low - beyond, high + beyond);
  if (counted.count > kMaxNativeTriangles)
    refuse(shape, "it has more than " + std::to_string(kMaxNativeTriangles) + " triangles; split it");
  CollectTriangles all;
  shape.processAllTriangles(&all, low - beyond, high + beyond);
  for (const Vec3& p : all.mesh.vertices)
    if (!p.allFinite()) refuse(shape, "a corner of the shape is not a number");
  Mesh mesh = welded(all.mesh);
  if (mesh.triangles.empty() || !(area(mesh) > 0))
    refuse(shape, "it reports no triangles; build a bullet::Shape from its mesh");
  return mesh;
}

NativeShapeMesh concaveMesh(const btConcaveShape& shape) {
  NativeShapeMesh native{allTriangles(shape), false};
  if (!checkMesh(native.mesh).isClosed())
    native.is_sheet = true;
  else if (massProperties(native.mesh).volume_m3 < 0)
    flip(native.mesh);  // wound inside out, or mirrored by a negative scale
  return native;
}

// Directed edges without an opposite edge in another triangle.
std::vector<std::array<std::uint32_t, 2>> borderOf(const Mesh& mesh) {
  std::map<std::array<std::uint32_t, 2>, int> edges;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) edges[{t[k], t[(k + 1) % 3]}] = 1;
  std::vector<std::array<std::uint32_t, 2>> border;
  for (const auto& [edge, one] : edges)
    if (!edges.count({edge[1], edge[0]})) border.push_back(edge);
  return border;
}

// Closes a terrain by walls along its border and a floor. The floor lies below the terrain by the terrain's
// width.
//
//    ~~~~~~~~~~~   the field, facing up
//    |         |   walls
//    |_________|   floor
NativeShapeMesh terrainMesh(const btHeightfieldTerrainShape& shape) {
  const int up = shape.getUpAxis();
  NativeShapeMesh terrain{allTriangles(shape), false};
  Mesh& mesh = terrain.mesh;
  for (auto& t : mesh.triangles)
    if (areaNormal(mesh, t)[up] < 0) std::swap(t[1], t[2]);
  Vec3 width = bounds(mesh).size();
  width[up] = 0;
  const double floor_m = bounds(mesh).min[up] - width.maxCoeff();
  const auto under = [&](std::uint32_t v) {
    Vec3 p = mesh.vertices[v];
    p[up] = floor_m;
    mesh.vertices.push_back(p);
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  };
  std::map<std::uint32_t, std::uint32_t> foot;
  const auto border = borderOf(mesh);
  for (const auto& [a, b] : border)
    for (const std::uint32_t v : {a, b})
      if (!foot.count(v)) foot[v] = under(v);
  const std::uint32_t center = [&] {
    mesh.vertices.push_back(bounds(mesh).center());
    mesh.vertices.back()[up] = floor_m;
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  }();
  for (const auto& [a, b] : border) {
    mesh.triangles.push_back({b, a, foot[a]});
    mesh.triangles.push_back({b, foot[a], foot[b]});
    mesh.triangles.push_back({foot[b], foot[a], center});
  }
  return terrain;
}

NativeShapeMesh scaledBy(double factor, NativeShapeMesh native) {
  for (Vec3& p : native.mesh.vertices) p *= factor;
  if (factor < 0) flip(native.mesh);
  return native;
}

// The rectangle of a 2D box. Bullet's own corners are not used, since they lie a margin below its plane.
NativeShapeMesh flatBox(const btBox2dShape& shape) {
  const Vec3 half = fromBt(shape.getHalfExtentsWithMargin());
  Mesh mesh;
  mesh.vertices = {
      {-half.x(), -half.y(), 0}, {half.x(), -half.y(), 0}, {half.x(), half.y(), 0}, {-half.x(), half.y(), 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return {mesh, true};
}

NativeShapeMesh convexMesh(const btConvexShape& shape) {
  if (const auto* triangles = dynamic_cast<const btConvexTriangleMeshShape*>(&shape))
    return hullOf(shape, meshVertices(*triangles));
  if (const auto* cloud = dynamic_cast<const btConvexPointCloudShape*>(&shape))
    return hullOf(shape, cloudPoints(*cloud));
  if (const auto* polyhedron = dynamic_cast<const btPolyhedralConvexShape*>(&shape))
    return hullOf(shape, polyhedronVertices(*polyhedron));
  return hullOf(shape, supportPoints(shape));
}

}  // namespace

NativeShapeMesh nativeShapeMesh(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case BOX_SHAPE_PROXYTYPE:
      return {makeBox(2 * fromBt(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin()))};
    case CYLINDER_SHAPE_PROXYTYPE: {
      const auto& cylinder = static_cast<const btCylinderShape&>(shape);
      const int axis = cylinder.getUpAxis();
      const double radius_m = cylinder.getRadius();
      return {turnedTo(axis, makeCylinder(radius_m, 2 * cylinder.getHalfExtentsWithMargin()[axis],
                                          circleSegments(radius_m)))};
    }
    case CONE_SHAPE_PROXYTYPE: {
      const auto& cone = static_cast<const btConeShape&>(shape);
      return {turnedTo(cone.getConeUpIndex(), coneMesh(cone.getRadius(), cone.getHeight()))};
    }
    case UNIFORM_SCALING_SHAPE_PROXYTYPE: {
      const auto& scaled = static_cast<const btUniformScalingShape&>(shape);
      return scaledBy(scaled.getUniformScalingFactor(), nativeShapeMesh(*scaled.getChildShape()));
    }
    case BOX_2D_SHAPE_PROXYTYPE:
      return flatBox(static_cast<const btBox2dShape&>(shape));
    case TERRAIN_SHAPE_PROXYTYPE:
      return terrainMesh(static_cast<const btHeightfieldTerrainShape&>(shape));
    case CONVEX_2D_SHAPE_PROXYTYPE:
      refuse(shape, "it is meant for two-dimensional worlds");
    case GIMPACT_SHAPE_PROXYTYPE:
      if (static_cast<const btGImpactShapeInterface&>(shape).getGImpactShapeType() ==
          CONST_GIMPACT_COMPOUND_SHAPE)
        refuse(shape, "a GImpact compound; put its parts into a btCompoundShape");
      break;
    default:
      break;
  }
  if (shape.isConvex()) return convexMesh(static_cast<const btConvexShape&>(shape));
  if (shape.isConcave()) return concaveMesh(static_cast<const btConcaveShape&>(shape));
  refuse(shape, "it is neither convex nor a mesh");
}

}  // namespace vps::bullet
