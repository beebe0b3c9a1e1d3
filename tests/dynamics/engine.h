// SPDX-License-Identifier: BSD-3-Clause
// Who finds the contacts of a scene: VPS, or a rival on the same meshes, poses and solver settings.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "part.h"
#include "vps_bullet/install.h"

class btCollisionDispatcher;

namespace vps::dynamics {

/// How contacts become motion (DESIGN section 8).
enum class Mode {
  Constraint,       ///< rigid contacts, Solver
  Penalty,          ///< springs on every touching point, Solver
  ConstraintStock,  ///< rigid contacts, Bullet's own sequential impulses
};
const char* nameOf(Mode mode);

/// A Bullet shape together with what it refers to.
using ShapeHandle = std::shared_ptr<btCollisionShape>;

struct Engine {
  std::string name;
  std::function<void(btCollisionDispatcher&, Mode)> install;
  std::function<void(btCollisionDispatcher&)> uninstall;
  /// @param is_fixed  the body will not move (a rival may have a cheaper shape for that)
  std::function<ShapeHandle(const PartMesh& part, bool is_fixed)> makeShape;
};

/// How finely VPS models a part.
struct Resolution {
  double voxel_m = 0.25e-3;
  double spacing_m = 0.5e-3;
};

/// VPS with these settings (their mode is the scene's). Shapes are built once for each mesh and resolution of
/// this engine, and shared.
Engine vpsEngine(const Resolution& resolution = {}, const bullet::Settings& settings = {});

}  // namespace vps::dynamics
