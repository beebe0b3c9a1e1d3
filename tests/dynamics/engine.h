// SPDX-License-Identifier: BSD-3-Clause
// The contact engine of a scene: VPS, or another one with the same meshes, poses and solver settings.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "part.h"
#include "vps_bullet/install.h"

class btCollisionDispatcher;

namespace vps::dynamics {

/// Contact method and solver.
enum class Mode {
  Constraint,       ///< rigid contacts, bullet::Solver
  Penalty,          ///< a penalty force at every touching point, bullet::Solver
  ConstraintStock,  ///< rigid contacts, Bullet's own sequential impulses solver
};
const char* nameOf(Mode mode);

/// A Bullet shape together with everything that it refers to.
using ShapeHandle = std::shared_ptr<btCollisionShape>;

struct Engine {
  std::string name;
  std::function<void(btCollisionDispatcher&, Mode)> install;
  std::function<void(btCollisionDispatcher&)> uninstall;
  /// @param is_fixed  the body will not move (another engine may have a cheaper shape for that)
  std::function<ShapeHandle(const PartMesh& part, bool is_fixed)> makeShape;
};

/// Resolution of a part's models.
struct Resolution {
  double voxel_m = 0.25e-3;
  double spacing_m = 0.5e-3;
};

/// VPS with these settings, except that the scene sets contact_method. Shapes are built once for each mesh
/// and resolution of this engine, and shared.
Engine vpsEngine(const Resolution& resolution = {}, const bullet::Settings& settings = {});

}  // namespace vps::dynamics
