// SPDX-License-Identifier: BSD-3-Clause
#include "engine.h"

#include <map>

namespace vps::dynamics {

namespace {

ShapeHandle buildShape(const PartMesh& part, const Resolution& resolution) {
  VoxMapSettings voxels;
  voxels.voxel_m = resolution.voxel_m;
  PointShellSettings points;
  points.spacing_m = resolution.spacing_m;
  const auto built = buildPartModel("", part.mesh, voxels, points);
  return std::make_shared<bullet::Shape>(bullet::makeModels(*built), part.frame.X_PB.inverse());
}

}  // namespace

const char* nameOf(Mode mode) {
  switch (mode) {
    case Mode::Constraint:
      return "constraint";
    case Mode::Penalty:
      return "penalty";
    default:
      return "constraint, stock solver";
  }
}

Engine vpsEngine(const Resolution& resolution, const bullet::Settings& settings) {
  // Parts with the same surface share their exact distance, so its address identifies them.
  using Shapes = std::map<std::shared_ptr<const Solid>, ShapeHandle>;
  const auto shapes = std::make_shared<Shapes>();
  Engine engine;
  engine.name = "VPS";
  engine.install = [settings](btCollisionDispatcher& dispatcher, Mode mode) {
    bullet::Settings with_method = settings;
    with_method.contact_method =
        mode == Mode::Penalty ? vps::ContactMethod::Penalty : vps::ContactMethod::Constraint;
    bullet::install(dispatcher, with_method);
  };
  engine.uninstall = [](btCollisionDispatcher& dispatcher) { bullet::uninstall(dispatcher); };
  engine.makeShape = [shapes, resolution](const PartMesh& part, bool) {
    ShapeHandle& shape = (*shapes)[part.exact];
    if (!shape) shape = buildShape(part, resolution);
    return shape;
  };
  return engine;
}

}  // namespace vps::dynamics
