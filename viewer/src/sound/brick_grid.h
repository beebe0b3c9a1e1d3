// SPDX-License-Identifier: BSD-3-Clause
// A body as bricks, with the matrices of its vibration.
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <functional>
#include <vector>

#include "sound/modes.h"

namespace vps::viewer::inline v0 {

struct Brick {
  std::array<int, 3> at{};       ///< column, row, layer
  std::array<int, 8> corners{};  ///< as in brickStiffness()
  BrickFilling filling;          ///< no points: the whole brick

  [[nodiscard]] bool isWhole() const { return filling.at.empty(); }
  /// Share of its volume that is inside.
  [[nodiscard]] double fill() const {
    return isWhole() ? 1 : static_cast<double>(filling.at.size()) * filling.share_volume;
  }
};

struct BrickGrid {
  Vec3 size_m = Vec3::Zero();  ///< of a brick
  std::vector<Brick> bricks;
  std::vector<Vec3> corners_P;
  std::vector<double> mass_kg;       ///< of each corner
  std::vector<Vec3> normal_area_m2;  ///< of each corner: area of the free faces around it, along their normal
};

BrickGrid makeBrickGrid(const Box& box_P, const std::function<bool(const Vec3& p_P)>& isInside,
                        double density_kg_m3, const ModeSettings& settings);

/// Three rows a corner: x, y, z.
Eigen::SparseMatrix<double> stiffnessOf(const BrickGrid& grid, const Elasticity& material);

}  // namespace vps::viewer::inline v0
