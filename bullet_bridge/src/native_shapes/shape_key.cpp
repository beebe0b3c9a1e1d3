// SPDX-License-Identifier: BSD-3-Clause
#include "native_shapes/native_shape.h"

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btStridingMeshInterface.h>
#include <BulletCollision/CollisionShapes/btTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btUniformScalingShape.h>
#include <LinearMath/btTransform.h>

#include <cstddef>
#include <cstring>

namespace vps::bullet {

ShapeKey keyOf(const btCollisionShape& shape) {
  ShapeKey key;
  key.type = shape.getShapeType();
  key.shape = &shape;
  if (const auto* hull = dynamic_cast<const btConvexHullShape*>(&shape))
    key.vertices = hull->getUnscaledPoints();
  if (const auto* mesh = dynamic_cast<const btTriangleMeshShape*>(&shape))
    key.vertices = mesh->getMeshInterface();
  btVector3 low, high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  const btVector3& scale = shape.getLocalScaling();
  for (int k = 0; k < 3; ++k) {
    key.numbers[k] = low[k];
    key.numbers[3 + k] = high[k];
    key.numbers[6 + k] = scale[k];
  }
  return key;
}

namespace {

constexpr std::uint64_t kPrime = 0x100000001b3ull;

/// FNV-1a over words of eight bytes. The three words of a row go to three independent sums, so that their
/// multiplications overlap.
class Hash {
 public:
  /// @param bytes  size of a row, which has three coordinates or indices
  void addRows(const void* first, std::size_t rows, std::ptrdiff_t stride, std::size_t bytes) {
    const auto* at = static_cast<const unsigned char*>(first);
    switch (bytes) {
      case 24:
        return addRows<24>(at, rows, stride);
      case 12:
        return addRows<12>(at, rows, stride);
      case 6:
        return addRows<6>(at, rows, stride);
      default:
        return addRows<3>(at, rows, stride);
    }
  }
  [[nodiscard]] std::uint64_t total() const {
    std::uint64_t total = rows_;
    for (const std::uint64_t sum : sum_) total = (total ^ sum ^ (sum >> 29)) * kPrime;
    return total;
  }

 private:
  template <std::size_t kBytes>
  void addRows(const unsigned char* at, std::size_t rows, std::ptrdiff_t stride) {
    std::uint64_t a = sum_[0], b = sum_[1], c = sum_[2];
    for (std::size_t i = 0; i < rows; ++i, at += stride) {
      std::uint64_t word[3] = {0, 0, 0};
      std::memcpy(word, at, kBytes);
      a = (a ^ word[0]) * kPrime;
      if (kBytes > 8) b = (b ^ word[1]) * kPrime;
      if (kBytes > 16) c = (c ^ word[2]) * kPrime;
    }
    sum_[0] = a, sum_[1] = b, sum_[2] = c;
    rows_ += rows;
  }
  std::uint64_t sum_[3] = {0xcbf29ce484222325ull, 0x9ae16a3b2f90404full, 0xc949d7c7509e6557ull};  // assumed
  std::uint64_t rows_ = 0;
};

std::size_t bytesOf(PHY_ScalarType type) {
  switch (type) {
    case PHY_DOUBLE:
      return 8;
    case PHY_SHORT:
      return 2;
    case PHY_UCHAR:
      return 1;
    default:
      return 4;
  }
}

void add(const btStridingMeshInterface& mesh, Hash& hash) {
  for (int part = 0; part < mesh.getNumSubParts(); ++part) {
    const unsigned char *vertices = nullptr, *indices = nullptr;
    int vertex_count = 0, vertex_stride = 0, index_stride = 0, triangle_count = 0;
    PHY_ScalarType vertex_type = PHY_FLOAT, index_type = PHY_INTEGER;
    mesh.getLockedReadOnlyVertexIndexBase(&vertices, vertex_count, vertex_type, vertex_stride, &indices,
                                          index_stride, triangle_count, index_type, part);
    hash.addRows(vertices, static_cast<std::size_t>(vertex_count), vertex_stride, 3 * bytesOf(vertex_type));
    hash.addRows(indices, static_cast<std::size_t>(triangle_count), index_stride, 3 * bytesOf(index_type));
    mesh.unLockReadOnlyVertexBase(part);
  }
}

}  // namespace

std::uint64_t contentHash(const btCollisionShape& shape) {
  Hash hash;
  if (shape.getShapeType() == UNIFORM_SCALING_SHAPE_PROXYTYPE)
    return contentHash(*static_cast<const btUniformScalingShape&>(shape).getChildShape());
  if (const auto* scaled = dynamic_cast<const btScaledBvhTriangleMeshShape*>(&shape))
    return contentHash(*scaled->getChildShape());
  if (const auto* hull = dynamic_cast<const btConvexHullShape*>(&shape)) {
    hash.addRows(hull->getUnscaledPoints(), static_cast<std::size_t>(hull->getNumPoints()), sizeof(btVector3),
                 3 * sizeof(btScalar));
  } else if (const auto* mesh = dynamic_cast<const btTriangleMeshShape*>(&shape)) {
    add(*mesh->getMeshInterface(), hash);
  } else {
    const Mesh triangles = nativeShapeMesh(shape).mesh;
    for (const auto& t : triangles.triangles)
      for (const std::uint32_t v : t) hash.addRows(triangles.vertices[v].data(), 1, 0, 3 * sizeof(double));
  }
  return hash.total();
}

}  // namespace vps::bullet
