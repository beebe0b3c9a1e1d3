// SPDX-License-Identifier: BSD-3-Clause
// Finite element model of a body's vibration: a grid of bricks with its stiffness and mass matrices.
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "modes/brick_element.h"
#include "vps/box.h"

namespace vps::viewer {

struct Brick {
  std::array<int, 3> at{};               ///< column, row, layer
  std::array<int, kBrickNodes> nodes{};  ///< indices of the nodes, in the order of brickNode()
  /// Filled region of a brick at the surface; null: the whole brick is filled.
  std::shared_ptr<const BrickFilling> cut;
};

struct BrickGrid {
  Vec3 low_P = Vec3::Zero();
  Vec3 size_m = Vec3::Zero();  ///< size of a brick
  std::vector<Brick> bricks;
  std::map<std::array<int, 3>, std::size_t> brick_at;
  std::size_t node_count = 0;
};

/// Divides the box into bricks, as small as possible with at most most_bricks filled ones, and at least one
/// along each edge. The grid is empty if nothing is inside or the box is flat. Calls isInside about a
/// thousand times per examined brick, and examines at most 8 most_bricks bricks.
BrickGrid makeBrickGrid(const Box& box_P, const std::function<bool(const Vec3& p_P)>& isInside,
                        std::size_t most_bricks);

/// Stiffness and mass matrix of the grid. Each node has three rows: x, y, z.
struct VibrationMatrices {
  Eigen::SparseMatrix<double> stiffness, mass;
  double mass_kg = 0;
};
VibrationMatrices matricesOf(const BrickGrid& grid, double density_kg_m3, const Elasticity& material);

/// Interpolation of the displacement at a point from the nodes of its brick. A point outside all bricks moves
/// with the nearest point of a brick.
struct PointShapes {
  const Brick* brick = nullptr;
  BrickShapes shapes;
};
PointShapes shapesAt(const BrickGrid& grid, const Vec3& p_P);

}  // namespace vps::viewer
