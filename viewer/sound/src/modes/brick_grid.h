// SPDX-License-Identifier: BSD-3-Clause
// A body as bricks, with the matrices of its vibration.
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
  std::array<int, 3> at{};                  ///< column, row, layer
  std::array<int, kBrickNodes> nodes{};     ///< as in brickNode()
  std::shared_ptr<const BrickFilling> cut;  ///< none: the whole brick is filled
};

struct BrickGrid {
  Vec3 low_P = Vec3::Zero();
  Vec3 size_m = Vec3::Zero();  ///< of a brick
  std::vector<Brick> bricks;
  std::map<std::array<int, 3>, std::size_t> brick_at;
  std::size_t node_count = 0;
};

/// Bricks that divide the box, as small as most_bricks filled ones allow; at least one along each edge.
/// Nothing inside, or a flat box: none. Calls isInside about a thousand times a brick that is looked at, and
/// looks at no more than eight times as many as it fills.
BrickGrid makeBrickGrid(const Box& box_P, const std::function<bool(const Vec3& p_P)>& isInside,
                        std::size_t most_bricks);

/// Three rows a node: x, y, z.
struct VibrationMatrices {
  Eigen::SparseMatrix<double> stiffness, mass;
  double mass_kg = 0;
};
VibrationMatrices matricesOf(const BrickGrid& grid, double density_kg_m3, const Elasticity& material);

/// What the nodes of a brick move a point by. Points beside the bricks move as the nearest place of one.
struct PointShapes {
  const Brick* brick = nullptr;
  BrickShapes shapes;
};
PointShapes shapesAt(const BrickGrid& grid, const Vec3& p_P);

}  // namespace vps::viewer
