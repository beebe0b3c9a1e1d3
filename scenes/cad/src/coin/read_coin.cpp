// SPDX-License-Identifier: BSD-3-Clause
// Open Inventor and VRML by Coin, without a display: its callback action provides triangles, matrices and
// materials.
#include <mutex>

#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoInteraction.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/actions/SoSearchAction.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/errors/SoMemoryError.h>
#include <Inventor/errors/SoReadError.h>
#include <Inventor/misc/SoChildList.h>
#include <Inventor/nodes/SoComplexity.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoShape.h>
#include <Inventor/nodes/SoUnits.h>

#include "coin/safe_scene.h"
#include "import/readers.h"
#include "vps/errors.h"

namespace vps::scenes::import {
namespace {

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

/// The name of the shape, or of the nearest node above it that has one.
std::string nameOf(const SoCallbackAction& action) {
  const SoPath* path = const_cast<SoCallbackAction&>(action).getCurPath();
  for (int i = path->getLength() - 1; i >= 0; --i) {
    const std::string name = path->getNode(i)->getName().getString();
    if (!name.empty() && name.front() != '_') return name;  // exporters use "_+0" and the like as counters
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
  const SbMatrix& m = action->getModelMatrix();  // for row vectors: the transpose of ours
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

RawCad readCoin(const std::string& file, const std::string& format, const ImportSettings& settings,
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
    throw LoadError(file, "", "is not a readable " + format + " file (" + why + "); export it again");
  }

  // Spheres, cones and cylinders are as fine as Coin makes them, unless the file sets it.
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
      cad.warnings.push_back("states no unit: metres are assumed, as " + format +
                             " defines; set unit or --units for another unit");
    }
  }
  return cad;
}

}  // namespace vps::scenes::import
