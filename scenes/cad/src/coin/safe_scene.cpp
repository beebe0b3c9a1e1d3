// SPDX-License-Identifier: BSD-3-Clause
#include "coin/safe_scene.h"

#include <algorithm>
#include <cstdint>

#include <Inventor/SoPath.h>
#include <Inventor/VRMLnodes/SoVRMLCoordinate.h>
#include <Inventor/VRMLnodes/SoVRMLIndexedFaceSet.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/lists/SoPathList.h>
#include <Inventor/nodes/SoFaceSet.h>
#include <Inventor/nodes/SoIndexedShape.h>
#include <Inventor/nodes/SoNormal.h>
#include <Inventor/nodes/SoQuadMesh.h>
#include <Inventor/nodes/SoTextureCoordinate2.h>
#include <Inventor/nodes/SoTriangleStripSet.h>
#include <Inventor/nodes/SoVertexProperty.h>

namespace vps::scenes::import {
namespace {

/// Calls f on every node of type T under root, including those behind switches.
template <class T, class F>
void forAll(SoNode* root, F f) {
  SoSearchAction search;
  search.setType(T::getClassTypeId());
  search.setInterest(SoSearchAction::ALL);
  search.setSearchingAll(true);
  search.apply(root);
  const SoPathList& paths = search.getPaths();
  for (int i = 0; i < paths.getLength(); ++i)
    f(static_cast<T&>(*static_cast<SoFullPath*>(paths[i])->getTail()));
}

std::int64_t vertexCount(const SoCallbackAction& action, const SoVertexShape& shape) {
  const SoNode* node = shape.vertexProperty.getValue();
  if (node && node->isOfType(SoVertexProperty::getClassTypeId())) {
    const int own = static_cast<const SoVertexProperty*>(node)->vertex.getNum();
    if (own > 0) return own;
  }
  return action.getNumCoordinates();
}

bool areBelow(const SoMFInt32& indices, std::int64_t count) {
  const std::int32_t* values = indices.getValues(0);
  return std::all_of(values, values + indices.getNum(), [&](std::int32_t i) { return i < count; });
}

/// True if first plus the sum of the counts is within the list; a count of -1 means "the rest".
bool addUpTo(std::int64_t first, const SoMFInt32& counts, std::int64_t available) {
  for (int i = 0; i < counts.getNum(); ++i) first += std::max(counts[i], 0);
  return first <= available;
}

}  // namespace

void dropNormals(SoNode* root) {
  forAll<SoNormal>(root, [](SoNormal& node) { node.vector.setNum(0); });
  forAll<SoTextureCoordinate2>(root, [](SoTextureCoordinate2& node) { node.point.setNum(0); });
  forAll<SoVertexProperty>(root, [](SoVertexProperty& node) {
    node.normal.setNum(0);
    node.texCoord.setNum(0);
  });
  forAll<SoIndexedShape>(root, [](SoIndexedShape& shape) {
    shape.normalIndex.setValue(-1);
    shape.textureCoordIndex.setValue(-1);
    shape.materialIndex.setValue(-1);
  });
  forAll<SoVRMLIndexedFaceSet>(root, [](SoVRMLIndexedFaceSet& shape) {
    shape.normal.setValue(nullptr);
    shape.normalIndex.setNum(0);
    shape.texCoord.setValue(nullptr);
    shape.texCoordIndex.setNum(0);
    shape.color.setValue(nullptr);
    shape.colorIndex.setNum(0);
  });
}

bool hasItsVertices(const SoCallbackAction& action, const SoNode& shape) {
  if (shape.isOfType(SoIndexedShape::getClassTypeId())) {
    const auto& indexed = static_cast<const SoIndexedShape&>(shape);
    return areBelow(indexed.coordIndex, vertexCount(action, indexed));
  }
  if (shape.isOfType(SoVRMLIndexedFaceSet::getClassTypeId())) {
    const auto& indexed = static_cast<const SoVRMLIndexedFaceSet&>(shape);
    const SoNode* points = indexed.coord.getValue();
    const bool has_points = points && points->isOfType(SoVRMLCoordinate::getClassTypeId());
    return areBelow(indexed.coordIndex,
                    has_points ? static_cast<const SoVRMLCoordinate*>(points)->point.getNum() : 0);
  }
  if (shape.isOfType(SoFaceSet::getClassTypeId())) {
    const auto& set = static_cast<const SoFaceSet&>(shape);
    return addUpTo(set.startIndex.getValue(), set.numVertices, vertexCount(action, set));
  }
  if (shape.isOfType(SoTriangleStripSet::getClassTypeId())) {
    const auto& set = static_cast<const SoTriangleStripSet&>(shape);
    return addUpTo(set.startIndex.getValue(), set.numVertices, vertexCount(action, set));
  }
  if (shape.isOfType(SoQuadMesh::getClassTypeId())) {
    const auto& mesh = static_cast<const SoQuadMesh&>(shape);
    return mesh.startIndex.getValue() +
               std::int64_t(mesh.verticesPerRow.getValue()) * mesh.verticesPerColumn.getValue() <=
           vertexCount(action, mesh);
  }
  return true;
}

}  // namespace vps::scenes::import
