// SPDX-License-Identifier: BSD-3-Clause
#include "vps_bullet/shape.h"

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <LinearMath/btSerializer.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <locale>
#include <sstream>
#include <stdexcept>

#include "log/report.h"
#include "vps/errors.h"
#include "vps_bullet/convert.h"

namespace vps::bullet {

namespace {

// First word of a saved shape's name. Voxel size, band in voxels, spacing, and the models' pose in the
// shape's frame (position, quaternion) follow.
constexpr const char* kName = "vps::bullet::Shape/1";

struct Resolved {
  double voxel_m = 0, band_voxels = 0, spacing_m = 0;
  Pose X_SM;
};

std::string nameOf(const ShapeModels& models, const Pose& X_SM) {
  std::ostringstream words;
  words.imbue(std::locale::classic());
  words.precision(std::numeric_limits<double>::max_digits10);
  const double voxel_m = models.map ? models.map->voxel_m() : 0;
  words << kName << ' ' << voxel_m << ' ' << (models.map ? models.map->band_m() / voxel_m : 0) << ' '
        << (models.shell ? models.shell->spacing_m : 0);
  const Quat q(X_SM.R);
  for (const double x : {X_SM.p.x(), X_SM.p.y(), X_SM.p.z(), q.w(), q.x(), q.y(), q.z()}) words << ' ' << x;
  return words.str();
}

bool read(const char* saved_as, Resolved& saved) {
  std::istringstream words(saved_as);
  words.imbue(std::locale::classic());
  std::string name;
  Quat q;
  words >> name;
  if (name != kName) return false;
  words >> saved.voxel_m >> saved.band_voxels >> saved.spacing_m >> saved.X_SM.p.x() >> saved.X_SM.p.y() >>
      saved.X_SM.p.z() >> q.w() >> q.x() >> q.y() >> q.z();
  if (!words || !(std::abs(q.norm() - 1) < 1e-6) || !saved.X_SM.p.allFinite())
    throw LoadError("", "",
                    "the name of a saved bullet::Shape contains invalid numbers: " + std::string(saved_as));
  saved.X_SM.R = q.normalized().toRotationMatrix();
  return true;
}

std::uint32_t indexAt(const unsigned char* at, PHY_ScalarType type) {
  if (type == PHY_UCHAR) return *at;
  std::uint16_t of_two = 0;
  std::uint32_t of_four = 0;
  if (type == PHY_SHORT)
    std::memcpy(&of_two, at, sizeof of_two);
  else
    std::memcpy(&of_four, at, sizeof of_four);
  return type == PHY_SHORT ? of_two : of_four;
}

// Throws if an index is beyond the vertices, since Bullet reads them unchecked.
void requireIndicesInRange(const btStridingMeshInterface& triangles) {
  for (int part = 0; part < triangles.getNumSubParts(); ++part) {
    const unsigned char *vertices = nullptr, *indices = nullptr;
    int vertex_count = 0, vertex_stride = 0, index_stride = 0, triangle_count = 0;
    PHY_ScalarType vertex_type{}, index_type{};
    triangles.getLockedReadOnlyVertexIndexBase(&vertices, vertex_count, vertex_type, vertex_stride, &indices,
                                               index_stride, triangle_count, index_type, part);
    const int index_bytes = index_type == PHY_UCHAR ? 1 : index_type == PHY_SHORT ? 2 : 4;
    std::string wrong;
    for (int t = 0; t < triangle_count && wrong.empty(); ++t)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t v = indexAt(indices + t * index_stride + k * index_bytes, index_type);
        if (v >= static_cast<std::uint32_t>(vertex_count))
          wrong = "meshOf: triangle " + std::to_string(t) + " names vertex " + std::to_string(v) + " of " +
                  std::to_string(vertex_count);
      }
    triangles.unLockReadOnlyVertexBase(part);
    if (!wrong.empty()) throw std::invalid_argument(wrong);
  }
}

}  // namespace

Mesh meshOf(const btStridingMeshInterface& triangles) {
  struct All : btInternalTriangleIndexCallback {
    Mesh mesh;
    void internalProcessTriangleIndex(btVector3* corners, int, int) override {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (int k = 0; k < 3; ++k) mesh.vertices.push_back(fromBt(corners[k]));
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
  } all;
  requireIndicesInRange(triangles);
  const btScalar far = toBt(1e30);
  triangles.InternalProcessAllTriangles(&all, btVector3(-far, -far, -far), btVector3(far, far, far));
  if (all.mesh.triangles.empty()) throw std::invalid_argument("meshOf: the mesh has no triangles");
  for (const Vec3& p : all.mesh.vertices)
    if (!p.allFinite()) throw std::invalid_argument("meshOf: a vertex of the mesh is not finite");
  return welded(all.mesh);
}

std::unique_ptr<Shape> restoreShape(const char* saved_as, const btStridingMeshInterface& triangles) {
  Resolved saved;
  if (!saved_as || !read(saved_as, saved)) return nullptr;
  VoxMapSettings voxels;
  PointShellSettings points;
  if (saved.voxel_m != 0) voxels = {saved.voxel_m, saved.band_voxels};
  if (saved.spacing_m != 0) points.spacing_m = saved.spacing_m;
  // Only a sheet has a shell but no map.
  const OpenMesh open = saved.voxel_m != 0 ? OpenMesh::Solid : OpenMesh::Sheet;
  const auto part = buildPartModel("saved shape", transformed(meshOf(triangles), saved.X_SM.inverse()),
                                   voxels, points, {}, open);
  ShapeModels models = makeModels(*part);
  if (saved.voxel_m == 0) models.map = nullptr;
  if (saved.spacing_m == 0) models.shell = nullptr;
  return std::make_unique<Shape>(std::move(models), saved.X_SM);
}

/// Data to which a serializer refers by address.
struct Shape::Saved {
  std::string name;
  std::vector<btVector3> vertices;
  std::vector<int> corners;
  std::unique_ptr<btTriangleIndexVertexArray> triangles;
  std::unique_ptr<btBvhTriangleMeshShape> mesh;
  btCompoundShape compound;
};

int Shape::calculateSerializeBufferSize() const {
  return sizeof(btCompoundShapeData);
}

const char* Shape::serialize(void* data, btSerializer* serializer) const {
  saved_ = std::make_shared<Saved>();
  Saved& saved = *saved_;
  if (models_.mesh && !models_.mesh->triangles.empty()) {
    for (const Vec3& p : models_.mesh->vertices) saved.vertices.push_back(toBt(Vec3(X_SM_ * p)));
    for (const auto& triangle : models_.mesh->triangles)
      for (const std::uint32_t v : triangle) saved.corners.push_back(static_cast<int>(v));
    saved.triangles = std::make_unique<btTriangleIndexVertexArray>(
        static_cast<int>(saved.corners.size() / 3), saved.corners.data(), static_cast<int>(3 * sizeof(int)),
        static_cast<int>(saved.vertices.size()), &saved.vertices[0].m_floats[0],
        static_cast<int>(sizeof(btVector3)));
    saved.mesh = std::make_unique<btBvhTriangleMeshShape>(saved.triangles.get(), true, false);
    saved.compound.addChildShape(btTransform::getIdentity(), saved.mesh.get());
  } else {
    report(LogLevel::Error,
           "a bullet::Shape without a mesh was saved as an empty compound: set ShapeModels::mesh");
  }
  const char* type = saved.compound.serialize(data, serializer);
  saved.name = nameOf(models_, X_SM_);
  static_cast<btCompoundShapeData*>(data)->m_collisionShapeData.m_name =
      static_cast<char*>(serializer->getUniquePointer(saved.name.data()));
  serializer->serializeName(saved.name.c_str());
  return type;
}

}  // namespace vps::bullet
