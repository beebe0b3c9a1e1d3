// SPDX-License-Identifier: BSD-3-Clause
// Stiffness of a box-shaped finite element of elastic material.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "vps/pose.h"

namespace vps::viewer::inline v0 {

struct Elasticity {
  double youngs_modulus_Pa = 210e9;
  double poissons_ratio = 0.3;
};

using BrickMatrix = Eigen::Matrix<double, 24, 24>;

/// The part of a brick that is filled, as equal shares of its volume around points in [-1, 1]^3.
struct BrickFilling {
  std::vector<Vec3> at;     ///< of the filled shares
  double share_volume = 0;  ///< of each, as a share of the brick's volume
};

/// Stiffness [N/m] of a brick with 8 corners; rows 3 i to 3 i + 2 are x, y, z of corner i, whose coordinates
/// are the bits of i (x lowest). Three quadratic displacements inside the element, which its neighbours do
/// not share, let it bend without locking, so that one layer of bricks bends as a plate does. Source: Wilson,
/// Taylor, Doherty and Ghaboussi 1973 (incompatible modes); Hughes, "The Finite Element Method", 2000,
/// section 4.7.
BrickMatrix brickStiffness(const Vec3& size_m, const Elasticity& material);

/// The same of a brick that is filled in part: its energy is integrated over what is filled, so that a wall
/// across the brick keeps the place and thickness it has, and bends as it does. Material that were spread
/// evenly over the brick would bend a wall of half a brick with four times its stiffness. Source: Parvizian,
/// Duester and Rank, "Finite cell method", Comput. Mech. 41, 2007. O(points).
BrickMatrix brickStiffness(const Vec3& size_m, const Elasticity& material, const BrickFilling& filling);

/// The share of a brick's filling that each corner carries: the integral of its trilinear shape. They add up
/// to the share that is filled.
std::array<double, 8> cornerShares(const BrickFilling& filling);

}  // namespace vps::viewer::inline v0
