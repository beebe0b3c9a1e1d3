// SPDX-License-Identifier: BSD-3-Clause
// A part: what it is called, its shape, what it is made of, and the models built from it.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "vps/mesh.h"
#include "vps/pointshell.h"
#include "vps/voxmap.h"

namespace vps {

struct Material {
  double density_kg_m3 = 7850;       ///< steel
  double friction = 0.15;            ///< Coulomb, of the material on itself; two materials: geometric mean
  double restitution = 0;            ///< 0 inelastic to 1 elastic
  double stiffness_N_per_m3 = 1e12;  ///< penalty stiffness per area (paper, section 4.1)
};

/// A part in its own frame P. Models are shared between equal parts and between threads, and never change.
struct Part {
  std::string name;
  Mesh mesh;
  Material material;
  std::array<float, 3> color = {0.7f, 0.72f, 0.75f};  ///< linear RGB, 0 to 1
  std::shared_ptr<const VoxMap> map;
  std::shared_ptr<const PointShell> shell;
};

}  // namespace vps
