// SPDX-License-Identifier: BSD-3-Clause
#include "sound/brick_grid.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace vps::viewer::inline v0 {
namespace {

using Place = std::array<int, 3>;

constexpr double kLeastFill = 0.1;
constexpr int kSamples = 3;  // along each edge of a brick, to measure its fill

std::array<int, 3> bricksAlong(const Vec3& box_m, double edge_m, const ModeSettings& settings) {
  std::array<int, 3> count{};
  for (int k = 0; k < 3; ++k) count[k] = std::max(settings.least_across, int(std::lround(box_m[k] / edge_m)));
  return count;
}

/// Cubes as small as the number of bricks in the whole box allows.
std::array<int, 3> bricksFor(const Vec3& box_m, const ModeSettings& settings) {
  double small_m = 1e-4 * box_m.norm(), large_m = box_m.norm();
  for (int i = 0; i < 60; ++i) {
    const double edge_m = std::sqrt(small_m * large_m);
    const auto [x, y, z] = bricksAlong(box_m, edge_m, settings);
    (double(x) * y * z > double(settings.most_bricks) ? small_m : large_m) = edge_m;
  }
  return bricksAlong(box_m, large_m, settings);
}

double fillOf(const Vec3& low_P, const Vec3& size_m, const std::function<bool(const Vec3&)>& isInside) {
  int inside = 0;
  for (int i = 0; i < kSamples * kSamples * kSamples; ++i) {
    const Vec3 at(i % kSamples, i / kSamples % kSamples, i / (kSamples * kSamples));
    inside += isInside(low_P + size_m.cwiseProduct((at.array() + 0.5).matrix()) / kSamples);
  }
  return double(inside) / (kSamples * kSamples * kSamples);
}

int cornerAt(const Place& at, const Vec3& p_P, std::map<Place, int>& known, BrickGrid& grid) {
  const auto [found, is_new] = known.try_emplace(at, static_cast<int>(grid.corners_P.size()));
  if (is_new) grid.corners_P.push_back(p_P);
  return found->second;
}

/// The faces that no other brick covers, shared among their four corners.
void addSurface(const std::map<Place, std::size_t>& brick_at, BrickGrid& grid) {
  for (const Brick& brick : grid.bricks)
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {0, 1}) {
        Place next = brick.at;
        next[axis] += side != 0 ? 1 : -1;
        if (brick_at.contains(next)) continue;
        const double area_m2 = grid.size_m.prod() / grid.size_m[axis];
        for (int i = 0; i < 8; ++i)
          if ((i >> axis & 1) == side)
            grid.normal_area_m2[brick.corners[i]] += Vec3::Unit(axis) * (side != 0 ? area_m2 : -area_m2) / 4;
      }
}

}  // namespace

BrickGrid makeBrickGrid(const Box& box_P, const std::function<bool(const Vec3& p_P)>& isInside,
                        double density_kg_m3, const ModeSettings& settings) {
  BrickGrid grid;
  const Vec3 box_m = box_P.size();
  if (!(box_m.minCoeff() > 0) || !box_m.allFinite()) return grid;
  const std::array<int, 3> count = bricksFor(box_m, settings);
  grid.size_m = box_m.cwiseQuotient(Vec3(count[0], count[1], count[2]));
  std::map<Place, int> known;
  std::map<Place, std::size_t> brick_at;
  for (int z = 0; z < count[2]; ++z)
    for (int y = 0; y < count[1]; ++y)
      for (int x = 0; x < count[0]; ++x) {
        Brick brick;
        brick.at = {x, y, z};
        const Vec3 low_P = box_P.min + grid.size_m.cwiseProduct(Vec3(x, y, z));
        brick.fill = fillOf(low_P, grid.size_m, isInside);
        if (brick.fill < kLeastFill) continue;
        for (int i = 0; i < 8; ++i) {
          const Place at = {x + (i & 1), y + (i >> 1 & 1), z + (i >> 2 & 1)};
          const Vec3 p_P = box_P.min + grid.size_m.cwiseProduct(Vec3(at[0], at[1], at[2]));
          brick.corners[i] = cornerAt(at, p_P, known, grid);
        }
        brick_at[brick.at] = grid.bricks.size();
        grid.bricks.push_back(brick);
      }
  grid.mass_kg.assign(grid.corners_P.size(), 0);
  grid.normal_area_m2.assign(grid.corners_P.size(), Vec3::Zero());
  for (const Brick& brick : grid.bricks)
    for (const int corner : brick.corners)
      grid.mass_kg[corner] += brick.fill * density_kg_m3 * grid.size_m.prod() / 8;
  addSurface(brick_at, grid);
  return grid;
}

Eigen::SparseMatrix<double> stiffnessOf(const BrickGrid& grid, const Elasticity& material) {
  const BrickMatrix K_brick = brickStiffness(grid.size_m, material);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(grid.bricks.size() * 24 * 24);
  for (const Brick& brick : grid.bricks)
    for (int i = 0; i < 24; ++i)
      for (int j = 0; j < 24; ++j)
        entries.emplace_back(3 * brick.corners[i / 3] + i % 3, 3 * brick.corners[j / 3] + j % 3,
                             brick.fill * K_brick(i, j));
  const auto size = static_cast<Eigen::Index>(3 * grid.corners_P.size());
  Eigen::SparseMatrix<double> K(size, size);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

}  // namespace vps::viewer::inline v0
