// SPDX-License-Identifier: BSD-3-Clause
// Reads Open Inventor and VRML by Coin, without a display: Coin's callback action provides triangles,
// matrices and materials.
#include <algorithm>
#include <cstdint>
#include <mutex>

#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoInteraction.h>
#include <Inventor/SoPath.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/VRMLnodes/SoVRMLCoordinate.h>
#include <Inventor/VRMLnodes/SoVRMLIndexedFaceSet.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/errors/SoMemoryError.h>
#include <Inventor/errors/SoReadError.h>
#include <Inventor/lists/SoPathList.h>
#include <Inventor/misc/SoChildList.h>
#include <Inventor/nodes/SoComplexity.h>
#include <Inventor/nodes/SoFaceSet.h>
#include <Inventor/nodes/SoIndexedShape.h>
#include <Inventor/nodes/SoNormal.h>
#include <Inventor/nodes/SoQuadMesh.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoShape.h>
#include <Inventor/nodes/SoTextureCoordinate2.h>
#include <Inventor/nodes/SoTriangleStripSet.h>
#include <Inventor/nodes/SoUnits.h>
#include <Inventor/nodes/SoVertexProperty.h>

#include "import/readers.h"
#include "vps/errors.h"

namespace vps::scenes::import {
namespace {

// Coin does not check the indices in a file and crashes on wrong ones, so the scene is checked first.

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

/// True if `first` plus the sum of the counts is at most `available`; a count of -1 means "all others" and
/// adds nothing.
bool addUpTo(std::int64_t first, const SoMFInt32& counts, std::int64_t available) {
  for (int i = 0; i < counts.getNum(); ++i) first += std::max(counts[i], 0);
  return first <= available;
}

/// Removes normals, texture coordinates and their indices, which only pictures need and which Coin reads
/// without a check.
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

/// True if all vertices of a shape exist, by the coordinates that apply at this point of the traversal.
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

std::string oneLine(const char* text) {
  std::string line(text ? text : "");
  for (char& c : line) c = c == '\n' || c == '\t' ? ' ' : c;
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

/// Collects Coin's messages during its lifetime, so that Coin does not print them.
class Messages {
 public:
  Messages() {
    SoReadError::setHandlerCallback(collect, this);
    SoDebugError::setHandlerCallback(ignore, nullptr);
    SoMemoryError::setHandlerCallback(collect, this);
  }
  ~Messages() {
    SoReadError::setHandlerCallback(ignore, nullptr);
    SoMemoryError::setHandlerCallback(ignore, nullptr);
  }
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;
  std::vector<std::string> lines;

 private:
  static void collect(const SoError* error, void* self) {
    static_cast<Messages*>(self)->lines.push_back(oneLine(error->getDebugString().getString()));
  }
  static void ignore(const SoError*, void*) {}
};

/// Keeps a Coin node alive for a scope.
class NodeHold {
 public:
  explicit NodeHold(SoNode* node) : node_(node) {
    if (node_) node_->ref();
  }
  ~NodeHold() {
    if (node_) node_->unref();
  }
  NodeHold(const NodeHold&) = delete;
  NodeHold& operator=(const NodeHold&) = delete;

 private:
  SoNode* node_;
};

struct Collector {
  RawCad cad;
  bool is_clockwise = false;
  std::vector<std::string> damaged;
};

/// The name of the shape, or of the nearest node above it that has a name.
std::string nameOf(const SoCallbackAction& action) {
  const SoPath* path = const_cast<SoCallbackAction&>(action).getCurPath();
  for (int i = path->getLength() - 1; i >= 0; --i) {
    const std::string name = path->getNode(i)->getName().getString();
    if (!name.empty() && name.front() != '_') return name;  // exporters write counters such as "_+0"
  }
  return "";
}

SoCallbackAction::Response beginShape(void* user, SoCallbackAction* action, const SoNode* shape) {
  auto& collector = *static_cast<Collector*>(user);
  if (!hasItsVertices(*action, *shape)) {
    collector.damaged.push_back(nameOf(*action));
    return SoCallbackAction::PRUNE;
  }
  RawPart part;
  part.name = nameOf(*action);
  const SbMatrix& m =
      action->getModelMatrix();  // Coin multiplies row vectors, so its matrix is the transpose of ours
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) part.X_WP(row, column) = double(m[column][row]);
  }
  SbColor ambient, diffuse, specular, emission;
  float shininess = 0, transparency = 0;
  action->getMaterial(ambient, diffuse, specular, emission, shininess, transparency);
  part.color = linearFromSrgb({diffuse[0], diffuse[1], diffuse[2]});
  collector.is_clockwise = action->getVertexOrdering() == SoShapeHints::CLOCKWISE;
  collector.cad.parts.push_back(std::move(part));
  return SoCallbackAction::CONTINUE;
}

void addTriangle(void* user, SoCallbackAction*, const SoPrimitiveVertex* a, const SoPrimitiveVertex* b,
                 const SoPrimitiveVertex* c) {
  auto& collector = *static_cast<Collector*>(user);
  Mesh& mesh = collector.cad.parts.back().mesh;
  const auto base = std::uint32_t(mesh.vertices.size());
  for (const SoPrimitiveVertex* v : {a, b, c}) {
    const SbVec3f& p = v->getPoint();
    mesh.vertices.emplace_back(p[0], p[1], p[2]);
  }
  if (collector.is_clockwise) {
    mesh.triangles.push_back({base, base + 2, base + 1});
  } else {
    mesh.triangles.push_back({base, base + 1, base + 2});
  }
}

bool hasUnits(SoNode* root) {
  SoSearchAction search;
  search.setType(SoUnits::getClassTypeId());
  search.setInterest(SoSearchAction::FIRST);
  search.setSearchingAll(true);
  search.apply(root);
  return search.getPath() != nullptr;
}

}  // namespace

RawCad readCoin(const std::string& file, const FileFormat& format, const ImportSettings& settings,
                const Progress&) {
  static std::mutex one_at_a_time;  // Coin's database and error handlers are global
  const std::lock_guard lock(one_at_a_time);
  if (!SoDB::isInitialized()) {
    SoDB::init();
    SoInteraction::init();  // a file may have node kits and draggers
  }
  Messages messages;
  SoInput input;
  SoSeparator* scene = input.openFile(file.c_str(), true) ? SoDB::readAll(&input) : nullptr;
  input.closeFile();
  const NodeHold hold_scene(scene);
  bool is_cut = false;
  for (const std::string& line : messages.lines)
    is_cut = is_cut || line.find("end of file") != std::string::npos;
  if (!scene || is_cut) {
    const std::string why = messages.lines.empty() ? "no scene in it" : messages.lines.front();
    throw LoadError(file, "", "is not a readable " + format.name + " file (" + why + "); export it again");
  }

  // Spheres, cones and cylinders get Coin's finest triangles, unless the file sets its own complexity.
  auto* root = new SoSeparator;
  const NodeHold hold_root(root);
  auto* complexity = new SoComplexity;
  complexity->value = 1.0f;
  root->addChild(complexity);
  root->addChild(scene);
  dropNormals(root);

  Collector collector;
  SoCallbackAction action;
  action.addPreCallback(SoShape::getClassTypeId(), beginShape, &collector);
  action.addTriangleCallback(SoShape::getClassTypeId(), addTriangle, &collector);
  action.apply(root);

  if (!collector.damaged.empty()) {
    throw LoadError(file, collector.damaged.front(),
                    "has a face with a vertex that does not exist; export it again");
  }

  RawCad cad = std::move(collector.cad);
  cad.open_shapes = Shapes::BoundBodies;
  for (RawPart& part : cad.parts) part.rounding = floatRounding(part.mesh, part.X_WP);
  for (const std::string& line : messages.lines) cad.warnings.push_back(line);
  cad.states_unit = hasUnits(root);
  if (!cad.states_unit) {
    cad.unit_m = settings.unit_m.value_or(1.0);
    if (!settings.unit_m) {
      cad.warnings.push_back("states no unit: metres are assumed, as " + format.name +
                             " defines; set unit or --units for another unit");
    }
  }
  return cad;
}

}  // namespace vps::scenes::import
