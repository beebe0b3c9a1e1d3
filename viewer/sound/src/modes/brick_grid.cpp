// SPDX-License-Identifier: BSD-3-Clause
#include "modes/brick_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vps::viewer {
namespace {

using Place = std::array<int, 3>;
using IsInside = std::function<bool(const Vec3& p_P)>;

constexpr double kLeastFill =
    0.002;                         // least filled share of a brick; bricks with a smaller share are left out
constexpr int kCells = 6;          // cells along each edge of a brick; see kThinFill
constexpr double kThinFill = 0.1;  // a brick with a smaller filled share has 2 kCells cells along each edge
constexpr int kSamples = 4;        // samples along each edge of a cell that the surface cuts
// Stiffness of the empty region of a cut brick, as a share of the material's. This stiffness holds nodes that
// are far from the filled region, and makes a wall of a twentieth of a brick 0.004 % stiffer.
constexpr double kEmptyStiffness = 1e-8;
// A box with few filled bricks is divided further, up to this number of bricks.
constexpr std::size_t kMostLooked = 8;  // times most_bricks

std::array<int, 3> bricksAlong(const Vec3& box_m, double edge_m) {
  std::array<int, 3> count{};
  for (int k = 0; k < 3; ++k) count[k] = std::max(1, int(std::lround(box_m[k] / edge_m)));
  return count;
}

/// Numbers of bricks along the box's edges, for near-cubes that are as small as possible with at most `most`
/// bricks.
std::array<int, 3> bricksFor(const Vec3& box_m, double most) {
  double small_m = 1e-4 * box_m.norm(), large_m = box_m.norm();
  for (int i = 0; i < 60; ++i) {
    const double edge_m = std::sqrt(small_m * large_m);
    const auto [x, y, z] = bricksAlong(box_m, edge_m);
    (double(x) * y * z > most ? small_m : large_m) = edge_m;
  }
  return bricksAlong(box_m, large_m);
}

/// A brick divided into cells. Samples at the corners and centres of cells tell whether a cell is full, empty
/// or cut.
class BrickSampler {
 public:
  BrickSampler(const Vec3& low_P, const Vec3& size_m, int cells, const IsInside& isInside)
      : low_P_(low_P), size_m_(size_m), cells_(cells), isInside_(isInside) {
    for (int i = 0; i < cellCount(cells + 1); ++i)
      corners_.push_back(isInside(low_P + size_m.cwiseProduct(place(i, cells + 1)) / cells));
  }
  [[nodiscard]] BrickFilling filling() const {
    BrickFilling filling;
    for (int i = 0; i < cellCount(cells_); ++i) {
      const Vec3 low = place(i, cells_);
      const int filled = filledLooks(low);
      if (filled == 0) continue;
      const Vec3 from = inBrick(low), to = inBrick(low + Vec3::Ones());
      if (filled == kLooks)
        filling.addBox(from, to);
      else
        filling.addShares(from, to, kSamples, [&](int x, int y, int z) {
          return isInside(low + (Vec3(x, y, z) + Vec3::Constant(0.5)) / kSamples);
        });
    }
    return filling;
  }

 private:
  static constexpr int kLooks = 9;
  static int cellCount(int along) { return along * along * along; }
  static Vec3 place(int i, int along) {
    return {double(i % along), double(i / along % along), double(i / (along * along))};
  }

  [[nodiscard]] Vec3 inBrick(const Vec3& in_cells) const { return 2 * in_cells / cells_ - Vec3::Ones(); }
  [[nodiscard]] bool isInside(const Vec3& in_cells) const {
    return isInside_(low_P_ + size_m_.cwiseProduct(in_cells) / cells_);
  }
  [[nodiscard]] int filledLooks(const Vec3& low) const {
    int filled = isInside(low + Vec3::Constant(0.5)) ? 1 : 0;
    for (int i = 0; i < 8; ++i) {
      const Vec3 at = low + place(i, 2);
      filled += corners_[std::size_t(at.x() + (cells_ + 1) * (at.y() + (cells_ + 1) * at.z()))] ? 1 : 0;
    }
    return filled;
  }
  Vec3 low_P_, size_m_;
  int cells_;
  const IsInside& isInside_;
  std::vector<bool> corners_;
};

/// The bricks that are filled or cut. The nodes of the bricks are not numbered yet.
std::vector<Brick> filledBricks(const Box& box_P, const std::array<int, 3>& count, const IsInside& isInside) {
  constexpr double kAll = 1 - 1e-9;
  std::vector<Brick> bricks;
  const Vec3 size_m = box_P.size().cwiseQuotient(Vec3(count[0], count[1], count[2]));
  for (int z = 0; z < count[2]; ++z)
    for (int y = 0; y < count[1]; ++y)
      for (int x = 0; x < count[0]; ++x) {
        const Vec3 low_P = box_P.min + size_m.cwiseProduct(Vec3(x, y, z));
        BrickFilling filling = BrickSampler(low_P, size_m, kCells, isInside).filling();
        const double share = filling.total();
        if (share == 0) continue;
        if (share < kThinFill) filling = BrickSampler(low_P, size_m, 2 * kCells, isInside).filling();
        if (share > kAll)
          bricks.push_back({{x, y, z}, {}, nullptr});
        else if (filling.total() >= kLeastFill)
          bricks.push_back({{x, y, z}, {}, std::make_shared<const BrickFilling>(filling)});
      }
  return bricks;
}

void numberNodes(BrickGrid& grid) {
  std::map<Place, int> known;
  for (Brick& brick : grid.bricks) {
    for (int i = 0; i < kBrickNodes; ++i) {
      Place at = brickNode(i);
      for (int k = 0; k < 3; ++k) at[k] += 2 * brick.at[k];
      brick.nodes[i] = known.try_emplace(at, static_cast<int>(known.size())).first->second;
    }
    grid.brick_at[brick.at] = static_cast<std::size_t>(&brick - grid.bricks.data());
  }
  grid.node_count = known.size();
}

}  // namespace

BrickGrid makeBrickGrid(const Box& box_P, const IsInside& isInside, std::size_t most_bricks) {
  BrickGrid grid;
  const Vec3 box_m = box_P.size();
  if (!(box_m.minCoeff() > 0) || !box_m.allFinite()) return grid;
  // The first grid tells the filled share of the box. If this share is small, a finer grid is possible.
  const double most = static_cast<double>(most_bricks);
  std::array<int, 3> count = bricksFor(box_m, most);
  grid.bricks = filledBricks(box_P, count, isInside);
  if (grid.bricks.empty()) return grid;
  const double filled_share =
      static_cast<double>(grid.bricks.size()) / (double(count[0]) * count[1] * count[2]);
  const std::array<int, 3> finer = bricksFor(box_m, std::min(double{kMostLooked}, 1 / filled_share) * most);
  if (finer != count)
    if (std::vector<Brick> bricks = filledBricks(box_P, finer, isInside);
        !bricks.empty() && bricks.size() <= most_bricks) {
      grid.bricks = std::move(bricks);
      count = finer;
    }
  grid.low_P = box_P.min;
  grid.size_m = box_m.cwiseQuotient(Vec3(count[0], count[1], count[2]));
  numberNodes(grid);
  return grid;
}

VibrationMatrices matricesOf(const BrickGrid& grid, double density_kg_m3, const Elasticity& material) {
  const BrickMatrices whole = brickMatrices(grid.size_m, material, wholeBrick());
  std::vector<Eigen::Triplet<double>> stiffness, mass;
  stiffness.reserve(grid.bricks.size() * 9 * kBrickNodes * kBrickNodes);
  mass.reserve(grid.bricks.size() * 3 * kBrickNodes * kBrickNodes);
  VibrationMatrices result;
  for (const Brick& brick : grid.bricks) {
    BrickMatrices of = whole;
    if (brick.cut) {
      of = brickMatrices(grid.size_m, material, *brick.cut);
      of.stiffness_N_per_m += kEmptyStiffness * whole.stiffness_N_per_m;
    }
    result.mass_kg += density_kg_m3 * of.mass_share_m3.sum();
    for (int i = 0; i < kBrickNodes; ++i)
      for (int j = 0; j < kBrickNodes; ++j)
        for (int k = 0; k < 3; ++k) {
          const int row = 3 * brick.nodes[i] + k;
          mass.emplace_back(row, 3 * brick.nodes[j] + k, density_kg_m3 * of.mass_share_m3(i, j));
          for (int l = 0; l < 3; ++l)
            stiffness.emplace_back(row, 3 * brick.nodes[j] + l, of.stiffness_N_per_m(3 * i + k, 3 * j + l));
        }
  }
  const auto size = static_cast<Eigen::Index>(3 * grid.node_count);
  result.stiffness.resize(size, size);
  result.stiffness.setFromTriplets(stiffness.begin(), stiffness.end());
  result.mass.resize(size, size);
  result.mass.setFromTriplets(mass.begin(), mass.end());
  return result;
}

PointShapes shapesAt(const BrickGrid& grid, const Vec3& p_P) {
  const Vec3 at = (p_P - grid.low_P).cwiseQuotient(grid.size_m);
  // On the border of two bricks only one of them may exist.
  PointShapes nearest;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 27; ++i) {
    const Place place = {int(std::floor(at.x())) + i % 3 - 1, int(std::floor(at.y())) + i / 3 % 3 - 1,
                         int(std::floor(at.z())) + i / 9 - 1};
    const auto found = grid.brick_at.find(place);
    if (found == grid.brick_at.end()) continue;
    const Vec3 xi = 2 * (at - Vec3(place[0], place[1], place[2])) - Vec3::Ones();
    const Vec3 within = xi.cwiseMax(-1).cwiseMin(1);
    const double away_m = (xi - within).cwiseProduct(grid.size_m).norm() / 2;
    if (!(away_m < nearest_m)) continue;
    nearest_m = away_m;
    nearest = {&grid.bricks[found->second], brickShapes(within)};
  }
  return nearest;
}

}  // namespace vps::viewer
