// SPDX-License-Identifier: BSD-3-Clause
// Stiffness of a box-shaped finite element of elastic material.
#pragma once

#include <Eigen/Core>

#include "vps/pose.h"

namespace vps::viewer::inline v0 {

struct Elasticity {
  double youngs_modulus_Pa = 210e9;
  double poissons_ratio = 0.3;
};

using BrickMatrix = Eigen::Matrix<double, 24, 24>;

/// Stiffness [N/m] of a brick with 8 corners; rows 3 i to 3 i + 2 are x, y, z of corner i, whose coordinates
/// are the bits of i (x lowest). Three quadratic displacements inside the element, which its neighbours do
/// not share, let it bend without locking, so that one layer of bricks bends as a plate does. Source: Wilson,
/// Taylor, Doherty and Ghaboussi 1973 (incompatible modes); Hughes, "The Finite Element Method", 2000,
/// section 4.7.
BrickMatrix brickStiffness(const Vec3& size_m, const Elasticity& material);

}  // namespace vps::viewer::inline v0
