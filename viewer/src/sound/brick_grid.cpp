// SPDX-License-Identifier: BSD-3-Clause
#include "sound/brick_grid.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace vps::viewer::inline v0 {
namespace {

using Place = std::array<int, 3>;

constexpr double kLeastFill = 0.02;  // of a brick; less is left out
constexpr int kLook = 3;     // samples along each edge that tell whether a brick is whole, empty or cut,
constexpr int kSamples = 6;  // and of a cut one
// What is empty in a cut brick is as stiff as this share of the material, so that a corner far from it is
// held.
constexpr double kEmptyStiffness = 1e-5;
// A grid of few bricks in a large box may be divided further; then as many are looked at, at most.
constexpr std::size_t kMostLooked = 8;  // times ModeSettings::most_bricks

std::array<int, 3> bricksAlong(const Vec3& box_m, double edge_m, const ModeSettings& settings) {
  std::array<int, 3> count{};
  for (int k = 0; k < 3; ++k) count[k] = std::max(settings.least_across, int(std::lround(box_m[k] / edge_m)));
  return count;
}

/// Cubes as small as `most` of them in the whole box allow.
std::array<int, 3> bricksFor(const Vec3& box_m, double most, const ModeSettings& settings) {
  double small_m = 1e-4 * box_m.norm(), large_m = box_m.norm();
  for (int i = 0; i < 60; ++i) {
    const double edge_m = std::sqrt(small_m * large_m);
    const auto [x, y, z] = bricksAlong(box_m, edge_m, settings);
    (double(x) * y * z > most ? small_m : large_m) = edge_m;
  }
  return bricksAlong(box_m, large_m, settings);
}

BrickFilling fillingOf(const Vec3& low_P, const Vec3& size_m, int samples,
                       const std::function<bool(const Vec3&)>& isInside) {
  BrickFilling filling;
  filling.share_volume = 1.0 / (samples * samples * samples);
  for (int i = 0; i < samples * samples * samples; ++i) {
    const Vec3 at(i % samples, i / samples % samples, i / (samples * samples));
    const Vec3 share = (at.array() + 0.5).matrix() / samples;
    if (isInside(low_P + size_m.cwiseProduct(share))) filling.at.push_back(2 * share - Vec3::Ones());
  }
  return filling;
}

/// The bricks that are filled, wholly or in part. Their corners are not numbered yet.
std::vector<Brick> filledBricks(const Box& box_P, const std::array<int, 3>& count,
                                const std::function<bool(const Vec3&)>& isInside) {
  std::vector<Brick> bricks;
  const Vec3 size_m = box_P.size().cwiseQuotient(Vec3(count[0], count[1], count[2]));
  for (int z = 0; z < count[2]; ++z)
    for (int y = 0; y < count[1]; ++y)
      for (int x = 0; x < count[0]; ++x) {
        const Vec3 low_P = box_P.min + size_m.cwiseProduct(Vec3(x, y, z));
        BrickFilling filling = fillingOf(low_P, size_m, kLook, isInside);
        if (filling.at.empty()) continue;
        if (filling.at.size() == kLook * kLook * kLook)
          filling.at.clear();
        else
          filling = fillingOf(low_P, size_m, kSamples, isInside);
        Brick brick{{x, y, z}, {}, std::move(filling)};
        if (brick.isWhole() || brick.fill() >= kLeastFill) bricks.push_back(std::move(brick));
      }
  return bricks;
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
  // The first grid tells how much of the box is filled; where it is little the bricks may be smaller.
  const double most = static_cast<double>(settings.most_bricks);
  std::array<int, 3> count = bricksFor(box_m, most, settings);
  grid.bricks = filledBricks(box_P, count, isInside);
  if (grid.bricks.empty()) return grid;
  const double filled_share =
      static_cast<double>(grid.bricks.size()) / (double(count[0]) * count[1] * count[2]);
  const std::array<int, 3> finer =
      bricksFor(box_m, std::min(double{kMostLooked}, 1 / filled_share) * most, settings);
  if (finer != count)
    if (std::vector<Brick> bricks = filledBricks(box_P, finer, isInside);
        !bricks.empty() && bricks.size() <= settings.most_bricks) {
      grid.bricks = std::move(bricks);
      count = finer;
    }
  grid.size_m = box_m.cwiseQuotient(Vec3(count[0], count[1], count[2]));
  std::map<Place, int> known;
  std::map<Place, std::size_t> brick_at;
  for (Brick& brick : grid.bricks) {
    const auto [x, y, z] = brick.at;
    for (int i = 0; i < 8; ++i) {
      const Place at = {x + (i & 1), y + (i >> 1 & 1), z + (i >> 2 & 1)};
      const Vec3 p_P = box_P.min + grid.size_m.cwiseProduct(Vec3(at[0], at[1], at[2]));
      brick.corners[i] = cornerAt(at, p_P, known, grid);
    }
    brick_at[brick.at] = static_cast<std::size_t>(&brick - grid.bricks.data());
  }
  grid.mass_kg.assign(grid.corners_P.size(), 0);
  grid.normal_area_m2.assign(grid.corners_P.size(), Vec3::Zero());
  for (const Brick& brick : grid.bricks) {
    std::array<double, 8> shares;
    shares.fill(1.0 / 8);
    if (!brick.isWhole()) shares = cornerShares(brick.filling);
    for (int i = 0; i < 8; ++i)
      grid.mass_kg[brick.corners[i]] += shares[i] * density_kg_m3 * grid.size_m.prod();
  }
  addSurface(brick_at, grid);
  return grid;
}

Eigen::SparseMatrix<double> stiffnessOf(const BrickGrid& grid, const Elasticity& material) {
  const BrickMatrix K_whole = brickStiffness(grid.size_m, material);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(grid.bricks.size() * 24 * 24);
  for (const Brick& brick : grid.bricks) {
    BrickMatrix K = K_whole;
    if (!brick.isWhole())
      K = kEmptyStiffness * K_whole + brickStiffness(grid.size_m, material, brick.filling);
    for (int i = 0; i < 24; ++i)
      for (int j = 0; j < 24; ++j)
        entries.emplace_back(3 * brick.corners[i / 3] + i % 3, 3 * brick.corners[j / 3] + j % 3, K(i, j));
  }
  const auto size = static_cast<Eigen::Index>(3 * grid.corners_P.size());
  Eigen::SparseMatrix<double> K(size, size);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

}  // namespace vps::viewer::inline v0
